"""The README and docs/results.md are tried: their scenes, their commands, what these print, their Python.

The first two commands, `make run` and `make test`, are what `.ci/run` does.
"""

from __future__ import annotations

import re
import shlex
import tomllib
from functools import cache
from pathlib import Path

import pytest
from typer.testing import CliRunner

from contact1d import read_scene
from contact1d.workflow.cli.app import app
from contact1d.workflow.identify.contact import read_contact
from contact1d.workflow.sweep.axes import read_sweep

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
RESULTS = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
DIGITS = 1e-3  # relative: of a figure that is printed, from one processor to another
SHOWN_BY = ("steel_on_glass", "silica")
"""What prints the blocks of text, in order."""


def blocks(language: str, page: str = README) -> list[str]:
    return [text for name, text in BLOCK.findall(page) if name == language]


def commands(page: str) -> list[str]:
    lines = "".join(blocks("", page)).splitlines()
    return [line.partition("  #")[0].strip() for line in lines if line.startswith("contact1d")]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which paths of the README lead where they do for its reader."""
    for name in ("lammps_inputs", "docs"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@cache
def printed(command: str) -> str:
    """What a command prints; two blocks may show the same one."""
    return invoked(command)


def invoked(command: str) -> str:
    done = CliRunner().invoke(app, shlex.split(command)[1:])
    assert done.exit_code == 0, f"{command}: {done.output}"
    return done.stdout


def test_every_scene_contact_and_sweep_is_one() -> None:
    kinds = []
    for text in blocks("toml"):
        tables = tomllib.loads(text)
        if "axes" in tables:
            tables["scene"] = str(ROOT / "lammps_inputs" / "sweeps" / tables["scene"])
            assert len(read_sweep(tables)) > 1
        elif "bodies" in tables:
            assert read_scene(text).title == tables["title"]
        else:
            assert read_contact(tables).scene.title == tables["title"]
        kinds.append("axes" in tables or "bodies" in tables)
    assert len(kinds) >= 3


@pytest.mark.parametrize("name", ["scenes/steel_on_glass", "scenes/pull_off", "contacts/silica"])
def test_what_is_shown_is_what_ships(name: str) -> None:
    shipped = tomllib.loads((ROOT / "lammps_inputs" / f"{name}.toml").read_text(encoding="utf-8"))
    assert shipped in [tomllib.loads(text) for text in blocks("toml")]


@pytest.mark.parametrize("command", commands(README) + commands(RESULTS))
def test_every_command_works(command: str, here: Path) -> None:
    if "--run runs/pull_off" in command:
        invoked("contact1d run lammps_inputs/scenes/pull_off.toml --no-figures")
    assert printed(command)


@pytest.mark.parametrize(("name", "shown"), list(zip(SHOWN_BY, blocks("text"), strict=True)))
def test_what_is_shown_is_what_is_printed(name: str, shown: str, here: Path) -> None:
    kind = "identify lammps_inputs/contacts" if name == "silica" else "run lammps_inputs/scenes"
    output = {words(line): line for line in printed(f"contact1d {kind}/{name}.toml").splitlines()}
    for line in shown.splitlines():
        assert words(line) in output, line
        # the number, and not its uncertainty, of which a digit or two are round-off
        assert numbers(output[words(line)])[:1] == pytest.approx(numbers(line)[:1], rel=DIGITS)


def words(line: str) -> tuple[str, ...]:
    """A line without its numbers and without what is aligned by blanks."""
    return tuple(re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", line).split())


def numbers(line: str) -> list[float]:
    return [float(number) for number in re.findall(r"(?<![\w(^])\d+\.\d+", line)]


def test_the_python_works(here: Path) -> None:
    (code,) = blocks("python")
    exec(compile(code, "README.md", "exec"), {})


def test_every_command_that_is_named_is_one() -> None:
    known = {info.name or str(getattr(info.callback, "__name__", "")) for info in app.registered_commands}
    named = set(re.findall(r"`contact1d (\w+)", README + RESULTS))
    assert named
    assert named <= known


def test_every_link_leads_to_a_file() -> None:
    for page, folder in ((README, ROOT), (RESULTS, ROOT / "docs")):
        for link in re.findall(r"\]\(([^)#]+)", page):
            assert link.startswith("http") or (folder / link).exists(), link
