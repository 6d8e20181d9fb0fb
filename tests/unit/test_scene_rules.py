"""Rules across tables: what is changed in a scene, and the keys of all that is then refused; nothing means accepted."""

import math
import tomllib
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from contact1d import SceneError, read_scene
from tests.materials import E_STAR, JKR, RUBBER, STEEL, UNITS
from tests.scenes import chains

BASE = chains(1000.0, title="base", experiment={"kind": "pull_off", "preload": 1.0})
TABLES: dict[str, dict[str, Any]] = {
    "LOAD": {"experiment": {"kind": "load", "force": 1.0}},
    "PULLED": {"experiment": {"kind": "load", "force": -0.5}},
    "PATH": {"experiment": {"kind": "path", "displacements": [0.0, 1.0]}},
    "PULL_OFF": {"experiment": {"kind": "pull_off", "preload": 1.0}},
    "SLIDE": {"experiment": {"kind": "slide", "normal_force": 1.0, "distance": 5.0}},
    "TANGENTIAL": {"experiment": {"kind": "tangential", "normal_force": 1.0, "displacements": [0.0, 0.1]}},
    "PLANE": {"bodies": {"lower": "rigid_plane"}, "interaction": None},
    "REPULSION": {"interaction": {"repulsion": {"amplitude": 0.18, "range": 0.13}}},
    "NEIGHBOURS": {"neighbours": {"stiffness": 0.3}},
    "HORIZONTAL": {"horizontal": {}},
    "ADHESION": {"adhesion": {"work_of_adhesion": 0.005}},
    "FRICTION": {"friction": {"coefficient": 0.3}},
    "DAMPING": {"damping": {"coefficient": 0.3}},
    "NOISE": {"noise": {"temperature": 0.01, "seed": 1}},
    "PLATE": {"plate": {}},
    "PLATE_XZ": {"plate": {"free": ["x", "z"]}},
    "CANTILEVER": {"cantilever": {"stiffness": 0.5, "velocity": 0.01}},
    "DYNAMIC": {"experiment": {"method": "dynamic"}},
    "QUASISTATIC": {"experiment": {"method": "quasistatic"}},
    "SLIDING": {"horizontal": {}, "damping": {"coefficient": 0.3}, "plate": {"free": ["x", "z"]},
                "cantilever": {"stiffness": 0.5, "velocity": 0.01}},
    "FLAT": {"bodies": {"particles": 32, "profile": {"kind": "flat"}, "periodic": True}},
    "AUTO": {"bodies": {"spacing": "auto", "bulk_stiffness": "auto", "lower": "rigid_plane"}, "interaction": None,
             "material": E_STAR | UNITS},
    "CAPPED": {"bodies": {"lower": "rigid_plane",
                          "profile": {"kind": "capped_punch", "radius": 10.0, "cap_radius": 90.0}},
               "interaction": None},
    "CONE": {"bodies": {"profile": {"kind": "cone", "slope": 0.1}}},
}  # fmt: skip
"""What a word below changes: tables by name; None takes one away, and keys of [bodies] and [experiment] are added."""
BOTH = {"upper": STEEL, "lower": RUBBER}
HISTORY = {"kind": "history", "displacement": [[0.0, 0.0], [1.0, 1.0]]}


def changed(words: str, more: dict[str, Any]) -> dict[str, Any]:
    """The base scene with what the `words` change, and `more` keys "table.key"."""
    data: dict[str, Any] = {name: dict(table) if isinstance(table, dict) else table for name, table in BASE.items()}
    for word in words.split():
        for name, table in TABLES[word].items():
            whole = name not in ("bodies", "experiment") or "kind" in table
            data[name] = table if whole or table is None else data.get(name, {}) | table
    for path, value in more.items():
        name, _, key = path.partition(".")
        data[name] = value if not key else data.get(name, {}) | {key: value}
    return data


def problems(data: dict[str, Any]) -> tuple[Any, ...]:
    """The problems of a scene, each with what to do; none if it is accepted, written and read again."""
    try:
        scene = read_scene(data)
    except SceneError as error:
        assert all(problem.hint or problem.message.startswith("must be") for problem in error.problems)
        return error.problems
    assert read_scene(tomllib.loads(str(scene))) == scene == scene.with_()
    return ()


