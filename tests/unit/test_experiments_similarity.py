"""Claim: an experiment is the same in any units: scaled scenes have scaled schedules, states, results and claims.

A stiffness that multiplies where it should divide has another dimension, and shows here. Factors are powers of two, and
far from 1. No LAMMPS: states are those of `tests.exact`, so that only what the experiment makes of them is compared.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import pytest

from contact1d.workflow import units
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments import KINDS, planned
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.exact import Pairs, exact_context
from tests.scenes import chains
from tests.unit.test_settings_similarity import KEYS, SCENES, factors, massive, scaled

EXACT, CLAIM = 1e-9, 1e-6
"""Relative: round-off, and searches that end within their own bracket; of a claim, which is a difference."""
ROW = {
    "displacement": "length", "place": "length", "load": "force", "spring": "stiffness", "end": "length",
    "damping": "drag", "drag": "drag", "rest": "force", "parted": "length", "through": "length",
}  # fmt: skip
"""Of the numbers of a row; steps and starts are none of these."""
KEYS["loading_rate"] = "rate"
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
HEAT: dict[str, Any] = TIMED | {"noise": {"temperature": 1e-3, "seed": 1}}
PULL = {"kind": "pull_off", "preload": 0.3}
SMOOTH, SNAPPING = (0.018, 0.03, 0.009, 0.06), (0.18, 0.03, 0.09, 0.06)
APART = [0.0, 0.1, 0.2, 0.1, 0.03, 0.0, -0.02, -0.04, -0.06, -0.08, -0.1, -0.2]
BETWEEN = [*APART, 0.0]


def contact(law: tuple[float, ...] = SMOOTH, stiffness: float = 0.83, **tables: Any) -> dict[str, Any]:
    return chains(100.0, stiffness, law, bodies={"particles": 40}, **tables)


PLANNED = SCENES | {
    "path": contact(experiment={"kind": "path", "displacements": BETWEEN}),
    "path over snaps": contact(SNAPPING, experiment={"kind": "path", "displacements": BETWEEN}),
    "path in time with snaps": contact(
        SNAPPING, damping={"coefficient": "auto"},
        experiment={"kind": "path", "displacements": BETWEEN, "method": "dynamic"},
    ),
    "path under heat": contact(
        **HEAT | {"plate": None}, experiment={"kind": "path", "displacements": [0.0, 0.1, -0.1], "method": "dynamic"}
    ),
    "pull-off under heat": contact(
        **HEAT, experiment=PULL | {"method": "dynamic", "loading_rate": 1e-3, "preload": 0.1}
    ),
    "pull-off by a spring": contact(
        **HEAT, experiment=PULL | {"method": "dynamic", "velocity": 1e-2, "stiffness": 0.3, "preload": 0.1}
    ),
}  # fmt: skip
RUN = {
    "pull-off": contact(experiment=PULL),
    "pull-off over snaps": contact(SNAPPING, experiment=PULL),
    "pull-off in time": contact(**TIMED, experiment=PULL | {"method": "dynamic"}),
    "load": contact(experiment={"kind": "load", "force": 0.4}),
    "tension": contact(experiment={"kind": "load", "force": -0.06}),
    "no load": contact(experiment={"kind": "load", "force": 0.0}),
    "load in time": contact(**TIMED, experiment={"kind": "load", "force": 0.4, "method": "dynamic"}),
    "tension in time": contact(**TIMED, experiment={"kind": "load", "force": -0.06, "method": "dynamic"}),
    "path": contact(experiment={"kind": "path", "displacements": APART}),
    "path there and back": contact(experiment={"kind": "path", "displacements": BETWEEN}),
    "path over snaps": contact(SNAPPING, experiment={"kind": "path", "displacements": APART}),
    "path over snaps there and back": contact(SNAPPING, experiment={"kind": "path", "displacements": BETWEEN}),
}  # fmt: skip


def by(to: str) -> dict[str, float]:
    """Factors by dimension."""
    known = factors(to)
    return known | {"rate": known["force"] / known["time"]}


def same_rows(ours: tuple[Phase, ...], theirs: tuple[Phase, ...], to: str) -> None:
    """The second schedule is the first in other units."""
    assert [(one.name, len(one.rows), one.state, one.begin) for one in ours] == [
        (one.name, len(one.rows), one.state, one.begin) for one in theirs
    ]
    for first, second in zip(ours, theirs, strict=True):
        for row, other in zip(first.rows, second.rows, strict=True):
            assert type(row) is type(other)
            for name, value in asdict(row).items():
                factor = by(to)[ROW.get(name, "one")]
                assert getattr(other, name) == pytest.approx(factor * value, rel=EXACT, abs=factor * EXACT), name


@pytest.mark.parametrize("to", ["usual", "vast"])
@pytest.mark.parametrize("name", PLANNED)
def test_planned_schedules_scale_with_the_scene(name: str, to: str) -> None:
    own, other = (
        scene_from_dict(massive(tables)) for tables in (PLANNED[name], scaled(massive(PLANNED[name]), by(to)))
    )
    ours = planned(own, settings_for(own))
    assert all(phase.rows for phase in ours)
    assert ours[-1].state  # where it ends is kept
    same_rows(ours, planned(other, settings_for(other)), to)


def outcome(tables: dict[str, Any]) -> Outcome:
    scene = scene_from_dict(tables)
    context = exact_context(scene)
    if scene.method == "dynamic":
        settings = context.deck.settings
        pairs = Pairs.of(scene, settings)
        context.largest_tension = pairs.largest_tension(-2.0 * settings.rest, settings.largest_displacement)
    return KINDS[scene.experiment.kind].run[scene.method](context)


@pytest.mark.parametrize("to", ["usual", "tiny"])
@pytest.mark.parametrize("name", RUN)
def test_results_and_claims_scale_with_the_scene(name: str, to: str) -> None:
    known = by(to)
    of = {
        units.FORCE: known["force"], units.LENGTH: known["length"], units.ENERGY: known["energy"],
        units.MEAN_PRESSURE: known["force"] / known["length"] ** 2,
    }  # fmt: skip
    ours, theirs = outcome(massive(RUN[name])), outcome(scaled(massive(RUN[name]), known))
    same_rows(ours.phases, theirs.phases, to)
    assert set(ours.warnings) == set(theirs.warnings)
    assert ours.prescribed == theirs.prescribed
    assert set(ours.quantities) == set(theirs.quantities)
    assert len(ours.quantities) > (0 if name.endswith("back") else 1)
    for key, one in ours.quantities.items():
        factor, other = of[one.unit], theirs.quantities[key]
        assert other.value == pytest.approx(factor * one.value, rel=EXACT, abs=factor * EXACT), key
        assert other.uncertainty == pytest.approx(factor * one.uncertainty, rel=CLAIM, abs=factor * EXACT), key
        for parts in ("spacing_uncertainty", "compared_with"):
            if key in getattr(ours, parts):
                assert getattr(theirs, parts)[key] == pytest.approx(factor * getattr(ours, parts)[key], rel=CLAIM), key
    radii = {state: known["length"] * a for state, a in ours.radii.items()}
    assert theirs.radii == pytest.approx(radii, rel=EXACT, nan_ok=True)
