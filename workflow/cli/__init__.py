"""The command line: what it reads and prints, and how it ends; no physics."""
