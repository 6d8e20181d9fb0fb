"""The runs behind validation/results/paper.json, as far as its studies read them: scenes, results, some columns.

With them a row can be judged again in seconds, without a run.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, RunError, Scene, load_run, read_scene
from contact1d.analysis.curve import Columns, profile_columns
from contact1d.analysis.pressure import Profile
from validation.paper.fig9 import asperity

KEPT = Path(__file__).parents[1] / "validation" / "results" / "runs.json.gz"
DIGITS, WHOLE, SHORT = 12, 17, 200
"""Of a number in a table; in a SHORT one it is kept WHOLE: orders of convergence are of differences near round-off."""
COLUMNS = ("displacement", "force", "contact_radius", "smallest_distance", "branch", "contact_radius_uncertainty")
READ: Mapping[str, tuple[str, ...]] = {
    "curve": ("curve_", "parting_", "jkr_plane", "tangential_"),
    "profiles": ("eq3_", "pull_off_R1000"),
    "friction": ("tangential_", "friction_of_lattices"),
}
"""Of which runs, by how their names begin, tables are read beside the results."""
FRICTION = ("tangential_displacement", "tangential_force", "stick_radius", "dissipated_energy", "drive", "friction")
"""Columns of these that are read."""


def _is_read(table: str, name: str) -> bool:
    return name.startswith(READ[table])


def _rounded(numbers: Any) -> list[float | None]:
    column = np.asarray(numbers, dtype=float)
    digits = WHOLE if len(column) <= SHORT else DIGITS
    return [None if np.isnan(x) else float(f"{x:.{digits}g}") for x in column.tolist()]


def kept(run: Run, name: str) -> dict[str, Any]:
    """What is kept of a run."""
    told = {
        key: entry
        for key, entry in run.document.items()
        if key in ("status", "error", "warnings", "units") or (isinstance(entry, dict) and "value" in entry)
    }
    entry: dict[str, Any] = {"scene": run.scene.model_dump(mode="json", by_alias=True, exclude_none=True)}
    entry["document"] = told
    if _is_read("curve", name) and run.status == "done":
        entry["curve"] = {
            key: run.curve.branch.tolist() if key == "branch" else _rounded(getattr(run.curve, key)) for key in COLUMNS
        }
    if _is_read("profiles", name):
        entry["profiles"] = {
            state: {"first": float(profile.x[0]), "pressure": _rounded(profile.pressure)}
            for state, profile in run.profiles.items()
            if state in ("deepest", "zero_load")
        }
    if _is_read("friction", name):
        entry["friction"] = {key: _rounded(run.friction[key]) for key in FRICTION if key in run.friction}
    return entry


def _write(found: Mapping[str, Any]) -> None:
    text = json.dumps(found, ensure_ascii=False, separators=(",", ":"))
    KEPT.write_bytes(gzip.compress(text.encode(), mtime=0))


def _finished_or_failed(folder: Path) -> Run:
    try:
        return load_run(folder).model
    except RunError:
        document = json.loads((folder / "results.json").read_text(encoding="utf-8"))
        return Run(folder, document, read_scene(document["scene"]), {})


def keep(runs: Path) -> None:
    """Write what is read of all runs in a folder."""
    folders = (folder for folder in sorted(runs.iterdir()) if (folder / "results.json").is_file())
    found = {folder.name: kept(_finished_or_failed(folder), folder.name) for folder in folders}
    _write({"runs": found})
    kept_runs.cache_clear()


def _numbers(column: list[float | None]) -> Any:
    return np.asarray([np.nan if x is None else x for x in column])


def _run(name: str, entry: dict[str, Any]) -> Run:
    columns = entry.get("curve", {key: [] for key in COLUMNS})
    nothing: Any = {}
    profiles = {}
    for state, one in entry.get("profiles", nothing).items():
        pressure = _numbers(one["pressure"])
        x = np.linspace(one["first"], -one["first"], len(pressure))
        profiles[state] = Profile(x, 0.0 * x, 0.0 * x, pressure, 0.0 * x)
    friction = {key: _numbers(column) for key, column in entry.get("friction", nothing).items()}
    curve = {key: np.asarray(columns[key]) if key == "branch" else _numbers(columns[key]) for key in COLUMNS}
    scene = read_scene(entry["scene"])
    tables = {"curve": Columns(curve | friction if scene.experiment.goes_along else curve)}
    tables |= {"profile": Columns(profile_columns(profiles))} if profiles else {}
    tables |= {"friction": Columns(friction)} if friction else {}
    return in_model_units(Run(Path(name), entry["document"], scene, tables))


def in_model_units(run: Run) -> Run:
    """A run whose tables are in units of the model already, as `Run.model`."""
    vars(run).update(results=replace(run, tables={}).model.results, model=run)
    return run


@cache
def kept_runs() -> dict[str, Run]:
    """By name."""
    found = json.loads(gzip.decompress(KEPT.read_bytes()))["runs"]
    return {name: _run(name, entry) for name, entry in found.items()}


def kept_paper() -> Scene:
    """The paper's scene, of which all others were made."""
    return kept_runs()["pull_off_R1000"].scene


ONCE = {(asperity, "smoluchowski"): cache(asperity.smoluchowski)}
"""What takes long and knows nothing of the runs."""


@dataclass(frozen=True)
class KeptBench:
    """A bench whose runs are the kept ones, or others."""

    runs: Mapping[str, Run]
    paper: Scene


@contextmanager
def solved_once() -> Iterator[None]:
    """These are worked out once for all tests."""
    with pytest.MonkeyPatch.context() as patch:
        for (module, name), function in ONCE.items():
            patch.setattr(module, name, function)
        yield
