"""Measured profiles from files: what parts the columns, what is skipped, what is refused, and where a file is."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import run
from contact1d.workflow.scene import Measured, Scene, SceneError, read_scene, scene_from_dict, scene_to_toml
from contact1d.workflow.scene.profile_file import Points, ProfileFileError, read_profile

RADII, HEIGHTS = [0.0, 0.5, 1.0, 1.5, 2.0], [0.0, 0.25, 1.0, 2.25, 4.0]
ROWS = [f"{r},{z}" for r, z in zip(RADII, HEIGHTS, strict=True)]
PLAIN = "\n".join(ROWS) + "\n"

READABLE = {
    "comma": PLAIN,
    "no newline at the end": PLAIN.rstrip("\n"),
    "semicolon": PLAIN.replace(",", ";"),
    "semicolon and blanks": PLAIN.replace(",", " ; "),
    "tab": PLAIN.replace(",", "\t"),
    "blanks": PLAIN.replace(",", "   "),
    "blanks before": "\n".join("  " + row.replace(",", " ") + "  " for row in ROWS),
    "comma and blanks": PLAIN.replace(",", ", "),
    "carriage returns": PLAIN.replace("\n", "\r\n"),
    "names": "r,z\n" + PLAIN,
    "names in the model's units": "r [LU], z [LU]\n" + PLAIN,
    "names of a spreadsheet": 'sep=,\n"Radius","Height"\n' + PLAIN,
    "from the edge in": "r,z\n" + "\n".join(reversed(ROWS)),
    "heights first": "height,radius\n" + "\n".join(",".join(reversed(row.split(","))) for row in ROWS),
    "from side to side": "x,z\n" + "\n".join([f"-{row}" for row in reversed(ROWS[1:])] + ROWS),
    "names of semicolons": "r;z\n" + PLAIN.replace(",", ";"),
    "comments": "# scan 7\n" + ROWS[0] + "\n  # apex, above\n" + "\n".join(ROWS[1:]),
    "comments before names": "# scan 7\n\n# by hand\nr,z\n" + PLAIN,
    "empty lines": "\n\n" + PLAIN.replace("\n", "\n\n"),
    "byte-order mark": "\ufeff" + PLAIN,
    "byte-order mark and names": "\ufeffr,z\n" + PLAIN,
    "further columns": "r,z,what\n" + "\n".join(row + ",note" for row in ROWS),
    "a further column that is empty": "\n".join(row + "," for row in ROWS),
    "exponents": "0,0\n5e-1,2.5E-1\n+1.0,1\n1.5e0,225e-2\n2,4.\n",
}
"""What a file may look like; each holds the same points."""

UNREADABLE = {
    "empty cell": ("0,0\n0.5,\n1,1\n", "line 2: z is empty"),
    "empty radius": ("0,0\n,0.25\n1,1\n", "line 2: r is empty"),
    "blank cell": ("0,0\n0.5,  ,7\n1,1\n", "line 2: z is empty"),
    "empty cell of tabs": ("r\tz\n0\t0\n0.5\t\n", "line 3: z is empty"),
    "nan": ("0,0\n0.5,nan\n1,1\n", "line 2: z is nan"),
    "infinity": ("0,0\n0.5, -inf\n1,1\n", "line 2: z is -inf"),
    "text": ("r,z\n0,0\n0.5,broken\n1,1\n", "line 3: z is no number"),
    "text behind names": ("r,z\nµm,N\n0,0\n1,1\n", "line 1: the unit in the names is no length"),
    "decimal comma": ("r;z\n0;0\n0,5;0,25\n", "line 3: r is no number; write it with a decimal point"),
    "line counted with comments": ("# one\n\n0,0\n# four\nx,1\n", "line 5: r is no number"),
    "one column": ("0\n0.5\n1\n", "line 1: has one column; r and z are needed"),
    "one column among two": ("0,0\n0.5\n1,1\n", "line 2: has one column; r and z are needed"),
    "nothing": ("", "has no points"),
    "comments only": ("# r z\n\n#\n", "has no points"),
    "names only": ("r,z\n", "has no points"),
}
"""Text, and what the message says."""

BODIES: dict[str, Any] = {"particles": "auto", "spacing": 0.5, "bulk_stiffness": 1.0, "lower": "rigid_plane"}
PATH: dict[str, Any] = {"kind": "path", "displacements": [0.1, 0.3]}
SCENE = """title = "measured"
[bodies]
particles = "auto"
spacing = 0.5
bulk_stiffness = 1.0
lower = "rigid_plane"
profile = { kind = "table", file = "FILE" }
[experiment]
kind = "path"
displacements = [0.1, 0.3]
"""


def tables(**profile: Any) -> dict[str, Any]:
    return {"title": "measured", "bodies": BODIES | {"profile": {"kind": "table"} | profile}, "experiment": PATH}


def points(scene: Scene) -> tuple[tuple[float, ...] | None, tuple[float, ...] | None]:
    assert isinstance(scene.bodies.profile, Measured)
    return scene.bodies.profile.r, scene.bodies.profile.z


def lines(data: dict[str, Any], folder: Path) -> list[str]:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data, folder=folder)
    return str(caught.value).split("\n")


@pytest.mark.parametrize("name", READABLE)
def test_points_are_read(name: str, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(READABLE[name], encoding="utf-8", newline="")
    assert read_profile(tmp_path / "p.csv") == Points(RADII, HEIGHTS)


@pytest.mark.parametrize("name", UNREADABLE)
def test_what_is_no_profile_is_refused_with_its_line(name: str, tmp_path: Path) -> None:
    text, words = UNREADABLE[name]
    (tmp_path / "p.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ProfileFileError) as caught:
        read_profile(tmp_path / "p.csv")
    assert words in str(caught.value)
    assert "p.csv" in str(caught.value)
    printed = lines(tables(file="p.csv"), tmp_path)
    assert len(printed) == 1
    assert printed[0].startswith('bodies.profile.file = "p.csv": ')
    assert words in printed[0]


def test_empty_cell_says_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("0,0\n0.5,\n")
    assert lines(tables(file="p.csv"), tmp_path)[0].endswith("leave out a line that has no value, or interpolate it")


def test_missing_file_is_named(tmp_path: Path) -> None:
    assert lines(tables(file="p.csv"), tmp_path) == [
        f'bodies.profile.file = "p.csv": there is no file {tmp_path / "p.csv"}'
    ]


def test_folder_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    assert "cannot be read: Is a directory" in lines(tables(file="inner"), tmp_path)[0]


@pytest.mark.parametrize("content", [b"\x89PNG\r\n\x1a\n\x00\xff", bytes(range(256))])
def test_binary_file_is_no_text(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_bytes(content)
    printed = lines(tables(file="p.csv"), tmp_path)
    assert len(printed) == 1
    assert "is no text (UTF-8)" in printed[0]


def test_name_that_no_file_can_have_is_a_problem_of_the_scene(tmp_path: Path) -> None:
    assert len(lines(tables(file="a\0b"), tmp_path)) == 1


def test_points_that_are_no_profile_are_told_as_those_of_lists_are(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("1,0\n2,1\n3,2\n4,3\n")
    assert "must begin at the radius 0, not 1" in lines(tables(file="p.csv"), tmp_path)[0]


def test_file_with_too_few_points_says_so(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("0,0\n1,1\n")
    assert not any("at least one item" in line for line in lines(tables(file="p.csv"), tmp_path))


# Where a file is, and that a scene needs it once.


def test_file_is_looked_for_beside_the_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scenes" / "data").mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "scenes" / "data" / "p.csv").write_text(PLAIN)
    (tmp_path / "scenes" / "scene.toml").write_text(SCENE.replace("FILE", "data/p.csv"))
    monkeypatch.chdir(tmp_path / "elsewhere")
    for path in (tmp_path / "scenes" / "scene.toml", Path("../scenes/scene.toml"), "../scenes/scene.toml"):
        assert points(read_scene(path)) == (tuple(RADII), tuple(HEIGHTS))


def test_file_may_have_a_whole_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "scene.toml").write_text(SCENE.replace("FILE", str(tmp_path / "p.csv")))
    assert points(read_scene(tmp_path / "scenes" / "scene.toml")) == (tuple(RADII), tuple(HEIGHTS))
    monkeypatch.chdir(tmp_path)
    assert points(scene_from_dict(tables(file="p.csv"))) == (tuple(RADII), tuple(HEIGHTS))


def test_file_may_be_an_override(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    (tmp_path / "scene.toml").write_text(SCENE.replace("FILE", "gone.csv"))
    scene = read_scene(tmp_path / "scene.toml", ["bodies.profile.file=p.csv", "bodies.profile.scale=2"])
    assert points(scene)[0] == tuple(2.0 * r for r in RADII)


def test_dict_is_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    data = tables(file="p.csv", scale=2.0)
    scene_from_dict(data, folder=tmp_path)
    assert data == tables(file="p.csv", scale=2.0)


@pytest.mark.parametrize("lists", [{"r": RADII}, {"z": HEIGHTS}, {"r": RADII, "z": HEIGHTS}])
def test_file_and_lists_exclude_each_other(lists: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    printed = lines(tables(file="p.csv", **lists), tmp_path)
    assert printed[0] == (
        'bodies.profile.file = "p.csv": not together with the lists r and z; give the one or the other'
    )


def test_file_beside_one_list_is_one_problem(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    assert len(lines(tables(file="p.csv", r=RADII), tmp_path)) == 1


@pytest.mark.parametrize("misspelt", [{"kind": "tabel", "file": "p.csv"}, {"kind": "table", "fiel": "p.csv"}])
def test_misspelt_word_is_one_problem(misspelt: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    assert len(lines(tables() | {"bodies": BODIES | {"profile": misspelt}}, tmp_path)) == 1


def test_other_mistakes_are_told_together_with_that_of_the_file(tmp_path: Path) -> None:
    data = tables(file="p.csv")
    data["bodies"] = data["bodies"] | {"bulk_stiffness": -1.0}
    data["experiment"] = {"kind": "path", "displacements": []}
    assert sorted(line.partition(" ")[0] for line in lines(data, tmp_path)) == [
        "bodies.bulk_stiffness",
        "bodies.profile.file",
        "experiment.displacements",
    ]


def test_scene_of_a_run_folder_reads_back_without_the_file(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("r,z\n0,0\n0.1,0.01\n0.3,0.09\n0.7,0.49\n1.1,1.21\n")
    (tmp_path / "scene.toml").write_text(
        SCENE.replace("FILE", "p.csv").replace('csv" }', 'csv", scale = 3.3333333333333335 }')
    )
    scene = read_scene(tmp_path / "scene.toml")
    finished = run(scene, tmp_path / "run", figures=False)
    (tmp_path / "p.csv").unlink()
    again = read_scene(finished.folder / "scene.toml")
    assert again == scene
    assert hash(again) == hash(scene)
    assert scene_from_dict(finished.document["scene"]) == scene
    assert scene_from_dict(tomllib.loads(scene_to_toml(again))) == scene
    assert "p.csv" not in (finished.folder / "scene.toml").read_text()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x,r,z\n9,0,0\n9,1,0.5\n9,2,2\n9,3,4.5\n", ([0.0, 1.0, 2.0, 3.0], [0.0, 0.5, 2.0, 4.5])),
        ("z (nm); r (nm)\n0;0\n0.5;1\n2;2\n4.5;3\n", ([0.0, 1.0, 2.0, 3.0], [0.0, 0.5, 2.0, 4.5])),
        ("radius\theight\n0\t0\n1\t0.5\n2\t2\n3\t4.5\n", ([0.0, 1.0, 2.0, 3.0], [0.0, 0.5, 2.0, 4.5])),
    ],
)
def test_columns_are_found_by_their_names(text: str, expected: tuple[list[float], list[float]], tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(text, encoding="utf-8")
    read = read_profile(tmp_path / "p.csv")
    assert (read.r, read.z) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b,c\n0,0,0\n", "line 1: the names of its 3 columns are not known"),
        ("r,width\n0,0\n", "line 1: the names of its 2 columns are not known"),
        ("r,radius,z\n0,0,0\n", "line 1: 2 columns could be meant by r"),
        ("r;z\n0,0;0,0\n0,5;1,5\n", "write it with a decimal point"),
    ],
)
def test_names_that_say_nothing_and_decimal_commas_are_refused(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ProfileFileError, match=words):
        read_profile(tmp_path / "p.csv")


@pytest.mark.parametrize(
    "content", ["secret = hunter2\n", "r,z\n0,0\n1,hunter2\n", "a:hunter2,b,c\n", "0,0\nhunter2\n"]
)
def test_no_message_quotes_the_file(content: str, tmp_path: Path) -> None:
    """A scene may point at any file that its reader may read, and its messages go to whoever sent the scene."""
    (tmp_path / "p.csv").write_text(content)
    with pytest.raises(ProfileFileError, match=r"p\.csv") as caught:
        read_profile(tmp_path / "p.csv")
    assert "hunter2" not in str(caught.value)
