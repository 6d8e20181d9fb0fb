"""The message about a wrong or unusual value: one sentence each, in the keys of the scene; its suggested fix is tried.

In a scene in SI and in one in units of the model.
"""

import pickle
from dataclasses import dataclass
from typing import Any

import pytest

from contact1d import Scene, read_scene, run
from tests.scenes import SCENES, STEEL_ON_GLASS, chains, refused

SHIPPED = (SCENES / "pull_off.toml").read_text(encoding="utf-8")
R, F, H = "bodies.profile.radius", "experiment.force", "bodies.spacing"
E = "material.upper.youngs_modulus"
SLIDE = 'experiment={ kind = "slide", normal_force = "1 N", distance = "1 µm" }'
TIMED = (SLIDE, "horizontal={}", "damping.coefficient=auto", 'plate.free=["x", "z"]', "cantilever.stiffness=1 N/m")
PARTICLES = ("bodies.lower=particles", "interaction.repulsion={ amplitude = '1 aJ', range = '1 µm' }")
NOISE = (*PARTICLES, "damping.coefficient=auto", "plate={}", "noise.seed=1")
NOT_KNOWN = "nothing says what FU stands for; give it a unit as well"


@dataclass(frozen=True)
class Odd:
    """An input that is wrong, by what is `set` in a scene; its `sentence`; what is set besides to follow that."""

    set: tuple[str, ...]
    sentence: str
    remedy: tuple[str, ...]
    scene: str = STEEL_ON_GLASS
    key: str = ""


def odd(key: str, value: str, sentence: str, remedy: str, *before: str, scene: str = STEEL_ON_GLASS) -> Odd:
    """One value of one key is wrong."""
    return Odd((*before, f"{key}={value}"), sentence, (*before, f"{key}={remedy}"), scene, key)


WRONG = [
    # A quantity of another dimension.
    odd(F, "10 mm", "must be a force, such as 10 N; 10 mm is a length", "10 N"),
    odd(E, "210 N/mm", "must be a pressure, such as 210 GPa; 210 N/mm is a force per length or energy per area",
        "210 N/mm²"),
    odd("cantilever.velocity", "1 µm", "1 µm is a length", "1 µm/s", *TIMED, *PARTICLES, "bodies.mass=1 ng"),
    Odd(('experiment={ kind = "path", displacements = ["1 µm", "2 N"] }',),
        'experiment.displacements[1] = "2 N": must be a length, such as 10 mm; 2 N is a force',
        ('experiment={ kind = "path", displacements = ["1 µm", "2 µm"] }',)),
    Odd(('bodies.profile={ kind = "cone", slope = "5 deg" }',), "5 deg is an angle: its tangent is 0.0874887",
        ('bodies.profile={ kind = "cone", slope = 0.0874887 }',)),
    # A unit that is none.
    odd(E, "210 pa", "210 pa is a time; did you mean 210 Pa?", "210 GPa"),
    odd(R, "10 LU", "10 LU is in units of the model: write 10 without quotes and unit", "10",
        "material.length_unit=1 mm"),
    odd(R, "10 (mm", "10 (mm has a unit that cannot be read", "10 mm"),
    odd(R, "10 m**99", "10 m**99 has an invalid power of a unit", "10 mm"),
    odd("noise.temperature", "300 delta_degC", "300 delta_degC is a relative scale: give a temperature in K or °C; "
        "levels (dB) are not allowed", "27 °C", *NOISE),
    # A number that is none.
    odd(R, "ten mm", 'must be a number greater than 0 (m); a number with its unit begins with a digit: "10 mm"',
        "10 mm"),
    odd(R, "10,5 mm", "10,5 mm has a comma in its number: write a decimal point, and no thousands separators",
        "10.5 mm"),
    odd(R, "1.0.5 mm", "1.0.5 mm has text after the number 1.0 that is not a unit", "1.05 mm"),
    odd(R, "1.1e300 m", "1.1e300 m is beyond 1e+300, the largest number that is calculated with", "10 mm"),
    odd(R, "0 nm", "must be greater than 0 (m)", "10 mm"),
    odd("bodies.particles", "30 µm", 'must be a whole number from 3 to 10000000, or "auto"; write a number without '
        "quotes and unit", "300"),
    # Numbers with units beside numbers without.
    odd(F, "10", f'is in FU, while {H} = "4 µm" has a unit, and {NOT_KNOWN}, such as "10 N"; or give '
        "material.force_unit", "10 N"),
    Odd((f"{R}=10 µm",), f'{H} = 1.0: is in LU, while {R} = "10 µm" has a unit, and nothing says what LU and FU stand '
        'for; give it a unit as well, such as "10 mm"; so too bodies.bulk_stiffness, interaction.repulsion.amplitude '
        "and 5 more; or give material.length_unit and material.force_unit",
        (f"{R}=10 µm", "material={ length_unit = '1 nm', force_unit = '1 nN' }"), SHIPPED),
    Odd((*TIMED, *PARTICLES, "cantilever.velocity=1 µm/s"), f'bodies.mass = 1.0: is by default in MU, while {H} = '
        '"4 µm" has a unit, and nothing says what MU stands for; give it a unit as well, such as "1 ng"; or give '
        "material.mass_unit", (*TIMED, *PARTICLES, "cantilever.velocity=1 µm/s", "material.mass_unit=1 ng")),
    odd(R, "10 µm", f'{R} = "10 µm": LU and FU follow from the run (material.surface_energy), so that units are not '
        "known before it; write a number in LU", "1000.0",
        "material={ contact_modulus = '1 GPa', surface_energy = '50 mJ/m²' }", scene=SHIPPED),
    # Materials.
    Odd(("bodies.bulk_stiffness=100 N/m",), 'bodies.bulk_stiffness = "100 N/m": follows from the material here; write '
        '"auto"', ("bodies.bulk_stiffness=auto",)),
    Odd(("material={}",), "give a number, or material.upper and material.lower",
        ("material={}", "bodies.bulk_stiffness=1 MN/m")),
]  # fmt: skip
"""Values that are wrong."""

