"""Every mistake inside a table: one line, at its path, in the words of the scene file."""

import pickle

import pytest

from contact1d.workflow.scene import Problem, SceneError, scene_from_dict
from contact1d.workflow.scene.problems import as_toml, nearest, path_of, shown
from tests.scenes import chains

BASE = chains(1000.0, bodies={"particles": 200}, experiment={"kind": "pull_off", "preload": 1.0})
POSITIVE = [
    ("bodies.upper_spacing", "LU"),
    ("bodies.profile.radius", "LU"),
    ("bodies.bulk_stiffness_tangential", "FU/LU"),
    ("bodies.mass", "MU"),
    ("interaction.repulsion.amplitude", "FU·LU"),
    ("interaction.repulsion.range", "LU"),
    ("interaction.attraction.amplitude", "FU·LU"),
    ("interaction.attraction.range", "LU"),
    ("neighbours.stiffness", "FU/LU"),
    ("experiment.preload", "FU"),
]
PLATE = ["plate={}", "damping.coefficient=0.3"]
BACK = "for a way back or a rest give experiment.path = [[velocity, distance], …] in place of a distance"
SLIDE = [
    'experiment={ kind = "slide", normal_force = 1.0, distance = 5.0 }',
    'plate.free=["x", "z"]',
    "horizontal={}",
    "damping.coefficient=0.3",
    "cantilever={ stiffness = 0.5, velocity = 0.01 }",
    "noise={ temperature = 0.01, seed = 1 }",
]
SPAN = 'experiment={ kind = "path", displacements = { from = 0, to = 1, steps = 5 } }'
LISTED = "experiment={ kind = 'path', displacements = [0, 1] }"


def lines(*overrides: str) -> list[str]:
    """What is printed for the base scene with these overrides."""
    with pytest.raises(SceneError) as caught:
        scene_from_dict(BASE, overrides)
    assert str(caught.value) == "\n".join(map(str, caught.value.problems))
    return str(caught.value).split("\n")


@pytest.mark.parametrize(("path", "unit"), POSITIVE)
@pytest.mark.parametrize("value", ["0", "-1.0", "0.0"])
def test_a_size_must_be_positive(path: str, unit: str, value: str) -> None:
    assert lines(f"{path}={value}") == [f"{path} = {value}: must be greater than 0 ({unit})"]


@pytest.mark.parametrize(("path", "unit"), POSITIVE)
@pytest.mark.parametrize("value", ["true", "[1.0]", "2024-01-01"])
def test_a_size_must_be_a_number(path: str, unit: str, value: str) -> None:
    assert lines(f"{path}={value}") == [f"{path} = {value}: must be a number greater than 0 ({unit})"]


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e999"])
def test_a_number_must_be_finite(value: str) -> None:
    given = {"1e999": "inf"}.get(value, value)
    assert lines(f"bodies.mass={value}") == [f"bodies.mass = {given}: must be a finite number greater than 0 (MU)"]


QUOTED = "a number stands without quotes"
SCENE_TABLES = (
    "title, bodies, interaction, neighbours, horizontal, adhesion, friction, damping, noise, plate, cantilever, "
    "material, accuracy, output, experiment"
)
SHAPES = '"parabola", "circle", "ellipsoid", "cone", "flat", "flat_punch", "power" or "table"'
BODIES = (
    "particles, spacing, profile, reduction, bulk_stiffness, bulk_stiffness_tangential, mass, lower, periodic, "
    "upper_particles, upper_spacing, upper_offset"
)
COUNT = 'must be a whole number from 3 to 10000000, or "auto"'
KINDS = '"load", "path", "pull_off", "slide" or "tangential"'
DISPLACEMENTS = "must be a list, each item a number (LU), or a table with from, to, steps, return"