RULES: list[tuple[str, dict[str, Any], str]] = [
    # The lower body, and what belongs to it.
    ("", {}, ""),
    ("", {"interaction": None}, "interaction"),
    ("LOAD", {"bodies.lower": "rigid_plane", "horizontal": {}}, "interaction horizontal"),
    ("PLANE", {}, "bodies.lower"),
    ("PLANE SLIDE SLIDING", {}, "bodies.lower"),
    ("ADHESION", {}, "adhesion"),
    ("PLANE ADHESION", {"bodies.reduction": "geike_popov"}, "bodies.reduction"),
    ("PLANE", {"adhesion": {"work_of_adhesion": 1.0, "surface_energy": 0.5}}, "adhesion.surface_energy"),
    ("PLANE", {"adhesion": {"work_of_adhesion": 0.0}}, "adhesion.work_of_adhesion"),
    ("PLANE PATH", {"adhesion": {"work_of_adhesion": 0.0}}, ""),
    # The interaction.
    ("REPULSION", {}, "interaction.attraction"),
    ("LOAD REPULSION", {}, ""),
    # Effects in time, by method.
    ("LOAD PLATE_XZ DAMPING HORIZONTAL DYNAMIC", {}, ""),
    ("CANTILEVER", {}, "cantilever"),
    ("PATH PLATE DYNAMIC", {}, "plate damping"),
    ("LOAD NOISE", {}, "damping plate"),
    ("DYNAMIC", {}, "damping plate"),
    ("LOAD QUASISTATIC DAMPING NOISE PLATE CANTILEVER", {}, "damping noise plate cantilever"),
    ("LOAD PLATE_XZ DAMPING", {}, "horizontal"),
    ("NOISE DAMPING PLATE", {}, "experiment.loading_rate"),
    ("NOISE DAMPING PLATE", {"experiment.velocity": 3.0, "experiment.stiffness": 1.0}, ""),
    ("NOISE DAMPING PLATE", {"experiment.velocity": 3.0, "experiment.loading_rate": 1.0}, "experiment.velocity"),
    ("NOISE DAMPING PLATE", {"experiment.stiffness": 3.0, "experiment.loading_rate": 1.0}, "experiment.stiffness"),
    ("", {"experiment.repeats": 3}, "experiment.repeats"),
    # Slides.
    ("SLIDE", {}, "horizontal damping plate cantilever"),
    ("SLIDE SLIDING PLATE", {}, "plate.free"),
    ("SLIDE SLIDING QUASISTATIC", {}, "experiment.method"),
    ("SLIDE SLIDING REPULSION", {"experiment.normal_force": 0.0}, "experiment.normal_force"),
    ("SLIDE SLIDING", {"experiment.path": [[0.1, 1.0]]}, "experiment.path"),
    ("SLIDING", {"experiment": {"kind": "slide", "normal_force": 1.0}}, "experiment.distance"),
    ("SLIDE SLIDING FLAT", {}, ""),
    ("SLIDE SLIDING FLAT", {"bodies.particles": "auto"}, "bodies.particles"),
    ("SLIDE SLIDING FLAT", {"bodies.upper_spacing": 1.1}, "bodies.upper_spacing"),
    ("SLIDE SLIDING FLAT", {"bodies.bulk_stiffness_tangential": 9.0}, "bodies.bulk_stiffness_tangential"),
    ("SLIDE SLIDING FLAT", {"bodies.periodic": False}, "bodies.profile.kind"),
    ("SLIDE SLIDING", {"bodies.periodic": True, "bodies.particles": 32}, "bodies.periodic"),
    ("LOAD FLAT", {}, "bodies.periodic"),
    # Friction on a plane.
    ("PLANE TANGENTIAL", {}, "friction"),
    ("TANGENTIAL FRICTION", {}, "bodies.lower"),
    ("LOAD PLANE FRICTION", {}, "friction"),
    ("SLIDE SLIDING FRICTION", {}, "friction friction"),
    ("PLANE TANGENTIAL FRICTION ADHESION NEIGHBOURS DAMPING", {}, "adhesion neighbours neighbours damping"),
    ("PLANE TANGENTIAL FRICTION", {"experiment.normal_displacement": 0.1}, "experiment.normal_displacement"),
    ("PLANE TANGENTIAL FRICTION", {"experiment.normal_force": [1.0, 2.0, 3.0]}, "experiment.normal_force"),
    ("PLANE TANGENTIAL FRICTION", {"experiment.normal_force": [1.0]}, "experiment.normal_force"),
    ("PLANE TANGENTIAL FRICTION", {"experiment.normal_force": [0.0, 0.0]}, "experiment.normal_force"),
    # A spacing that is left to the program; a punch, whose edge is half a spacing beyond its last particle.
    ("LOAD", {"bodies.spacing": "auto"}, "bodies.spacing"),
    ("LOAD AUTO", {"bodies.particles": 20, "bodies.bulk_stiffness_tangential": 1.0},
     "bodies.particles bodies.bulk_stiffness_tangential"),
    ("LOAD AUTO NEIGHBOURS", {}, "bodies.spacing"),
    ("", {"bodies.profile": {"kind": "flat_punch", "radius": 10.0}, "bodies.particles": 20}, ""),
    ("", {"bodies.profile": {"kind": "flat_punch", "radius": 10.0}, "bodies.particles": 21}, "bodies.particles"),
    ("", {"bodies.profile": {"kind": "flat_punch", "radius": 1.0}}, "bodies.profile.radius"),
    ("LOAD CAPPED", {}, ""),
    ("LOAD CAPPED", {"bodies.particles": 20}, ""),
    ("LOAD CAPPED", {"bodies.spacing": 0.8}, "bodies.profile.radius"),
    ("LOAD CAPPED", {"bodies.spacing": 10.0}, "bodies.profile.radius"),
    ("LOAD CAPPED NEIGHBOURS", {}, "neighbours"),
    ("CAPPED", {"experiment": HISTORY, "viscoelasticity": {"retardation_time": 1.0}}, "viscoelasticity"),
    ("CAPPED TANGENTIAL FRICTION", {}, "friction"),
    ("PULL_OFF CAPPED ADHESION", {}, ""),
    ("PULL_OFF CAPPED ADHESION", {"adhesion.range": 0.1}, "adhesion.range"),
    ("CAPPED", {"bodies.lower": "particles", "interaction": BASE["interaction"]}, "bodies.lower"),
    ("CAPPED", {"experiment": {"kind": "impact", "velocity": 1.0}, "plate": {"mass": 1.0}}, "bodies.profile.kind"),
    # The material: one elasticity, and one way to the units.
    ("", {"material": BOTH | {"length_unit": 1e-9}}, ""),
    ("", {"material": E_STAR | UNITS, "bodies.bulk_stiffness": "auto"}, ""),
    ("", {"material": {"upper": STEEL, "length_unit": 1.0}}, "material.lower"),
    ("", {"material": E_STAR, "bodies.bulk_stiffness": "auto"}, "material.length_unit material.force_unit"),
    ("", {"material": JKR | UNITS}, "material.length_unit material.force_unit"),
    ("", {"material": JKR, "bodies.bulk_stiffness": "auto"}, "bodies.bulk_stiffness"),
    ("LOAD", {"material": JKR}, "material.surface_energy"),
    ("CONE", {"material": JKR}, "material.surface_energy"),
    ("PATH REPULSION", {"material": JKR}, "material.surface_energy"),
    # Rules are checked in spite of wrong values elsewhere, and silent about what is not known.
    ("QUASISTATIC DAMPING", {"bodies.spacing": -1.0, "interaction.cutoff": -1.0},
     "bodies.spacing interaction.cutoff damping"),
    ("DAMPING", {"experiment.method": 3}, "experiment.method"),
    ("PLANE", {"experiment": {"kind": "history", "displacement": "far", "force": [[0.0, 0.0], [1.0, 1.0]]}},
     "experiment.displacement experiment.force"),
]  # fmt: skip


