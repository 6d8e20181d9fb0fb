"""Rules across tables: each one broken on its own, by its path and its words; and the scenes that keep them."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from contact1d.workflow.scene import Problem, SceneError, scene_from_dict
from tests.scenes import chains

BASE = chains(1000.0, title="base", experiment={"kind": "pull_off", "preload": 1.0})
LOAD = 'experiment={ kind = "load", force = 1.0 }'
PATH = 'experiment={ kind = "path", displacements = [0.0, 1.0] }'
SLIDE = 'experiment={ kind = "slide", normal_force = 1.0, distance = 5.0 }'
PLANE = "bodies.lower=rigid_plane"
DAMPING = "damping.coefficient=0.3"
NOISE = "noise={ temperature = 0.01, seed = 1 }"
PLATE = "plate={}"
PLATE_XZ = 'plate.free=["x", "z"]'
HORIZONTAL = "horizontal={}"
CANTILEVER = "cantilever={ stiffness = 0.5, velocity = 0.01 }"
REPULSION_ONLY = "interaction={ repulsion = { amplitude = 0.18, range = 0.13 } }"
DYNAMIC = "experiment.method=dynamic"
QUASISTATIC = "experiment.method=quasistatic"


def problems(*overrides: str, without: tuple[str, ...] = ()) -> dict[str, Problem]:
    """Problems of the base scene with these overrides, by path; a path may have one only."""
    with pytest.raises(SceneError) as caught:
        scene_from_dict(BASE, overrides, without)
    found = caught.value.problems
    by_path = {problem.path: problem for problem in found}
    assert len(by_path) == len(found)
    return by_path


GOOD = [
    [],
    [LOAD],
    [LOAD, "experiment.force=-0.5"],
    [LOAD, "experiment.force=0"],
    [LOAD, REPULSION_ONLY],
    [LOAD, PLATE, DAMPING],
    [LOAD, PLATE, DAMPING, NOISE],
    [LOAD, PLATE_XZ, DAMPING, HORIZONTAL],
    [LOAD, PLATE_XZ, DAMPING, HORIZONTAL, DYNAMIC],
    [PATH],
    [PATH, REPULSION_ONLY],
    [PATH, DAMPING],
    [PATH, DAMPING, NOISE],
    [PATH, HORIZONTAL, "neighbours.stiffness=0.3"],
    [PLATE, DAMPING],
    [PLATE_XZ, DAMPING, HORIZONTAL],
    [SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL],
    [SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL, NOISE],
    [SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL, REPULSION_ONLY],
    ["interaction.cutoff=0.4"],
]


@pytest.mark.parametrize("overrides", GOOD)
def test_scenes_that_fit(overrides: list[str]) -> None:
    assert scene_from_dict(BASE, overrides).title == "base"


@pytest.mark.parametrize("overrides", [[LOAD], [PATH], [PATH, DAMPING], [LOAD, PLATE, DAMPING]])
def test_scenes_that_fit_on_a_rigid_plane(overrides: list[str]) -> None:
    scene = scene_from_dict(BASE, [PLANE, "neighbours.stiffness=0.3", *overrides], ["interaction"])
    assert scene.interaction is None


# Overrides; the problems they make, by path: words that the message (with its hint) must have.
BAD: list[tuple[list[str], dict[str, str]]] = [
    ([LOAD, PLANE], {"interaction": "not with bodies.lower"}),
    ([LOAD, PLANE, HORIZONTAL], {"interaction": "remove it", "horizontal": "useless on a rigid plane"}),
    ([PLANE], {"bodies.lower": "cannot hold"}),
    ([PLANE, SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL], {"bodies.lower": "cannot drag"}),
    ([REPULSION_ONLY], {"interaction.attraction": "needed by a pull_off"}),
    ([NOISE, DAMPING, PLATE], {"experiment.loading_rate": "needed by a pull_off with [noise]"}),
    (["experiment.repeats=3"], {"experiment.repeats": "only with [noise]"}),
    (["experiment.velocity=3"], {"experiment.velocity": "only with [noise]"}),
    (
        [NOISE, DAMPING, PLATE, "experiment.velocity=3", "experiment.loading_rate=1"],
        {"experiment.velocity": "not together with a loading_rate"},
    ),
    (
        [NOISE, DAMPING, PLATE, "experiment.stiffness=3", "experiment.loading_rate=1"],
        {"experiment.stiffness": "only with a velocity"},
    ),
    ([CANTILEVER], {"cantilever": 'use kind = "slide"'}),
    ([LOAD, CANTILEVER], {"cantilever": 'use kind = "slide"'}),
    ([PATH, CANTILEVER, DAMPING], {"cantilever": 'use kind = "slide"'}),
    ([PATH, PLATE], {"plate": "prescribes the plate's place"}),
    ([PATH, PLATE, DYNAMIC], {"plate": "prescribes the plate's place", "damping": "a dynamic path"}),
    ([PATH, DYNAMIC], {"damping": "a dynamic path"}),
    ([PATH, NOISE], {"damping": "a dynamic path, made dynamic by [noise]"}),
    ([PATH, DYNAMIC, NOISE], {"damping": "a dynamic path"}),
    ([LOAD, NOISE], {"damping": "made dynamic by [noise]", "plate": "made dynamic by [noise]"}),
    ([DYNAMIC], {"damping": "a dynamic pull_off", "plate": 'add [plate] with mass = "auto"'}),
    ([DAMPING], {"plate": "a dynamic pull_off, made dynamic by [damping]"}),
    ([LOAD, PLATE], {"damping": "a dynamic load, made dynamic by [plate]"}),
    ([LOAD, DYNAMIC, NOISE, PLATE], {"damping": "a dynamic load and by [noise]"}),
    ([LOAD, DAMPING], {"plate": "needed by a dynamic load"}),
    ([LOAD, QUASISTATIC, DAMPING], {"damping": 'use experiment.method = "dynamic"'}),
    ([LOAD, QUASISTATIC, NOISE], {"noise": "no time in it"}),
    (
        [LOAD, QUASISTATIC, DAMPING, NOISE, PLATE, CANTILEVER],
        {"damping": "no time", "noise": "no time", "plate": "no time", "cantilever": "only a slide"},
    ),
    ([SLIDE], {"horizontal": "a slide", "damping": "a slide", "plate": "a slide", "cantilever": "a slide"}),
    ([SLIDE, PLATE_XZ, DAMPING, CANTILEVER], {"horizontal": "needed by a slide; add [horizontal], an empty table"}),
    ([LOAD, PLATE_XZ, DAMPING], {"horizontal": 'needed by plate.free with "x"; write plate.free = ["z"], or add'}),
    ([PLATE_XZ, DAMPING], {"horizontal": "particles cannot follow a plate along x"}),
    ([SLIDE, PLATE, DAMPING, CANTILEVER, HORIZONTAL], {"plate.free": 'must contain "x"'}),
    ([SLIDE, 'plate.free=["z"]', DAMPING, CANTILEVER, HORIZONTAL], {"plate.free": 'must contain "x"'}),
    ([SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL, QUASISTATIC], {"experiment.method": "always dynamic"}),
    (
        [SLIDE, PLATE_XZ, DAMPING, CANTILEVER, HORIZONTAL, REPULSION_ONLY, "experiment.normal_force=0"],
        {"experiment.normal_force": "needs interaction.attraction"},
    ),
    ([LOAD, REPULSION_ONLY, "experiment.force=0"], {"experiment.force": "greater than 0 (FU) without attraction"}),
    ([LOAD, REPULSION_ONLY, "experiment.force=-1"], {"experiment.force": "needs interaction.attraction"}),
    (["interaction.attraction.range=0.13"], {"interaction.attraction.range": "greater than the range of the repul"}),
    (["interaction.attraction.amplitude=0.37"], {"interaction.attraction.amplitude": "less than 0.36 (FU·LU)"}),
    (["interaction.cutoff=0.36"], {"interaction.cutoff": "force-free distance, 0.360437 (LU)"}),
]


@pytest.mark.parametrize(("overrides", "expected"), BAD)
def test_each_rule_names_its_path_and_what_to_do(overrides: list[str], expected: dict[str, str]) -> None:
    found = problems(*overrides)
    assert set(found) == set(expected)
    for path, words in expected.items():
        assert words in str(found[path])


def test_particles_need_an_interaction() -> None:
    assert 'use bodies.lower = "rigid_plane"' in problems(without=("interaction",))["interaction"].hint


def test_a_tensile_load_on_a_rigid_plane_is_refused() -> None:
    assert set(problems(PLANE, LOAD, "experiment.force=-1", without=("interaction",))) == {"experiment.force"}


def test_rules_are_checked_in_spite_of_wrong_values_elsewhere() -> None:
    found = problems("bodies.spacing=-1", QUASISTATIC, "experiment.preload=0", DAMPING, "interaction.cutoff=-1")
    assert set(found) == {"bodies.spacing", "experiment.preload", "damping", "interaction.cutoff"}


def test_rules_are_silent_about_what_is_not_known() -> None:
    assert set(problems("experiment.kind=indent", DAMPING, CANTILEVER)) == {"experiment.kind"}
    assert set(problems("experiment.kind=indent", NOISE)) == {"experiment.kind", "damping"}
    assert set(problems("experiment.method=3", DAMPING)) == {"experiment.method"}
    assert set(problems("bodies.lower=3", without=("interaction",))) == {"bodies.lower"}
    assert set(problems("interaction.repulsion.amplitude=0", "interaction.cutoff=1e-9")) == {
        "interaction.repulsion.amplitude"
    }


def force(law: dict[str, dict[str, float]], r: float) -> float:
    """Force −dV/dr [FU] of the two-exponential law, by central differences of the energy itself."""
    h = 1e-5 * law["repulsion"]["range"]
    energy = [
        law["repulsion"]["amplitude"] * math.exp(-s / law["repulsion"]["range"])
        - law["attraction"]["amplitude"] * math.exp(-s / law["attraction"]["range"])
        for s in (r - h, r + h)
    ]
    return (energy[0] - energy[1]) / (2 * h)


@given(
    amplitudes=st.tuples(st.floats(0.01, 10), st.floats(0.01, 10)),
    ranges=st.tuples(st.floats(0.05, 2), st.floats(0.05, 2)),
)
def test_the_law_is_accepted_where_force_changes_sign_once_from_repulsion(
    amplitudes: tuple[float, float], ranges: tuple[float, float]
) -> None:
    (A, B), (a, b) = amplitudes, ranges
    # Nearer to the limits the sign of the difference is round-off, or the force is smaller than any float.
    assume(abs(A * b / (B * a) - 1) > 1e-3 and abs(b / a - 1) > 0.05)
    law = {"repulsion": {"amplitude": A, "range": a}, "attraction": {"amplitude": B, "range": b}}
    far = (1 + abs(math.log(A * b / (B * a)))) * a * b / abs(b - a)  # where the longer range outweighs the amplitudes
    if force(law, 0.0) > 0 > force(law, far):
        assert scene_from_dict(BASE | {"interaction": law}).interaction is not None
    else:
        with pytest.raises(SceneError) as caught:
            scene_from_dict(BASE | {"interaction": law})
        assert [problem.path.split(".")[1] for problem in caught.value.problems] == ["attraction"]


def test_the_force_vanishes_where_the_cutoff_rule_says() -> None:
    law = BASE["interaction"]
    limit = 0.360437  # from the message tested above; six digits
    assert force(law, limit - 1e-5) > 0 > force(law, limit + 1e-5)
    assert scene_from_dict(BASE, [f"interaction.cutoff={limit + 1e-5}"])
    assert set(problems(f"interaction.cutoff={limit - 1e-5}")) == {"interaction.cutoff"}
