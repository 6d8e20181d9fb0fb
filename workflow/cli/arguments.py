"""What several commands are given, SCENE and its changes, and how a shell completes it."""

from __future__ import annotations

import os
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


def scene_files(incomplete: str) -> list[str]:
    """The *.toml files and the folders that begin with `incomplete`; a folder that is the only one is opened."""
    folder, start = os.path.split(incomplete)
    try:
        entries = sorted(os.scandir(folder or "."), key=lambda entry: entry.name)
    except OSError:
        return []
    shown = [entry for entry in entries if entry.name.startswith(start) and entry.name[0] != "."]
    files = [os.path.join(folder, entry.name) for entry in shown if entry.name.endswith(".toml")]
    folders = [os.path.join(folder, entry.name, "") for entry in shown if entry.is_dir()]
    return scene_files(folders[0]) if len(folders) == 1 and not files else files + folders


def effect_names(incomplete: str) -> list[str]:
    """The effects that begin with `incomplete`."""
    from contact1d.workflow.scene import EFFECTS

    return [name for name in EFFECTS if name.startswith(incomplete)]


class Format(StrEnum):
    """Of figures."""

    PNG = "png"
    SVG = "svg"
    PDF = "pdf"


SceneFile = Annotated[
    Path,
    typer.Argument(
        metavar="SCENE", help="A scene file (TOML); `new` writes one.", show_default=False, autocompletion=scene_files
    ),
]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="TABLE.KEY=VALUE",
        help="Change one value of the scene, as often as needed: `--set bodies.profile.radius=2000`.",
        show_default=False,
    ),
]
Without = Annotated[
    list[str] | None,
    typer.Option(
        metavar="EFFECT",
        help="Leave out an effect's table: `--without noise`.",
        show_default=False,
        autocompletion=effect_names,
    ),
]
