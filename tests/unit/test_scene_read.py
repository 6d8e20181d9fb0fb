"""Scene files, changes from outside, and scenes that are written as TOML and read again."""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact1d import SceneError, read_scene
from contact1d.workflow.scene import PullOff

EVERYTHING = """
title = "Pull-off of a curved body, R = 1000"

[bodies]
particles = 200            # per body, or "auto": as many as the contact needs
spacing = 1.0              # LU
profile = { kind = "parabola", radius = 1000.0 }   # upper body
bulk_stiffness = 0.83      # FU/LU per particle
bulk_stiffness_tangential = 0.83                   # optional; default: the same
mass = 1.0                 # MU per particle
lower = "particles"        # or "rigid_plane"

[interaction]              # effect: V(r) = A exp(-r/a) - B exp(-r/b)
repulsion  = { amplitude = 0.18, range = 0.13 }
attraction = { amplitude = 0.09, range = 0.26 }    # absent: no adhesion
cutoff = "auto"            # or LU

[neighbours]
stiffness = 0.3            # FU/LU

[horizontal]

[damping]
coefficient = 0.3          # FU·TU/LU, or "auto"

[noise]
temperature = 0.01         # FU·LU
seed = 1

[plate]
mass = 200.0               # MU, or "auto"
free = ["z"]               # or ["x", "z"]
damping = "auto"

[cantilever]
stiffness = 0.5            # FU/LU
velocity = 0.01            # LU/TU

[accuracy]
tolerance = 1e-3

[experiment]
kind = "pull_off"
method = "quasistatic"
preload = 1.0              # FU, F_D
"""
"""The example of the contract, word for word but for shorter comments: every table, also those that exclude others."""

TIMED = ("damping", "noise", "plate", "cantilever")


def written(folder: Path, text: str | bytes) -> Path:
    """A file in `folder` with this content."""
    path = folder / "scene.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def failure(folder: Path, text: str | bytes) -> str:
    """What is printed for a scene file with this content, without the name of the file."""
    path = written(folder, text)
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    return str(caught.value).replace(str(path), "FILE")


def test_the_example_without_what_has_time_in_it(tmp_path: Path) -> None:
    scene = read_scene(written(tmp_path, EVERYTHING), without=TIMED)
    assert scene.title == "Pull-off of a curved body, R = 1000"
    assert scene.effects == ("interaction", "neighbours", "horizontal")
    assert scene.method == "quasistatic"
    assert scene.experiment == PullOff(kind="pull_off", preload=1.0, method="quasistatic")


def test_the_whole_example_contradicts_itself_in_four_places(tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(str(written(tmp_path, EVERYTHING)))
    assert tuple(problem.path for problem in caught.value.problems) == TIMED


def test_the_effective_scene_reads_back(tmp_path: Path) -> None:
    scene = read_scene(written(tmp_path, EVERYTHING), without=TIMED)
    text = str(scene)
    assert read_scene(written(tmp_path, text)) == scene
    assert text.startswith('title = "Pull-off of a curved body, R = 1000"\n\n[bodies]\nparticles = 200\n')
    assert "\n[horizontal]\n" in text
    assert str(read_scene(written(tmp_path, text))) == text


def test_files_that_are_no_scene(tmp_path: Path) -> None:
    missing = tmp_path / "no.toml"
    for path, reason in [(missing, "no such file"), (tmp_path, "is a directory; name a file in it")]:
        with pytest.raises(SceneError) as caught:
            read_scene(path)
        assert str(caught.value) == f"{path}: {reason}"
    with pytest.raises(SceneError, match="cannot be read"):
        read_scene("a\0b")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (b"a = 1\nb = '\xe9'\n", "FILE: line 2 is not UTF-8 text; save the file as UTF-8"),
        ("a = 1\na = 2\n", "FILE, line 2, column 6: this key is given twice: a = 2"),
        ("[a]\n[b]\n[a]\n", "FILE, line 3, column 3: this table is given twice: [a]"),
        ("a = 0,83\n", "FILE, line 1, column 6: unexpected text after the value: a = 0,83; write one key"),
        ("kind = load\n", "FILE, line 1, column 8: this is not a value: kind = load; write text in quotes"),
        ("a = { b = 1,\n c = 2 }\n", "FILE, line 1, column 13: an inline table { … } must be closed on the same line"),
        ("[bodies\n", "FILE, line 1, column 8: the name of a table is not closed with ]: [bodies"),
        ("a 1\n", "FILE, line 1, column 3: a key needs = and a value: a 1"),
        ('a = "b\n', "FILE, line 1, column 7: the text is not closed with a quote"),
        ("a = [1", "FILE, at its end: a list is not closed"),
        ("a = " + "9" * 5000, "FILE: a whole number has thousands of digits"),
        ("a = " + "[" * 50000, "FILE: tables or lists are nested more than 100 deep"),
    ],
)
def test_mistakes_in_the_toml_name_their_line(tmp_path: Path, text: str | bytes, line: str) -> None:
    printed = failure(tmp_path, text)
    assert printed.startswith(line)
    assert "\n" not in printed


