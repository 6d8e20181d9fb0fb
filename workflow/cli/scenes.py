"""The commands about scene files: `new` writes one to start from, `schema` what an editor must know of them."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import CALL_IS_WRONG, stop


class Kind(StrEnum):
    """The experiments."""

    PULL_OFF = "pull_off"
    LOAD = "load"
    PATH = "path"
    HOLD = "hold"
    SLIDE = "slide"
    TANGENTIAL = "tangential"


def new(
    name: Annotated[Path, typer.Argument(metavar="NAME", help="The file; .toml is added if need be.")],
    kind: Annotated[Kind, typer.Option(help="What is done with the bodies.")] = Kind.PULL_OFF,
) -> None:
    """Write a scene file to start from: it runs as it stands, and says of every key what it is and may be."""
    if name.name in ("", ".."):
        stop(f"{name} is a folder; give the file a name", CALL_IS_WRONG)
    path = name if name.suffix == ".toml" else name.with_name(name.name + ".toml")
    from contact1d.workflow.cli.starter import starter

    _write(path, starter(kind.value), "choose another name")
    typer.echo(f"{path}: run it with contact1d run {quote(str(path))}")


def schema(
    out: Annotated[Path | None, typer.Option(help="Write it to this new file.", show_default="printed")] = None,
) -> None:
    """Print the JSON schema of scene files, with which an editor completes keys, explains them and marks mistakes.

    For taplo, or Even Better TOML in VS Code: `contact1d schema --out scene.schema.json` beside your scenes, and in
    each of them the first line `#:schema scene.schema.json`.
    """
    from contact1d.workflow.scene.schema import schema_text

    if out is None:
        typer.echo(schema_text(), nl=False)
        return
    _write(out, schema_text(), "remove it first, or choose another name")
    typer.echo(f"{out}: in a scene file beside it, write as first line #:schema {out.name}")


def _write(path: Path, text: str, instead: str) -> None:
    """Write a file that is not there yet."""
    if path.parent.is_file():
        stop(f"{path.parent} is a file; a folder is needed", CALL_IS_WRONG)
    if not path.parent.is_dir():
        stop(f"there is no folder {path.parent}; make it first: mkdir -p {quote(str(path.parent))}", CALL_IS_WRONG)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        stop(f"{path} is there already and stays as it is; {instead}", CALL_IS_WRONG)
    except OSError:
        path.unlink(missing_ok=True)  # whole or not at all
        raise
