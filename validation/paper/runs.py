"""The runs behind the studies: each scene once, several at a time, and none again that is already there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import RunError
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.runs.many import completed
from contact1d.workflow.runs.pool import pool
from contact1d.workflow.scene import Scene
from validation.judging.runs import there

Array = NDArray[np.float64]


def finish(scenes: Mapping[str, Scene], folder: Path, workers: int, progress: Progress) -> dict[str, Run]:
    """Run every scene that `folder` does not have yet, each in a folder of its name; failed runs are among them.

    Args:
        scenes: by name; the long ones should come first.
        folder: of the run folders.
        workers: runs at a time.
        progress: is told of each run that ends, or is there.

    Raises:
        RunError: a run could not begin.
    """
    done = {name: run for name, scene in scenes.items() if (run := there(scene, folder / name))}
    progress.advance(len(done))
    missing = [name for name in scenes if name not in done]
    with pool(min(workers, max(1, len(missing)))) as executor:
        for index, entry in completed([(scenes[name], folder / name) for name in missing], executor):
            if isinstance(entry, RunError) and not entry.kept:
                raise entry
            done[missing[index]] = entry if isinstance(entry, Run) else read_run(entry.folder)
            progress.advance(1)
    return done


def branch(run: Run) -> tuple[Array, Array, Array, Array]:
    """Displacement, force, contact radius and its uncertainty on the way back, where the bodies touch."""
    curve = run.curve
    chosen = (curve.branch == "unloading") & np.isfinite(curve.contact_radius) & (curve.contact_radius > 0.0)
    columns = (curve.displacement, curve.force, curve.contact_radius, curve.contact_radius_uncertainty)
    d, force, a, spread = (column[chosen] for column in columns)
    return d, force, a, spread