ONE_LINE_EACH: list[tuple[list[str], str]] = [
    (
        ['bodies.spacing="1.0"'],
        f'bodies.spacing = "1.0": must be a number greater than 0 (LU), or "auto"; {QUOTED}, or with its unit: "10 mm"',
    ),
    (["bodies.spacing=-1"], 'bodies.spacing = -1: must be greater than 0 (LU), or "auto"'),
    (["bodies.spacing=true"], 'bodies.spacing = true: must be a number greater than 0 (LU), or "auto"'),
    (["bodies.particles=2"], f"bodies.particles = 2: {COUNT}"),
    (["bodies.particles=200.0"], f"bodies.particles = 200.0: {COUNT}; write 200"),
    (["bodies.particles=20.5"], f"bodies.particles = 20.5: {COUNT}"),
    (["bodies.particles=true"], f"bodies.particles = true: {COUNT}"),
    (["bodies.particles=atuo"], f'bodies.particles = "atuo": {COUNT}'),
    (["bodies.particles='200'"], f'bodies.particles = "200": {COUNT}; {QUOTED} and unit'),
    (["interaction.cutoff=-1"], 'interaction.cutoff = -1: must be greater than 0 (LU), or "auto"'),
    (["interaction.cutoff=far"], 'interaction.cutoff = "far": must be a number greater than 0 (LU), or "auto"'),
    ([*PLATE, "plate.mass=0"], 'plate.mass = 0: must be greater than 0 (MU), or "auto"'),
    ([*PLATE, "plate.damping=-1"], 'plate.damping = -1: must be at least 0 (FU·TU/LU), or "auto"'),
    ([*PLATE, "damping.coefficient=0"], 'damping.coefficient = 0: must be greater than 0 (FU·TU/LU), or "auto"'),
    ([*PLATE, 'plate.free=["x"]'], 'plate.free = ["x"]: must contain "z"'),
    ([*PLATE, 'plate.free=["z", "z"]'], 'plate.free = ["z", "z"]: must name each direction once'),
    ([*PLATE, 'plate.free=["z", "y"]'], 'plate.free[1] = "y": must be "x" or "z"'),
    ([*PLATE, "plate.free=[]"], "plate.free = []: must have at least one item"),
    ([*PLATE, "plate.free=z"], 'plate.free = "z": must be a list, each item "x" or "z"'),
    ([*SLIDE, "noise.temperature=0"], "noise.temperature = 0: must be greater than 0 (FU·LU)"),
    ([*SLIDE, "noise.seed=0"], "noise.seed = 0: must be a whole number from 1 to 2147483647"),
    ([*SLIDE, "noise.seed=2147483648"], "noise.seed = 2147483648: must be a whole number from 1 to 2147483647"),
    ([*SLIDE, "cantilever.stiffness=0"], "cantilever.stiffness = 0: must be greater than 0 (FU/LU)"),
    ([*SLIDE, "cantilever.velocity=0"], f"cantilever.velocity = 0: must be greater than 0 (LU/TU); {BACK}"),
    ([*SLIDE, "cantilever.velocity=-0.1"], f"cantilever.velocity = -0.1: must be greater than 0 (LU/TU); {BACK}"),
    ([*SLIDE, "experiment.normal_force=true"], "experiment.normal_force = true: must be a number (FU)"),
    ([*SLIDE, "experiment.distance=-1"], "experiment.distance = -1: must be greater than 0 (LU)"),
    (["accuracy.tolerance=1e-8"], "accuracy.tolerance = 1e-08: must be from 1e-07 to 0.1"),
    (["accuracy.tolerance=0.2"], "accuracy.tolerance = 0.2: must be from 1e-07 to 0.1"),
    (["accuracy.tolerance=tight"], 'accuracy.tolerance = "tight": must be a number from 1e-07 to 0.1'),
    (["experiment.kind=indent"], f'experiment.kind = "indent": must be {KINDS}'),
    (["experiment.kind=3"], f"experiment.kind = 3: must be {KINDS}"),
    (["experiment.kind=[1]"], f"experiment.kind = [1]: must be {KINDS}"),
    (["experiment.kind=pull-off"], f'experiment.kind = "pull-off": must be {KINDS}; did you mean "pull_off"?'),
    (["experiment={}"], f"experiment.kind: missing; must be {KINDS}"),
    (
        ["experiment=load"],
        f'experiment = "load": must be a table with kind = {KINDS}; write it as [experiment], its keys below',
    ),
    ([LISTED, "experiment.displacements=[]"], "experiment.displacements = []: must have at least one item"),
    ([LISTED, "experiment.displacements=3"], f"experiment.displacements = 3: {DISPLACEMENTS}"),
    (
        [LISTED, 'experiment.displacements=[0, "a"]'],
        'experiment.displacements[1] = "a": must be a number (LU); a number with its unit begins with a digit: "10 mm"',
    ),
    ([LISTED, "experiment.displacements=[0, inf]"], "experiment.displacements[1] = inf: must be a finite number (LU)"),
    (
        [SPAN, "experiment.displacements.to=0"],
        'experiment.displacements = { from = 0, to = 0, steps = 5 }: "from" and "to" must differ',
    ),
    ([SPAN, "experiment.displacements.return=no"], 'experiment.displacements.return = "no": must be true or false'),
    (
        [SPAN, "experiment.displacements.steps=0"],
        "experiment.displacements.steps = 0: must be a whole number from 1 to 1000000",
    ),
    (
        ["experiment={ kind = 'path', displacements = { from_ = 0, to = 1, steps = 5 } }"],
        'experiment.displacements.from_: unknown key; did you mean "from"? allowed here: from, to, steps, return',
    ),
    (["bodies.profile.kind=sphere"], f'bodies.profile.kind = "sphere": must be {SHAPES}'),
    (
        ["bodies.profile.kind=parabolic"],
        f'bodies.profile.kind = "parabolic": must be {SHAPES}; did you mean "parabola"?',
    ),
    (["bodies.bulk_stiffness=0"], 'bodies.bulk_stiffness = 0: must be greater than 0 (FU/LU), or "auto"'),
    (
        ["bodies.bulk_stiffness=true"],
        'bodies.bulk_stiffness = true: must be a number greater than 0 (FU/LU), or "auto"',
    ),
    (["bodies.profile={ radius = 3.0 }"], f"bodies.profile.kind: missing; must be {SHAPES}"),
    (["bodies.profile=parabola"], f'bodies.profile = "parabola": must be a table with kind = {SHAPES}'),
    (
        ["bodies.lower=particle"],
        'bodies.lower = "particle": must be "particles", "rigid_plane" or "rigid_chain"; did you mean "particles"?',
    ),
    (["title="], 'set "title=": no value; write table.key=value, for example experiment.method=dynamic'),
    (['title=""'], 'title = "": must be one line of text, not empty'),
    (['title="a\\nb"'], 'title = "a\\nb": must be one line of text, not empty'),
    (["title=3"], "title = 3: must be text in quotes"),
    (["horizontal=true"], "horizontal = true: must be a table without keys; write it as [horizontal], its keys below"),
    (["horizontal.x=1"], "horizontal.x: unknown key; allowed here: no keys"),
    (
        ["neighbours=[{ stiffness = 0.3 }]"],
        "neighbours = [{ stiffness = 0.3 }]: must be a table with stiffness; "
        "write it as [neighbours] in single brackets, its keys below",
    ),
    (
        ["neighbors.stiffness=0.3"],
        f'neighbors: unknown table; did you mean "neighbours"? allowed here: {SCENE_TABLES}',
    ),
    (["units=3"], f"units: unknown key; allowed here: {SCENE_TABLES}"),
    (
        ["bodies.stiffness=0.3"],
        f'bodies.stiffness: unknown key; did you mean "bulk_stiffness"? allowed here: {BODIES}',
    ),
    (["bodies.E=0.3"], f"bodies.E: unknown key; allowed here: {BODIES}"),
    (
        ["experiment.tolerance=1e-3"],
        "experiment.tolerance: unknown key; it belongs in [accuracy]; "
        "allowed here: kind, preload, loading_rate, velocity, stiffness, repeats, method",
    ),
    (
        ["experiment={ kind = 'load', force = 1, preload = 2 }"],
        "experiment.preload: unknown key; "
        'it belongs in [experiment] of kind = "pull_off"; allowed here: kind, force, method',
    ),
    (
        [*SLIDE, "experiment.method=dynamic"],
        "experiment.method: unknown key; a slide is always dynamic: remove it; "
        "allowed here: kind, normal_force, distance, path",
    ),
]


