"""The command line: `python -m contact1d run scene.toml`."""

from contact1d.workflow.cli.app import app, main

__all__ = ["app", "main"]

if __name__ == "__main__":
    main()
