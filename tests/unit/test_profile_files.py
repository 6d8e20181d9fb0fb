"""Measured profiles from files: what a file may look like, its units, what is refused, and where it is looked for.

The message about a wrong file has a suggested fix, which is tried and makes a scene.
"""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import Scene, read_scene, run
from tests.scenes import STEEL_ON_GLASS, refused

RADII, HEIGHTS = [0.0, 0.5, 1.0, 1.5, 2.0], [0.0, 0.25, 1.0, 2.25, 4.0]
ROWS = [f"{r},{z}" for r, z in zip(RADII, HEIGHTS, strict=True)]
PLAIN = "\n".join(ROWS) + "\n"
READABLE = {
    "semicolons and blanks, from the edge in": "r;z\n" + "\n".join(reversed(ROWS)).replace(",", " ; "),
    "tabs and carriage returns": PLAIN.replace(",", "\t").replace("\n", "\r\n"),
    "names in the model's units": "r [LU], z [LU]\n" + PLAIN,
    "names of a spreadsheet": 'sep=,\n"Radius","Height"\n' + PLAIN,
    "heights first": "height,radius\n" + "\n".join(",".join(reversed(row.split(","))) for row in ROWS),
    "from side to side": "x,z\n" + "\n".join([f"-{row}" for row in reversed(ROWS[1:])] + ROWS),
    "comments, empty lines and a byte-order mark": "\ufeff# scan 7\n\n# by hand\nr,z\n" + PLAIN.replace("\n", "\n\n"),
    "further columns": "x,r,z,what\n" + "\n".join(f"9,{row},note" for row in ROWS),
    "decimal commas": PLAIN.replace(",", ";").replace(".", ","),
    "decimal commas between blanks": PLAIN.replace(",", " ").replace(".", ","),
    "German names": "Gerät: Taster\nKraft: 0,5 mg\n\nRadius\tHöhe\n" + PLAIN.replace(",", "\t"),
    "exponents": "0,0\n5e-1,2.5E-1\n+1.0,1\n1.5e0,225e-2\n2,4.\n",
}
"""What a file may look like; each holds the same points."""
SCENE_FILE = """
title = "measured"
experiment = {{ kind = "path", displacements = [0.1, 0.3] }}
[bodies]
particles = "auto"
spacing = 0.5
bulk_stiffness = 1.0
lower = "rigid_plane"
profile = {{ kind = "table", file = "p.csv", scale = {scale} }}
"""
BODIES: dict[str, Any] = {"particles": "auto", "spacing": 0.5, "bulk_stiffness": 1.0, "lower": "rigid_plane"}
PATH: dict[str, Any] = {"kind": "path", "displacements": [0.1, 0.3]}


def tables(**profile: Any) -> dict[str, Any]:
    return {"title": "measured", "bodies": BODIES | {"profile": {"kind": "table"} | profile}, "experiment": PATH}


def points(data: dict[str, Any], folder: Path | None = None) -> tuple[tuple[float, ...], tuple[float, ...]]:
    profile: Any = read_scene(data, folder=folder).bodies.profile
    return profile.r, profile.z


