"""A slide of several legs, to and fro with a rest between, of particles of another mass: the same balances hold."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.experiments.slide.findings import outcome_of
from contact1d.workflow.experiments.slide.motion import EVERY, Motion, motion_of
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.unit.test_settings_similarity import SCENES
from tests.unit.test_slide_motion import Given, integral, rows_of

SAMPLED = 1e-3
"""Relative: trapezoids of five timesteps each, and a speed that jumps between two legs."""


@pytest.fixture(scope="module")
def given() -> Given:
    tables = SCENES["slide of few particles over another spacing"]
    path = [[0.1, 3.0], [0.0, 1.0], [-0.2, 2.0]]
    scene = scene_from_dict(tables | {
        "bodies": tables["bodies"] | {"mass": 0.37},
        "experiment": {"kind": "slide", "normal_force": 1.7, "path": path},
    })  # fmt: skip
    return Given(scene, settings_for(scene))


@pytest.fixture(scope="module")
def motion(given: Given) -> Motion:
    return motion_of(given.scene, given.settings, *rows_of(given))


def test_rows_of_a_leg_begin_where_the_leg_before_ended(given: Given, motion: Motion) -> None:
    counts = [leg.rows for leg in given.legs]
    ends = np.cumsum([0, *counts])
    assert motion.leg.tolist() == [-1, *(i for i, n in enumerate(counts) for _ in range(n))]
    for i, (first, last) in enumerate(pairwise(ends)):
        rows = motion.of_leg(i)
        assert (rows.start, rows.stop) == (first, last + 1)
        assert motion.time[rows][[0, -1]] == pytest.approx([0.0 if i == 0 else given.ends[i - 1], given.ends[i]])


def test_means_are_over_the_timesteps_that_the_fragment_says(motion: Motion) -> None:
    fragment = Path(__file__).parents[2] / "lammps_inputs" / "fragments" / "cantilever.lmp"
    assert {int(found) for found in re.findall(r"ave/time\s+(\d+)", fragment.read_text(encoding="utf-8"))} == {EVERY}
    assert motion.of_leg(0).start == 0


def test_drive_and_sums_go_on_over_all_legs(given: Given, motion: Motion) -> None:
    assert motion.drive == pytest.approx(given.drive(motion.time), abs=1e-9)
    assert motion.place == pytest.approx(given.place(motion.time), abs=1e-9)
    known = integral(given, given.pull, motion.time)
    assert motion.pulled == pytest.approx(known, abs=SAMPLED * np.abs(known).max())
    work = integral(given, lambda t: given.velocity(t) * given.pull(t), motion.time)
    assert motion.work == pytest.approx(work, abs=SAMPLED * np.abs(work).max())


def test_the_momentum_of_particles_and_plate_is_what_forces_make_of_it(given: Given, motion: Motion) -> None:
    """Where its drive turns a body that goes with it gets a kick, which the balance has in its friction."""
    end = given.legs[0].rows + 1
    impulse = integral(given, given.friction, motion.time[:end])
    assert motion.impulse[:end] == pytest.approx(impulse, abs=SAMPLED * np.abs(impulse).max())


def test_files_have_a_line_for_each_row(given: Given, motion: Motion) -> None:
    start, states = rows_of(given)
    deck: Any = SimpleNamespace(scene=given.scene, settings=given.settings)
    found = outcome_of(deck, start, states, ())
    known = {
        "time": motion.time, "drive": motion.drive, "plate_x": motion.place, "friction": motion.friction,
        "cantilever_force": motion.pull, "cantilever_work": motion.work,
    }  # fmt: skip
    for name, column in known.items():
        assert found.friction[name] == pytest.approx(column[1:].tolist()), name
    assert found.friction["normal_force"] == tuple(state.force for state in states)
    assert found.quantities["slips"].value == len(found.tables["slips"]["time"])
    assert len(found.states) == 1 + len(states)
    assert np.isnan(found.radii["final"])
    last = states[-1]
    last.radius = SimpleNamespace(value=2.5)
    assert outcome_of(deck, start, states, ()).radii == {"final": 2.5}


def test_a_leg_that_was_not_come_to_has_no_rows(given: Given, motion: Motion) -> None:
    first = given.legs[0].rows
    short = motion_of(given.scene, given.settings, *(rows_of(given)[0], rows_of(given)[1][: first + 2]))
    assert short.leg.max() == 1
    assert replace(short).of_leg(1) == slice(first, first + 3)
