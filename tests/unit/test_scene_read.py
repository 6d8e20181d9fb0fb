"""Scene files: what is read, what follows from it, changes from outside, and files that are none, as one sentence."""

import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from contact1d import SceneError, read_scene
from tests.command import contact1d
from tests.scenes import STEEL_ON_GLASS, chains, refused

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


def test_the_example_is_read_and_written_and_contradicts_itself_in_four_places(tmp_path: Path) -> None:
    """Also with a byte-order mark and foreign line ends."""
    problems = refused(written(tmp_path, EVERYTHING)).problems
    assert tuple(problem.path for problem in problems) == TIMED
    scene = read_scene(written(tmp_path, EVERYTHING.replace("\n", "\r\n").encode("utf-8-sig")), without=TIMED)
    assert (scene.effects, scene.method) == (("interaction", "neighbours", "horizontal"), "quasistatic")
    assert scene.tables["experiment"] == {"kind": "pull_off", "preload": 1.0, "method": "quasistatic"}
    text = str(scene)
    assert read_scene(written(tmp_path, text)) == scene
    assert str(read_scene(text)) == text
    assert text.startswith('title = "Pull-off of a curved body, R = 1000"\n\n[bodies]\nparticles = 200\n')


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a = 1\na = 2\n", "FILE, line 2, column 6: this key is given twice: a = 2"),
        ("a = 0,83\n", "FILE, line 1, column 6: unexpected text after the value: a = 0,83; write one key"),
        ("kind = load\n", "FILE, line 1, column 8: this is not a value: kind = load; write text in quotes"),
        ("a = { b = 1,\n c = 2 }\n", "FILE, line 1, column 13: an inline table { … } must be closed on the same line"),
        ('a = "b\n', "FILE, line 1, column 7: the text is not closed with a quote"),
        ("a = " + "9" * 5000, "FILE: a whole number has thousands of digits"),
    ],
)
def test_mistakes_in_the_toml_name_their_line(tmp_path: Path, text: str, line: str) -> None:
    path = written(tmp_path, text)
    printed = str(refused(path)).replace(str(path), "FILE")
    assert printed.startswith(line)
    assert "\n" not in printed


def base(**tables: Any) -> dict[str, Any]:
    """A small good scene as a dict, with other tables."""
    repulsion = {"repulsion": {"amplitude": 1.0, "range": 0.5}}
    return chains(10.0, 1.0, interaction=repulsion, experiment={"kind": "load", "force": 1.0}) | tables


def lines(*overrides: str, without: tuple[str, ...] = ()) -> list[str]:
    """Lines printed for the base scene with these changes."""
    return str(refused(base(), overrides, without)).split("\n")


def test_overrides_are_applied_in_order_and_leave_the_data_alone() -> None:
    data = base()
    overrides = ["bodies.profile.radius=2000", "bodies.spacing=3", "bodies.spacing = 0.5", "title=free text = good"]
    scene = read_scene(data, [*overrides, "neighbours.stiffness=0.2", "experiment.method=quasistatic"])
    assert (scene.bodies.profile.radius, scene.bodies.spacing, scene.title) == (2000.0, 0.5, "free text = good")
    assert (scene.effects, scene.experiment.given_method) == (("interaction", "neighbours"), "quasistatic")
    assert data == base()
    assert read_scene(base(neighbours={"stiffness": 1.0}), "title=one", "neighbours") == read_scene(base(title="one"))
    assert lines("bodies.spacing=1\nmass=2")[0].startswith('bodies.spacing = "1\\nmass=2": must be a length')


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("bodies.spacing= ", "no value; write table.key=value"),
        ("bodies..spacing=3", "not a path of keys; write table.key=value"),
        ("bodies.spacing.x.y=3", "there is no such key in 1.0; set it as a whole"),
    ],
)
def test_an_override_that_sets_nothing_is_refused_as_it_stands(override: str, words: str) -> None:
    (line,) = lines(override)
    assert line.startswith(f'set "{override}": {words}')


def test_only_effects_that_are_there_can_be_removed() -> None:
    there, misspelt, none = lines(without=("noise", "nosie", "bodies"))
    assert there == "without noise: the scene has no such table; effects there: interaction"
    assert misspelt.startswith('without nosie: not an effect that can be removed; did you mean "noise"? effects: ')
    assert none.startswith("without bodies: not an effect that can be removed; effects: interaction, ")


def test_problems_of_changes_and_of_the_scene_come_together() -> None:
    found = lines("bodies.mass=0", "experiment.force=0", "title.x=1", "bodis.spacing=2")
    assert [line.partition(":")[0] for line in found] == [
        'set "title.x=1"', "bodies.mass = 0", "experiment.force = 0", "bodis",
    ]  # fmt: skip


# What a scene means.


def test_a_scene_cannot_be_changed_in_place() -> None:
    scene = read_scene(base(), ["bodies.spacing=2"])
    assert (scene.bodies.spacing, type(scene.bodies.spacing)) == (2.0, float)
    with pytest.raises(ValidationError):
        scene.bodies.mass = 2.0


