"""Claim: hard slides are the motion of `validation.references.slide`: there and back with a rest, too fast, on a stiff
cantilever, with particles that slip one by one."""

import numpy as np
import pytest

from contact1d import read_scene, run
from contact1d.workflow.model.settings import settings_for
from tests.scenes import SCENES
from validation.row import tables_beside
from validation.slides import integrated, mean_friction

TRACE = 1e-3
"""Of the peak: legs other than the first have timesteps of their own, and the inertia of the first one's drag."""
CLOSED = 5e-3
"""Work that is neither dissipated nor stored, over the largest of the three."""
CASES = tables_beside(__file__)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * name.endswith("one by one")) for name in CASES]
)
def test_a_hard_slide_is_the_motion_of_the_integrator(name: str) -> None:
    changes = dict(CASES[name])
    shipped = changes.pop("shipped")
    scene = read_scene(SCENES / f"{shipped}.toml").with_(changes)
    found, expected = run(scene), integrated(scene, settings_for(scene))
    assert found.friction["friction"] == pytest.approx(expected.friction, abs=TRACE * np.abs(expected.friction).max())
    work, lost, stored = (found.results[n].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=CLOSED * max(map(abs, (work, lost, stored))))
    if "path" not in changes.get("experiment", {}):
        mean, velocity = found.results["mean_friction"], changes["cantilever"]["velocity"]
        assert abs(mean.value - mean_friction(expected, 1.0 / velocity)) <= mean.uncertainty
    if name.startswith("without slips"):
        assert found.results["slips"].value == 0
