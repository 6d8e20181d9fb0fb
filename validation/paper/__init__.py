"""The paper, statement by statement: what it prints, what this program finds, and a verdict."""