def test_a_byte_order_mark_and_foreign_line_ends_do_no_harm(tmp_path: Path) -> None:
    text = EVERYTHING.replace("\n", "\r\n").encode("utf-8-sig")
    assert read_scene(written(tmp_path, text), without=TIMED).bodies.particles == 200


def base(**tables: Any) -> dict[str, Any]:
    """A small good scene as a dict, with other tables."""
    bodies = {
        "particles": "auto",
        "spacing": 1.0,
        "profile": {"kind": "parabola", "radius": 10.0},
        "bulk_stiffness": 1.0,
    }
    repulsion = {"amplitude": 1.0, "range": 0.5}
    scene = {"title": "base", "bodies": bodies, "interaction": {"repulsion": repulsion}}
    return {**scene, "experiment": {"kind": "load", "force": 1.0}, **tables}


def refused(*overrides: str, without: tuple[str, ...] = ()) -> list[str]:
    """Lines printed for the base scene with these changes."""
    with pytest.raises(SceneError) as caught:
        read_scene(base(), overrides, without)
    return str(caught.value).split("\n")


def test_overrides_are_applied_in_order_and_leave_the_data_alone() -> None:
    data = base()
    overrides = ["bodies.profile.radius=2000", "bodies.spacing=3", "bodies.spacing = 0.5", "title=free text = good"]
    scene = read_scene(data, [*overrides, "neighbours.stiffness=0.2", "experiment.method=quasistatic"])
    assert (scene.bodies.profile.radius, scene.bodies.spacing, scene.title) == (2000.0, 0.5, "free text = good")
    assert (scene.effects, scene.experiment.given_method) == (("interaction", "neighbours"), "quasistatic")
    assert data == base()
    assert refused("bodies.spacing=1\nmass=2")[0].startswith('bodies.spacing = "1\\nmass=2": must be a length')


def test_one_override_needs_no_list() -> None:
    assert read_scene(base(), "title=one").title == "one"
    assert read_scene(base(neighbours={"stiffness": 1.0}), without="neighbours").neighbours is None


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("bodies.spacing", "no value; write table.key=value"),
        ("bodies.spacing= ", "no value; write table.key=value"),
        ("=3", "not a path of keys; write table.key=value"),
        ("bodies..spacing=3", "not a path of keys; write table.key=value"),
        ("title.x=3", "title is not a table; set it as a whole"),
        ("bodies.spacing.x.y=3", "bodies.spacing is not a table; set it as a whole"),
    ],
)
def test_an_override_that_sets_nothing_is_refused_as_it_stands(override: str, words: str) -> None:
    (line,) = refused(override)
    assert line.startswith(f'set "{override}": {words}')


def test_a_misspelt_override_is_found_like_a_misspelt_key() -> None:
    assert refused("bodis.spacing=2")[0].startswith('bodis: unknown table; did you mean "bodies"?')


def test_only_effects_that_are_there_can_be_removed() -> None:
    there, misspelt, none = refused(without=("noise", "nosie", "bodies"))
    assert there == "without noise: the scene has no such table; effects there: interaction"
    assert misspelt.startswith('without nosie: not an effect that can be removed; did you mean "noise"? effects: ')
    assert none.startswith("without bodies: not an effect that can be removed; effects: interaction, ")


def test_problems_of_changes_and_of_the_scene_come_together() -> None:
    assert [line.partition(":")[0] for line in refused("bodies.mass=0", "experiment.force=0", "title.x=1")] == [
        'set "title.x=1"',
        "bodies.mass = 0",
        "experiment.force = 0",
    ]


def test_what_is_not_a_table_of_tables() -> None:
    with pytest.raises(SceneError, match="scene: must be a path, TOML text, tables or a Scene, not list"):
        read_scene([1])


def test_a_scene_can_be_changed_as_data() -> None:
    scene = read_scene(base())
    assert read_scene(scene) == scene
    assert read_scene(scene.model_dump(by_alias=True)) == scene
    assert read_scene(scene, ["bodies.mass=2"]).bodies.mass == 2.0


garbage = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(["auto", "load"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["kind", "knid", "particles", "free", "from", "to", "repulsion", "table", "list", "load", "path"]
            )
            | st.text(max_size=5),
            inner,
            max_size=4,
        )
    ),
    max_leaves=8,
)
places = ["title", "bodies", "bodies.profile", "interaction", "interaction.repulsion", "plate", "experiment", "zzz"]
places += ["bodies.particles", "experiment.kind", "experiment.displacements", "experiment.displacements.from"]


@given(changes=st.dictionaries(st.sampled_from(places), garbage, max_size=4))
def test_whatever_is_written_gives_a_scene_or_a_scene_error(changes: dict[str, Any]) -> None:
    data = base(experiment={"kind": "path", "displacements": [0.0, 1.0]})
    for path, value in changes.items():
        *above, last = path.split(".")
        table: Any = data
        for key in above:
            table = table.get(key) if isinstance(table, dict) else None
        if isinstance(table, dict):
            table[last] = value
    try:
        read_scene(data)
    except SceneError as error:
        assert error.problems
        assert "\n" not in "".join(map(str, error.problems))