DOUBTFUL = [
    odd(E, "210 Pa", "softer than any gel: was 210 GPa meant?", "210 GPa"),
    odd(R, "50 m", "no ball of such a radius is smooth: check its unit", "50 mm"),
]  # fmt: skip
"""Values that are allowed and look wrong."""


def lines(scene: Any, *set_: str) -> list[str]:
    """What is printed for a scene with these changes: no words of the libraries beneath."""
    error = refused(scene, set_)
    printed = str(error)
    assert printed == "\n".join(map(str, error.problems))
    for word in ("pydantic", "tuple", "literal", "Input should", "union", "discriminat", "function-"):
        assert word not in printed
    return printed.split("\n")


@pytest.mark.parametrize("case", WRONG, ids=lambda case: case.sentence[:70])
def test_a_wrong_value_gets_its_sentence_and_the_remedy_works(case: Odd) -> None:
    (line,) = lines(case.scene, *case.set)
    assert case.sentence in line
    assert line.startswith(case.key)
    assert isinstance(read_scene(case.scene, case.remedy), Scene)


@pytest.mark.parametrize("case", DOUBTFUL, ids=lambda case: case.sentence[:70])
def test_a_doubtful_value_is_told_and_the_remedy_is_not(case: Odd) -> None:
    for scene, told in ((case.set, True), (case.remedy, False)):
        done = run(read_scene(case.scene, ["experiment.force=0.1 mN", "bodies.spacing=auto", *scene]))
        doubts = [text for name, text in done.warnings.items() if name.startswith("implausible")]
        assert [case.sentence in text for text in doubts] == [True] * told


def test_particles_and_temperatures_that_look_wrong_are_told() -> None:
    small = chains(
        100.0, bodies={"particles": 20}, accuracy={"tolerance": 0.1},
        material={"length_unit": 1e-12, "force_unit": 1e-3},
        noise={"temperature": "3e5 K", "seed": 1}, damping={"coefficient": "auto"},
        experiment={"kind": "path", "displacements": [0.0, 0.05]},
    )  # fmt: skip
    warnings = run(small).warnings
    assert "radius is 1e-10 m, less than the width of two atoms: check its unit" in warnings["implausible_size"]
    assert "repulsion.range is 1.3e-13 m, a tenth of an atom's radius: check its" in warnings["implausible_size"]
    assert "3e+05 K, above any melting point: check its unit" in warnings["implausible_temperature"]


@pytest.mark.parametrize("wrong", ["interaction.attraction.range=0.5 µm", "interaction.attraction.amplitude=9 aJ"])
def test_ways_that_are_tried_have_units_where_the_scene_has(wrong: str) -> None:
    attraction = "interaction.attraction={ amplitude = '0.5 aJ', range = '2 µm' }"
    set_ = (*PARTICLES, attraction, wrong)
    (problem,) = refused(STEEL_ON_GLASS, set_).problems
    assert "LU" not in str(problem)
    assert all(str(value) in problem.hint for way in problem.ways for value in way.values())
    assert len(problem.ways) == 2
    for way in problem.ways:
        assert isinstance(read_scene(STEEL_ON_GLASS, [*set_, *(f"{key}={value}" for key, value in way.items())]), Scene)


# In units of the model.