@pytest.mark.parametrize("steps", [1, 1000])
def test_a_span_meets_its_ends_exactly_and_comes_back_the_same_way(steps: int) -> None:
    span = {"kind": "path", "displacements": {"from": -0.1, "to": 0.7, "steps": steps}}
    experiment: Any = read_scene(base(experiment=span)).experiment
    once: Any = read_scene(base(experiment=span), ["experiment.displacements.return=false"]).experiment
    values = experiment.places()
    assert once.places() == values[: steps + 1]
    assert (values[0], values[steps], values[-1]) == (-0.1, 0.7, -0.1)
    assert (values, len(values)) == (values[::-1], 2 * steps + 1)
    assert all(map(math.isfinite, values))


UNITS = ["m", "µ", "K", "°C", "dB", "rad", "e", "nan", "in", "%", "·", "/", "**", "⁻¹", "(", " ", "1", "-", "\0", "中"]
units = st.lists(st.sampled_from(UNITS), max_size=5).map("".join)
numbers = st.sampled_from(["auto", "load", "1", "-2.5", "1e-400", "9" * 30, "1e", ""])
texts = st.builds(str.__add__, numbers, units)
garbage = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | texts,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["kind", "knid", "free", "from", "list"]) | st.text(max_size=5), inner, max_size=4
        )
    ),
    max_leaves=8,
)
places = ["title", "bodies", "bodies.profile", "interaction", "interaction.repulsion", "plate", "experiment", "zzz"]
places += ["bodies.particles", "bodies.spacing", "experiment.kind", "experiment.displacements"]


@settings(max_examples=60)
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


# Files that are no scene.


def _large(path: Path) -> None:
    path.touch()
    os.truncate(path, 3 * 10**9)


UNREADABLE: dict[str, tuple[Callable[[Path], object], str]] = {
    "directory": (Path.mkdir, "is a directory; name a file in it"),
    "pipe": (os.mkfifo, "is not a regular file (a pipe or a device); save its content in a file"),
    "binary": (
        lambda path: path.write_bytes(b"title = 1\n\x80\xff"),
        "line 2 is not UTF-8 text; save the file as UTF-8",
    ),
    "large": (_large, "has 3000000000 bytes, and at most 8000000 are read; make it smaller"),
    "link to itself": (lambda path: path.symlink_to(path), "cannot be read: Too many levels of symbolic links"),
}
"""What makes a file that can't be read, and the sentence."""


def ended(*arguments: str | Path) -> list[str]:
    """The lines of a command that ends because its input is wrong; nothing is written."""
    result = contact1d(*arguments, "--out", "out")
    assert isinstance(result.exception, SystemExit)
    assert result.exit_code == 2
    assert not Path("out").exists()
    return result.output.splitlines()


@pytest.mark.parametrize("name", UNREADABLE)
def test_a_file_that_cannot_be_read_is_one_sentence(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a scene, as a profile and as a sweep; none is waited for."""
    make, sentence = UNREADABLE[name]
    monkeypatch.chdir(tmp_path)
    make(Path("odd"))
    Path("scene.toml").write_text(
        STEEL_ON_GLASS.replace('kind = "parabola", radius = "10 mm"', 'kind = "table", file = "odd"')
    )
    for command in (("run", "odd"), ("run", "scene.toml"), ("sweep", "odd")):
        _, line = ended(*command)
        assert f"odd: {sentence}" in line


NESTED = {
    "dotted key": lambda depth: f"{'a.' * depth}a = 1",
    "quoted keys": lambda depth: " . ".join(["'a b'"] * (depth + 1)) + " = 1",
    "table": lambda depth: f"[{'a.' * depth}a]",
    "list": lambda depth: f"extra = {'[' * depth}{']' * depth}",
    "inline table": lambda depth: f"extra = {'{ a = ' * depth}1{' }' * depth}",
}


@pytest.mark.parametrize("depth", [100, 50_000])
@pytest.mark.parametrize("kind", NESTED)
def test_what_is_nested_deeply_is_one_sentence(
    kind: str, depth: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a scene and in a sweep's [base]."""
    monkeypatch.chdir(tmp_path)
    text = NESTED[kind](depth)
    Path("scene.toml").write_text(f"{STEEL_ON_GLASS}\n{text}\n")
    Path("sweep.toml").write_text(f'[[axes]]\nkey = "experiment.force"\nvalues = ["1 N"]\n[base]\n{text}\n')
    for command in ("run", "sweep"):
        _, line = ended(command, f"{'scene' if command == 'run' else command}.toml")
        assert line.endswith("tables or lists are nested more than 100 deep; check for an extra dot or bracket")


@pytest.mark.parametrize(("keys", "count"), [(10_000, 10_000), (2, 2)])
def test_of_many_problems_the_first_are_listed(
    keys: int, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("many.toml").write_text("\n".join([STEEL_ON_GLASS, *(f"k{i} = 1" for i in range(keys))]))
    head, *lines = ended("run", "many.toml")
    assert head == f"many.toml: {count} problems"
    assert len(lines) == min(count, 21)
    assert (lines[-1] == f"  and {count - 20} more") is (count > 20)


def test_a_key_without_end_is_cut() -> None:
    printed = str(refused(f"{STEEL_ON_GLASS}\n{'k' * 10**6} = 1\n"))
    assert printed.endswith("k…: unknown key; allowed here: kind, force, method")
    assert len(printed) < 1100