@pytest.mark.parametrize(("overrides", "line"), ONE_LINE_EACH, ids=[str(line) for _, line in ONE_LINE_EACH])
def test_one_mistake_is_one_line(overrides: list[str], line: str) -> None:
    assert lines(*overrides) == [line]


def test_missing_tables_and_keys() -> None:
    with pytest.raises(SceneError) as caught:
        scene_from_dict({})
    assert str(caught.value).split("\n") == [
        "title: missing; must be text in quotes",
        "bodies: missing; required table",
        "experiment: missing; required table",
    ]
    assert lines("bodies={ particles = 5, spacing = 1.0, bulk_stiffness = 1.0 }") == [
        f"bodies.profile: missing; must be a table with kind = {SHAPES}"
    ]
    assert lines("interaction.repulsion={ range = 0.1 }") == [
        "interaction.repulsion.amplitude: missing; must be a number greater than 0 (FU·LU)"
    ]


def test_a_misspelt_kind_does_not_hide_the_other_mistakes() -> None:
    assert lines("experiment={ knid = 'pulloff', preload = -1, x = 2 }") == [
        'experiment.knid: unknown key; did you mean "kind"?',
        f'experiment.kind = "pulloff": must be {KINDS}; did you mean "pull_off"?',
        "experiment.x: unknown key; allowed here: kind, preload, loading_rate, velocity, stiffness, repeats, method",
        "experiment.preload = -1: must be greater than 0 (FU)",
    ]