@pytest.mark.parametrize(("words", "more", "refused"), RULES)
def test_what_fits_together_is_accepted_and_all_else_refused_by_its_keys(
    words: str, more: dict[str, Any], refused: str
) -> None:
    assert sorted(problem.path for problem in problems(changed(words, more))) == sorted(refused.split())


@given(
    amplitudes=st.tuples(st.floats(0.01, 10), st.floats(0.01, 10)),
    ranges=st.tuples(st.floats(0.05, 2), st.floats(0.05, 2)),
)
def test_the_interaction_is_accepted_where_its_force_changes_sign_once_from_repulsion(
    amplitudes: tuple[float, float], ranges: tuple[float, float]
) -> None:
    (A, B), (a, b) = amplitudes, ranges
    # Nearer to the limits the sign of the difference is round-off, or the force is smaller than any float.
    assume(abs(A * b / (B * a) - 1) > 1e-3 and abs(b / a - 1) > 0.05)
    law = {"repulsion": {"amplitude": A, "range": a}, "attraction": {"amplitude": B, "range": b}}
    far = (1 + abs(math.log(A * b / (B * a)))) * a * b / abs(b - a)  # where the longer range outweighs the amplitudes
    near, distant = (A / a * math.exp(-r / a) - B / b * math.exp(-r / b) for r in (0.0, far))  # -dV/dr
    found = problems(BASE | {"interaction": law})
    assert (not found) == (near > 0 > distant)
    assert all(problem.path.startswith("interaction.attraction.") for problem in found)
