"""The command line: options, output on the terminal, exit codes; no physics."""