def test_a_misspelt_table_counts_as_the_table_that_was_meant() -> None:
    printed = lines("dampnig.coefficient=-1", "plate={}")
    assert [line.partition(" ")[0] for line in printed] == ["damping.coefficient", "dampnig:"]


def test_no_message_shows_the_inside_of_the_program() -> None:
    for overrides, _ in ONE_LINE_EACH:
        printed = "\n".join(lines(*overrides))
        for word in ("pydantic", "tuple", "literal", "Input should", "union", "discriminat", "function-"):
            assert word not in printed


def test_six_mistakes_are_six_lines_in_the_order_of_the_scene() -> None:
    assert lines(
        "bodies.particles=2",
        "bodies.bulk_stiffness='0.83'",
        "interaction.attraction.range=0.1",
        "neighbors.stiffness=0.3",
        "cantilever={ stiffness = 1, velocity = 1 }",
        "experiment.preload=-1",
    ) == [
        f"bodies.particles = 2: {COUNT}",
        f'bodies.bulk_stiffness = "0.83": must be a number greater than 0 (FU/LU), or "auto"; {QUOTED}, '
        'or with its unit: "100 N/m"',
        "interaction.attraction.range = 0.1: must be greater than the range of the repulsion, 0.13 (LU); "
        "the bodies would never attract each other: raise it to 0.26, or lower repulsion.range to 0.05",
        'cantilever: not in a pull_off: only a slide is pulled through a spring; remove it, or use kind = "slide"',
        "experiment.preload = -1: must be greater than 0 (FU)",
        f'neighbors: unknown table; did you mean "neighbours"? allowed here: {SCENE_TABLES}',
    ]


def test_the_error_survives_the_way_between_processes() -> None:
    error = SceneError([Problem("bodies", "missing", hint="required table")])
    copy = pickle.loads(pickle.dumps(error))
    assert copy.problems == error.problems
    assert str(copy) == "bodies: missing; required table"


def test_long_values_are_shortened() -> None:
    assert len(shown("x" * 1000)) == 60
    assert shown(10**5000) == "…"
    assert shown([1.0, 2]) == "[1.0, 2]"


def test_values_are_shown_as_toml() -> None:
    assert as_toml({"a b": [True, 'q"\\\n\x01'], "c": {}}) == '{ "a b" = [true, "q\\"\\\\\\n\\u0001"], c = {} }'
    assert path_of(("a", "b c", 2)) == 'a."b c"[2]'


@pytest.mark.parametrize(
    ("word", "meant"),
    [("Pull-Off", "pull_off"), ("temp", "temperature"), ("raduis", "radius"), ("te", None), ("zebra", None)],
)
def test_nearest_word(word: str, meant: str | None) -> None:
    assert nearest(word, ["pull_off", "temperature", "radius", "title"]) == meant
