"""Curves that nobody asked for by name: F(d) and F(a) of a load on a plane, and a contact under heat over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d import load_run, run
from contact1d.analysis.curve import read_samples
from contact1d.workflow.experiments.load.dynamic import SAMPLES
from contact1d.workflow.experiments.running.prescribing import CURVE_STEPS
from tests.decks.test_run_folder import SCENES

LATTICE = 2e-3  # relative: of a radius of tens of spacings, and of the force under it
ROUND_OFF = 1e-12


def test_a_load_on_the_plane_has_a_hundred_rows_and_they_are_hertz(tmp_path: Path) -> None:
    """F = (4/3) E* √R d^(3/2) and a = √(R d), E* = k/h; the load was asked for, the curve was not."""
    radius, stiffness = 1000.0, 0.5
    bodies = {
        "particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "reduction": "mdr", "bulk_stiffness": stiffness,
        "profile": {"kind": "parabola", "radius": radius},
    }  # fmt: skip
    scene = {"title": "load", "bodies": bodies, "experiment": {"kind": "load", "force": 40.0}}
    finished = run(scene, tmp_path / "run", figures=False)
    curve = finished.curve
    assert len(curve.force) > CURVE_STEPS
    assert curve.displacement[0] == 0.0
    hertz = 4.0 / 3.0 * stiffness * np.sqrt(radius) * np.maximum(curve.displacement, 0.0) ** 1.5
    np.testing.assert_allclose(curve.force, hertz, atol=LATTICE * curve.force.max())
    wide = curve.contact_radius > 0.5 * np.nanmax(curve.contact_radius)
    np.testing.assert_allclose(curve.contact_radius[wide], np.sqrt(radius * curve.displacement[wide]), rtol=LATTICE)
    for name in ("force_displacement", "force_radius"):
        (axis,) = finished.plot(name).axes
        labels = [text.get_text() for text in axis.get_legend().get_texts()]
        assert labels == ["loading", "Hertz"]


def test_a_contact_under_heat_has_its_samples_over_time(tmp_path: Path) -> None:
    """A row for each row of the curve, evenly in time, under the load; the result is the mean of what was sampled."""
    finished = run({"title": "heat"} | SCENES["load_thermal"], tmp_path / "run", figures="svg")
    kept = read_samples(finished.folder / "samples.csv")
    np.testing.assert_array_equal(kept["displacement"], finished.curve.displacement)
    np.testing.assert_array_equal(kept["force"], finished.curve.force)
    steps = np.diff(kept["time"])
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)
    assert kept["time"][0] == pytest.approx(steps[0], rel=ROUND_OFF)
    assert set(kept["load"]) == {0.5}
    mean = float(kept["displacement"][-SAMPLES:].mean())
    assert finished.results.displacement.value == pytest.approx(mean, rel=ROUND_OFF)
    assert (finished.folder / "samples.svg").is_file()
    assert len(load_run(finished.folder).plot("samples").axes) == 2