BASE = chains(1000.0, bodies={"particles": 200}, experiment={"kind": "pull_off", "preload": 1.0})
PLATE: dict[str, Any] = {"plate": {}, "damping": {"coefficient": 0.3}}
IN_TIME = PLATE | {
    "plate": {"free": ["x", "z"]}, "horizontal": {}, "cantilever": {"stiffness": 0.5, "velocity": 0.01},
    "noise": {"temperature": 0.01, "seed": 1}, "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 5.0},
}  # fmt: skip
LISTED = {"experiment": {"kind": "path", "displacements": [0, 1]}}
SPAN = {"experiment": {"kind": "path", "displacements": {"from": 0, "to": 1, "steps": 5}}}


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("bodies.mass", "MU"),
        ("interaction.repulsion.amplitude", "FU·LU"),
        ("bodies.bulk_stiffness_tangential", "FU/LU"),
    ],
)
def test_a_size_is_a_finite_number_greater_than_zero(path: str, unit: str) -> None:
    for values, kind in (("0 -1.0", ""), ("true [1.0] 2024-01-01", "a number "), ("nan -inf", "a finite number ")):
        for value in values.split():
            assert lines(BASE, f"{path}={value}") == [f"{path} = {value}: must be {kind}greater than 0 ({unit})"]


ONE_MISTAKE: list[tuple[dict[str, Any], str, str, str]] = [
    ({}, "bodies.particles=200.0", "bodies.particles", "write 200"),
    (PLATE, 'plate.free=["x"]', "plate.free", 'must contain "z"'),
    (PLATE, 'plate.free=["z", "z"]', "plate.free", "each direction once"),
    (IN_TIME, "cantilever.velocity=-0.1", "cantilever.velocity", "experiment.path = [[velocity, distance], …]"),
    (IN_TIME, "experiment.method=dynamic", "experiment.method", "a slide is always dynamic: remove it"),
    ({}, "experiment.kind=indent", "experiment.kind", '"tangential", "hold", "history" or "impact"'),
    ({}, "experiment.kind=pull-off", "experiment.kind", 'did you mean "pull_off"?'),
    ({}, "neighbours=[{ stiffness = 0.3 }]", "neighbours", "in single brackets"),
    (SPAN, "experiment.displacements.to=0", "experiment.displacements", '"from" and "to" must differ'),
    (SPAN, "experiment.displacements.from_=0", "experiment.displacements.from_", 'did you mean "from"?'),
    ({}, "bodies.profile=parabola", "bodies.profile", 'a table with kind = "parabola"'),
    ({}, 'title="a\\nb"', "title", "one line of text"),
    ({}, "horizontal.x=1", "horizontal.x", "allowed here: no keys"),
    ({}, "neighbors.stiffness=0.3", "neighbors", 'unknown table; did you mean "neighbours"?'),
    ({}, "experiment.tolerance=1e-3", "experiment.tolerance", "it belongs in [accuracy]"),
    (LISTED, "experiment.preload=2", "experiment.preload", 'it belongs in [experiment] of kind = "pull_off"'),
]  # fmt: skip


@pytest.mark.parametrize(("tables", "override", "path", "words"), ONE_MISTAKE)
def test_one_mistake_is_one_line(tables: dict[str, Any], override: str, path: str, words: str) -> None:
    (line,) = lines(BASE | tables, override)
    assert line.startswith((f"{path}: ", f"{path} = "))
    assert words in line


@pytest.mark.parametrize(
    ("overrides", "paths"),
    [
        # A misspelt word counts as what was meant, so that what stands beside it and the rules are checked as well.
        (["experiment={ knid = 'pulloff', preload = -1, x = 2 }"],
         "experiment.knid experiment.kind experiment.x experiment.preload"),
        (["dampnig.coefficient=-1", "plate={}"], "damping.coefficient dampnig"),
        # All mistakes at once, in the order of the scene.
        (["neighbors.stiffness=0.3", "experiment.preload=-1", "bodies.particles=2", "bodies.bulk_stiffness='0.83'",
          "interaction.attraction.range=0.1", "cantilever={ stiffness = 1, velocity = 1 }"],
         "bodies.particles bodies.bulk_stiffness interaction.attraction.range cantilever experiment.preload neighbors"),
        # A wrong table of cycles is not taken for displacements.
        (["bodies.lower=rigid_plane", "friction.coefficient=0.3", "experiment={ kind = 'tangential', normal_force = 1, "
          "cycles = 3, displacements = { from = 0, to = 1, steps = 5 } }"],
         "interaction experiment.cycles experiment.cycles"),
    ],
)  # fmt: skip
def test_mistakes_come_together(overrides: list[str], paths: str) -> None:
    assert [line.partition(":")[0].partition(" ")[0] for line in lines(BASE, *overrides)] == paths.split()


def test_missing_tables_are_named_and_the_error_survives_the_way_between_processes() -> None:
    error = refused({})
    assert [problem.path for problem in error.problems] == ["title", "bodies", "experiment"]
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.problems, str(copy)) == (error.problems, str(error))


def test_a_value_is_shown_as_toml_and_shortened() -> None:
    (line,) = lines(BASE | {"title": {"a b": [True, 'q"\\\n\x01'], "c": {}}})
    assert line.startswith('title = { "a b" = [true, "q\\"\\\\\\n\\u0001"], c = {} }: ')
    (long,) = lines(BASE | {"title": ["x" * 1000]})
    assert len(long) < 120
    assert "…" in lines(BASE | {"title": 10**5000})[0]
