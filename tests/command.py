"""The command line in this process."""

from pathlib import Path

from typer.testing import CliRunner, Result

from contact1d.__main__ import app


def contact1d(*arguments: str | float | Path) -> Result:
    return CliRunner().invoke(app, [*map(str, arguments)])
