"""A warning comes where its own limit is passed, and what it advises is enough and no more than that."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, run
from contact1d.workflow.runs.refinement import nested
from tests.scenes import LAW, chains

TOLERANCE = 1e-3
PLANE = {"lower": "rigid_plane"}


def contact(folder: Path, **bodies: Any) -> Run:
    """A load of 3 FU on two chains, or on one over a plane, whose springs and pairs are the same per length."""
    experiment = {"kind": "load", "force": 3.0}
    spacing = bodies.setdefault("spacing", 1.0)
    law = (LAW[0] * spacing, LAW[1], LAW[2] * spacing, LAW[3])
    scene = chains(200.0, 0.83 * spacing, law, experiment=experiment, accuracy={"tolerance": TOLERANCE}, bodies=bodies)
    if "lower" in bodies:
        del scene["interaction"]
    return run(scene, folder, figures=False)


def warned(found: Run) -> dict[str, str]:
    return {one["name"]: one["message"] for one in found.document["warnings"]}


@pytest.mark.parametrize(("spacing", "lower"), [(2.0, {}), (2.0, PLANE), (4.0, PLANE)], ids=str)
def test_an_advised_spacing_is_fine_enough_and_not_eight_times_too_fine(
    spacing: float, lower: dict[str, Any], tmp_path: Path
) -> None:
    def at(spacing: float) -> str:
        found = contact(tmp_path / f"{spacing:g}", spacing=spacing, **lower)
        return warned(found).get("lattice", "")

    said = re.search(r"about ([\d.e-]+) LU", at(spacing))
    assert said is not None
    assert not at(float(said[1]))
    assert at(8.0 * float(said[1]))


def test_no_spacing_is_advised_by_a_result_while_another_is_unknown(tmp_path: Path) -> None:
    """What is known well at 4 LU is known well enough at 2.7; the radius, which is not, needs 0.3."""
    found = warned(contact(tmp_path / "run", spacing=4.0))
    assert "contact_radius" in found["unknown"]
    assert "displacement" in found["lattice"]
    assert "about" not in found["lattice"]


@pytest.mark.parametrize("particles", [53, 59, 62, 68])
def test_a_chain_is_too_short_where_its_ends_carry_more_than_the_tolerance(particles: int, tmp_path: Path) -> None:
    found = contact(tmp_path / "run", particles=particles)
    pressure = np.abs(found.outcome.states[-1].profile.pressure)
    assert ("chain_end" in warned(found)) == (max(pressure[0], pressure[-1]) > TOLERANCE * pressure.max())


def test_a_run_in_finer_settings_that_contradicts_the_first_is_as_uncertain_as_that(tmp_path: Path) -> None:
    """Each errs by at most what it states, unless the two differ by more than both: then by that share more."""
    fine = contact(tmp_path / "run").outcome
    one = fine.results["displacement"]
    for apart, factor in ((0.5, 1.0), (1.9, 1.0), (2.2, 1.1), (-6.0, 3.0)):
        moved = replace(one, value=one.value + apart * one.uncertainty)
        found = nested(replace(fine, results={"displacement": moved}), fine).results
        assert found["displacement"].uncertainty == pytest.approx(factor * one.uncertainty, rel=1e-9, abs=0.0)
        given = 10.0 * one.uncertainty  # by a number with ±, which is the same in both
        open_, coarse = (replace(two, errors={**two.errors, "input": given}, given=given) for two in (one, moved))
        again = nested(replace(fine, results={"displacement": coarse}), replace(fine, results={"displacement": open_}))
        own = again.results["displacement"].uncertainty - given
        assert own == pytest.approx(factor * one.uncertainty, rel=1e-9, abs=0.0)
        assert {name: found[name].uncertainty for name in found if name != "displacement"} == {
            name: other.uncertainty for name, other in fine.results.items() if name != "displacement"
        }
