"""The README and the documentation are tried: their scenes, their commands, what these print, their Python.

The first two commands, `make run` and `make test`, are what `.ci/run` does.
"""

import re
import shlex
import tomllib
from functools import cache
from pathlib import Path
from statistics import median
from typing import Any

import pytest

from contact1d import from_material, read_scene, sweep
from contact1d.__main__ import app
from contact1d.workflow.fit.plan import read_fit
from tests.command import contact1d
from tests.pages import require_shown
from tests.scenes import ROOT, read_json
from tests.sweeps import Lost

PAGES = {
    path: path.read_text(encoding="utf-8") for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
}
README, RESULTS = PAGES[ROOT / "README.md"], PAGES[ROOT / "docs" / "results.md"]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHOWN = (
    ("README.md", "steel_on_glass", "run lammps_inputs/scenes", r"displacement|contact radius|peak pressure"),
    ("docs/identify.md", "rubber", "identify lammps_inputs/contacts", r"(adhesion force|zero-load radius|peak).*\)$"),
    (
        "docs/identify.md",
        "silica",
        "identify lammps_inputs/contacts",
        r"Tabor|adhesion force|zero-load|theory, at|\* holds",
    ),
)
"""Page, name of the scene and of what is shown, the command, and which lines of what it prints."""


def blocks(language: str, page: str) -> list[str]:
    return [text for name, text in BLOCK.findall(page) if name == language]


def scenes() -> list[str]:
    """What the pages show of scenes, contacts and sweeps that are whole."""
    return [text for page in PAGES.values() for text in blocks("toml", page) if text.startswith("title")]


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
    done = contact1d(*shlex.split(command)[1:])
    assert done.exit_code == 0, f"{command}: {done.output}"
    return done.stdout


def test_every_scene_contact_sweep_and_fit_is_one(tmp_path: Path) -> None:
    """A contact that ships is tried by its command below; two scenes ship, too."""
    shipped = [tomllib.loads(path.read_text("utf-8")) for path in (ROOT / "lammps_inputs").glob("*/*.toml")]
    shown = [tomllib.loads(text) for text in scenes()]
    for tables in shown:
        if "axes" in tables:
            tables["scene"] = str(ROOT / "lammps_inputs" / "sweeps" / tables["scene"])
            assert sum(sweep(tables, tmp_path / tables["title"], Lost(), figures=False).counts.values()) > 1
        elif "data" in tables:
            assert read_fit(tables).fit.title == tables["title"]
        elif "bodies" in tables:
            assert read_scene(tables).title == tables["title"]
        else:
            assert tables in shipped or from_material(tables, tmp_path / "contact").run.status == "done"
    for name in ("scenes/steel_on_glass", "scenes/pull_off", "contacts/rubber"):
        assert tomllib.loads((ROOT / "lammps_inputs" / f"{name}.toml").read_text(encoding="utf-8")) in shown


@pytest.mark.parametrize("command", commands(README) + commands(RESULTS))
def test_every_command_works(command: str, here: Path) -> None:
    if "--run runs/pull_off" in command:
        invoked("contact1d run lammps_inputs/scenes/pull_off.toml --no-figures")
    assert printed(command)


@pytest.mark.parametrize(("page", "name", "command", "lines"), SHOWN)
def test_what_is_shown_is_what_is_printed(page: str, name: str, command: str, lines: str, here: Path) -> None:
    output = printed(f"contact1d {command}/{name}.toml").splitlines()
    chosen = [line for line in output if re.match(lines, line.strip())]
    require_shown(page, name, "\n".join(["```text", *chosen, "```", ""]))


def test_readme_has_what_effects_cost_by_the_records_of_cost_studies() -> None:
    """CPU times with an effect over those without it, and the largest relative error of a main result without it."""
    rows = [
        "| effect | scene | CPU time with it over without | largest relative error without it |",
        "| --- | --- | --- | --- |",
    ]
    for path in sorted((ROOT / "validation" / "results" / "costs").glob("*.json")):
        record = read_json(path)
        tolerance = {"accuracy.tolerance": record["tolerance"]}
        own = next(row for row in record["rows"] if row["edit"]["values"] == tolerance)
        for row in record["rows"]:
            effects = ", ".join(row["edit"]["without"])
            ratios = [run / without for run, without in zip(own["cpu_runs"], row["cpu_runs"], strict=True)]
            if effects and not any(f"| {effects} |" in line for line in rows):
                error, is_bound = max(row["errors"].values())
                cost = f"{median(ratios):.2g} ({min(ratios):.2g} to {max(ratios):.2g})"
                rows.append(f"| {effects} | `{path.stem}` | {cost} | {'less than ' * is_bound}{error:.1g} |")
    require_shown("README.md", "effects", "\n".join([*rows, ""]), exactly=True)


def test_the_python_works(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for page in (PAGES[ROOT / "docs" / "python.md"], README):
        (code,) = blocks("python", page)
        names: dict[str, Any] = {}
        exec(compile(code, "README.md", "exec"), names)
        assert names["finished"].status == "done"
        output = capsys.readouterr().out.splitlines()
    chosen = [line for line in output if re.match(r" +(adhesion_force|.*_radius|central)", line)]
    require_shown("README.md", "python", "\n".join(["```text", *chosen, "```", ""]))


def test_every_command_that_is_named_is_one() -> None:
    known = {info.name or str(getattr(info.callback, "__name__", "")) for info in app.registered_commands}
    named = set(re.findall(r"`contact1d (\w+)", "".join(PAGES.values())))
    assert named
    assert named <= known


def test_every_link_leads_to_a_file() -> None:
    links = [(path, link) for path, page in PAGES.items() for link in re.findall(r"\]\(([^)#]+)", page)]
    assert len({path for path, _ in links}) > 5
    for path, link in links:
        assert link.startswith("http") or (path.parent / link).exists(), (path, link)