def lines(data: dict[str, Any], folder: Path) -> list[str]:
    return str(refused(data, folder=folder)).split("\n")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A file with the points, in a folder of its own."""
    (tmp_path / "p.csv").write_text(PLAIN, encoding="utf-8")
    return tmp_path / "p.csv"


@pytest.mark.parametrize("name", READABLE)
def test_points_are_read(name: str, file: Path) -> None:
    file.write_text(READABLE[name], encoding="utf-8", newline="")
    assert points(tables(file="p.csv"), file.parent) == (tuple(RADII), tuple(HEIGHTS))


UNREADABLE = {
    "blank cell": ("0,0\n0.5,  ,7\n1,1\n", "line 2: z is empty"),
    "infinity": ("0,0\n0.5, -inf\n1,1\n", "line 2: z is -inf"),
    "text": ("# one\n\nr,z\n0,0\n0.5,hunter2\n1,1\n", "line 5: z is not a number"),
    "text behind names": ("r,z\nµm,N\n0,0\n1,1\n", "line 1: the unit in the names is not a known length"),
    "one column": ("0\n0.5\n1\n", "line 1: has one column; r and z are needed"),
    "columns without names": ("0,0,7\n1,1,7\n", "has 3 columns without names; name the radius r"),
    "two kinds of commas": ("r,z\n0,0,0,0\n0,5,0,2\n", "line 2: has 4 numbers under 2 names"),
    "names of another table": ("a:hunter2,b,c\n0,0,0\n", "line 1: the names of its 3 columns are not known"),
    "names only": ("r,z\n", "has no points"),
    "half a body": ("-1.5,2.25\n-0.5,0.25\n0.5,0.25\n1.5,2.25\n", "at least 4 points from the axis out, not 2"),
    "one point left of the axis": ("-1.0,0.5\n", "at least 4 points from the axis out, not 1"),
    "no axis": (
        "-2.5,6\n-1.5,2\n-0.5,0\n0.5,0\n1.5,2\n2.5,6\n3.5,9\n-3,9\n",
        "radii must increase; -3 LU follows 3.5 LU",
    ),
    "no text": (b"\x89PNG\r\n\x1a\n\x00\xff", "line 1 is not UTF-8 text"),
}
"""Content, and what the message says."""


@pytest.mark.parametrize("name", UNREADABLE)
def test_what_is_no_profile_is_one_problem_that_never_quotes_the_file(name: str, file: Path) -> None:
    """A scene may point at any file that its reader may read, and its messages go to whoever sent the scene."""
    content, words = UNREADABLE[name]
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    (line,) = lines(tables(file="p.csv"), file.parent)
    assert line.startswith('bodies.profile.file = "p.csv": ')
    assert words in line
    assert "hunter2" not in line


GOOD = "0,0\n1,1\n2,4\n3,9\n"
MENDED = {
    "a name that is not known": (f"r,y\n{GOOD}", "the names of its 2 columns are not known; name the radius r", GOOD),
    "two radii": ("r,radius,z\n0,0,0\n", "2 columns match r; give this name to one of them",
                  "r,old,z\n0,0,0\n1,1,1\n2,2,4\n3,3,9\n"),
    "swapped columns": ("r,z\n9,-3\n4,-2\n0,0\n4,2\n9,3\n", "the columns may be swapped; name them r and z",
                        "z,x\n9,-3\n4,-2\n1,-1\n0,0\n1,1\n4,2\n9,3\n"),
    "one unit": (f"r [µm],z\n{GOOD}", "only one of radius and height has a unit", f"r [µm],z [nm]\n{GOOD}"),
    "sides that differ": ("-2,108\n-1,102\n0,100\n1,101\n2,104\n", "these differ by 50% of its height", GOOD),
    "an apex off the middle": ("-1,4\n0,1\n1,0\n2,1\n3,4\n", "and their positions differ; shift it", GOOD),
}  # fmt: skip
"""Files that are no profile: text, sentence, the text that the sentence asks for."""


@pytest.mark.parametrize("name", MENDED)
def test_an_odd_file_gets_its_sentence_and_the_remedy_works(name: str, file: Path) -> None:
    text, sentence, mended = MENDED[name]
    units = () if "µm]" in text + mended else ("bodies.profile.scale=1 µm",)
    profile = (f"bodies.profile={{ kind = 'table', file = '{file}' }}", *units)
    file.write_text(text, encoding="utf-8")
    (problem,) = refused(STEEL_ON_GLASS, profile).problems
    assert sentence in str(problem)
    file.write_text(mended, encoding="utf-8")
    assert isinstance(read_scene(STEEL_ON_GLASS, profile), Scene)


@pytest.mark.parametrize(
    ("profile", "path"),
    [
        ({"file": "p.csv", "r": RADII, "z": HEIGHTS}, "bodies.profile.file"),
        ({"fiel": "p.csv"}, "bodies.profile.fiel"),
        ({"r": RADII, "z": HEIGHTS, "scale": 2.0}, "bodies.profile.scale"),
        *(({"file": "p.csv", "scale": scale}, "bodies.profile.scale") for scale in (0.0, 10**400)),
        ({"file": "q.csv"}, "bodies.profile.file"),
        ({"file": "a\0b"}, "bodies.profile.file"),
    ],
)  # fmt: skip
def test_a_wrong_key_is_one_problem(profile: dict[str, Any], path: str, file: Path) -> None:
    assert [line.partition(" = ")[0].partition(":")[0] for line in lines(tables(**profile), file.parent)] == [path]


def test_a_file_is_looked_for_beside_the_scene_and_needed_once(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = SCENE_FILE.format(scale=3.3333333333333335)
    (tmp_path / "scene.toml").write_text(text)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    scene = read_scene("../scene.toml")
    assert scene == read_scene(tmp_path / "scene.toml")
    assert points(tables(file=str(file), scale=4)) == points(
        tables(r=[4 * r for r in RADII], z=[4 * z for z in HEIGHTS])
    )
    finished = run(scene, tmp_path / "run", figures=False)
    file.unlink()
    again = read_scene(finished.folder / "scene.toml")
    assert again == scene == read_scene(finished.document["scene"]) == read_scene(tomllib.loads(str(again)))
    assert hash(again) == hash(scene)


@pytest.mark.parametrize(
    "names",
    [
        "r [µm], z [nm]",
        "z (nm); r (µm)",
        "r/µm\tz / nm",
        "r_um,z_nm",
        "R_(microns),height in nm",
        "Radius in µm,Height in nm",
        "r,z\nµm,nm",
    ],
)
def test_units_in_the_names_are_those_of_the_numbers(names: str, file: Path) -> None:
    order = -1 if names.startswith("z") else 1
    part = ";" if ";" in names else "\t" if "\t" in names else ","
    file.write_text("\n".join([names, *(part.join(row.split(",")[::order]) for row in ROWS)]), encoding="utf-8")
    units = {"length_unit": 1e-6, "force_unit": 1e-6}
    r, z = points(tables(file="p.csv") | {"material": units}, file.parent)
    assert r == tuple(RADII)
    # 1e-3 is rounded once, and each product once more
    assert z == pytest.approx([1e-3 * z for z in HEIGHTS], rel=1e-15)


def test_a_file_and_a_scene_have_units_both_or_neither(file: Path) -> None:
    in_si = tables(file="p.csv") | {"bodies": tables(file="p.csv")["bodies"] | {"spacing": "0.5 µm"}}
    (line,) = lines(in_si | {"material": {"force_unit": 1.0}}, file.parent)
    assert line.startswith('bodies.profile.file = "p.csv": is in LU, while bodies.spacing = "0.5 µm" has a unit')
    assert 'write scale = "1 µm"' in line
    scaled: Any = read_scene(STEEL_ON_GLASS, f"bodies.profile={{ kind='table', file='{file}', scale='2 µm' }}")
    assert scaled.bodies.profile.r == pytest.approx([2e-6 * r for r in RADII], rel=1e-15)
    file.write_text("r [µm], z [µm]\n" + PLAIN, encoding="utf-8")
    (line,) = lines(tables(file="p.csv"), file.parent)
    assert 'while bodies.profile.file = "p.csv" has a unit' in line
    assert lines(tables(file="p.csv", scale="1 nm"), file.parent)[0].startswith('bodies.profile.scale = "1 nm": ')


@pytest.mark.parametrize("power", [1, 2])
def test_an_even_number_of_points_has_its_apex_between_two(power: int, file: Path) -> None:
    file.write_text("x,z\n" + "".join(f"{i + 0.5},{abs(i + 0.5) ** power}\n" for i in range(-5, 5)))
    r = (0.0, 0.5, 1.5, 2.5, 3.5, 4.5)
    assert points(tables(file=str(file))) == (r, pytest.approx([x**power for x in r], abs=1e-12))


def test_both_sides_are_averaged(file: Path) -> None:
    file.write_text("x,z\n-2,4.1\n-1.5,2.3\n-1,1\n-0.5,0.3\n1e-9,0\n0.5,0.2\n1,1\n1.5,2.2\n2,3.9\n")
    assert points(tables(file="p.csv"), file.parent) == (tuple(RADII), pytest.approx(HEIGHTS, rel=1e-15))


@pytest.mark.parametrize(("count", "sentence"), [(100_001, "has 100001 lines"), (1_000_000, "bytes, and at most")])
def test_a_profile_of_too_many_lines_is_refused_with_the_limit(count: int, sentence: str, file: Path) -> None:
    file.write_text("1.0,100.0\n" * count)
    (line,) = lines(tables(file="p.csv"), file.parent)
    assert sentence in line
