"""The runs behind the studies: each scene once, several at a time, and none again that is already there."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import Curve, read_curve, read_profiles
from contact1d.analysis.pressure import Profile
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.runs.campaign import RunError, run
from contact1d.workflow.runs.report import RESULTS, versions
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
WATCH = 1.0
"""Seconds between two looks of a worker at its parent."""
TABLES = ("curve.csv", "profile.csv")


@dataclass(frozen=True)
class Finished:
    """A run that is done or failed, as its folder has it.

    Attributes:
        folder: run folder.
        results: what results.json holds.
    """

    folder: Path
    results: Mapping[str, Any]

    @property
    def failed(self) -> bool:
        """Whether it has no numbers."""
        return bool(self.results["status"] != "done")

    @property
    def lammps_seconds(self) -> float:
        """Time in LAMMPS [s]."""
        return float(self.results["timing"]["lammps_s"])

    def value(self, name: str) -> float:
        """A quantity of results.json; NaN where the run has none."""
        return float(self.results[name]["value"]) if name in self.results else float("nan")

    def uncertainty(self, name: str) -> float:
        """Of that quantity."""
        return float(self.results[name]["uncertainty"]) if name in self.results else float("nan")

    def curve(self) -> Curve:
        """What curve.csv holds."""
        return read_curve(self.folder / "curve.csv")

    def profiles(self) -> dict[str, Profile]:
        """What profile.csv holds."""
        return read_profiles(self.folder / "profile.csv")


def finish(scenes: Mapping[str, Scene], folder: Path, workers: int, progress: Progress) -> dict[str, Finished]:
    """Run every scene that `folder` does not have yet, each in a folder of its name.

    Args:
        scenes: by name; the long ones should come first.
        folder: of the run folders.
        workers: runs at a time.
        progress: is told of each run that ends, or is there.
    """
    done = {name: found for name, scene in scenes.items() if (found := there(scene, folder / name))}
    missing = {name: scene for name, scene in scenes.items() if name not in done}
    progress.advance(len(done))
    for name in _run_all(missing, folder, workers):
        found = there(missing[name], folder / name)
        assert found is not None
        done[name] = found
        progress.advance(1)
    return done


def _run_all(scenes: Mapping[str, Scene], folder: Path, workers: int) -> Iterator[str]:
    if not scenes:
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(scenes)), context, _begin_worker, (os.getpid(),)) as executor:
        futures = {executor.submit(_run_one, scene, folder / name): name for name, scene in scenes.items()}
        try:
            for future in as_completed(futures):
                future.result()
                yield futures[future]
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            for child in multiprocessing.active_children():
                child.terminate()  # the runs under way are not finished first; their folders are made anew next time
            raise


def _begin_worker(parent: int) -> None:
    """Leave Ctrl-C to the parent, and end when it is gone, however it went."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(WATCH)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _run_one(scene: Scene, folder: Path) -> None:
    with suppress(RunError):  # results.json says so, and the study what it means
        run(scene, folder, figures=False)


def there(scene: Scene, folder: Path) -> Finished | None:
    """The run in `folder`, if it is of this scene and of these versions, and whole."""
    try:
        results = json.loads((folder / RESULTS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    same = bool(results.get("scene") == scene.model_dump(mode="json", by_alias=True, exclude_none=True))
    whole = results.get("status") == "failed" or all((folder / name).is_file() for name in TABLES)
    return Finished(folder, results) if same and whole and results.get("versions") == versions() else None


def branch(finished: Finished) -> tuple[Array, Array, Array, Array]:
    """Displacement, force, contact radius and its uncertainty on the way back, where the bodies touch."""
    curve = finished.curve()
    radius = np.asarray(curve.contact_radius)
    chosen = (np.asarray(curve.branch) == "unloading") & np.isfinite(radius) & (radius > 0.0)
    columns = (curve.displacement, curve.force, curve.contact_radius, curve.contact_radius_uncertainty)
    d, force, a, spread = (np.asarray(column)[chosen] for column in columns)
    return d, force, a, spread
