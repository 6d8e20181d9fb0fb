"""Claim: a state that is off by the tolerance is refused.

A particle on its spring k that is left with the force f stands f/k off its place, and what the opposite body exerts on
it is off by as much as f: of a pair, the share f over the largest tension that it can have.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from contact1d import read_scene
from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.trust import ThroughError, UntrustedError, require_trust
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import settings_for
from tests.exact import exact_context
from tests.scenes import LAW

MakeScene = Callable[..., Scene]
CONVERGED = 0.01
"""Part of the tolerance that a minimiser may leave without a word."""


def left_with(scene: Scene, residual: float) -> State:
    """A state of exact pairs, but for a force that is left on a particle [FU]."""
    with exact_context(scene).contact() as contact:
        contact.begin("loading")
        state = contact.state(-0.1)
    return State(state.phase, state.displacement, state.force, state.profile, 0.5, 0.0, residual, state.rule)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-4])
def test_a_particle_left_with_the_tolerance_of_a_pairs_largest_tension_is_not_at_rest(
    make_scene: MakeScene, tolerance: float
) -> None:
    scene = make_scene(bodies={"particles": 60}, accuracy={"tolerance": tolerance})
    law = PairInteraction(Exponential(*LAW[:2]), Exponential(*LAW[2:]))
    off = tolerance * -float(law.force(law.extremum_distance(1)))
    settings = settings_for(scene)
    require_trust(scene, settings, left_with(scene, CONVERGED * off))
    with pytest.raises(UntrustedError, match="not converged"):
        require_trust(scene, settings, left_with(scene, off))


@pytest.mark.parametrize("hot", [False, True])
def test_what_goes_through_in_a_slide_is_told_what_a_slide_can_change(hot: bool) -> None:
    """It needs [horizontal]; what is hot can be cooled."""
    shipped = read_scene(Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "slide.toml")
    scene = shipped.with_({"noise": {"temperature": 3.0, "seed": 1}}) if hot else shipped
    empty = np.zeros(0)
    nothing = Profile(empty, empty, empty, empty, empty)
    through = State("sliding", 1.0, 1.0, nothing, 0.5, 0.1, 0.0, RadiusRule(scene, 1e-3))
    with pytest.raises(ThroughError) as caught:
        require_trust(scene, settings_for(scene), through)
    assert "[horizontal]" not in str(caught.value)
    assert ("lower noise.temperature from 3 FU·LU" in str(caught.value)) == hot
