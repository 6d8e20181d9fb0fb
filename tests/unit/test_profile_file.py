"""Measured profiles from files: what a file may look like, its units, what is refused, and where it is looked for.

What a wrong file is told, with a remedy that is tried: `test_wrong_inputs`.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import Scene, SceneError, read_scene, run
from contact1d.workflow.scene import Measured

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
    "decimal commas": PLAIN.replace(",", ";").replace(".", ","),
    "decimal commas between tabs": PLAIN.replace(",", "\t").replace(".", ","),
    "decimal commas between blanks": "0,0 0,0\n"
    + "\n".join(f"{r:.1f} {z:.2f}" for r, z in zip(RADII, HEIGHTS, strict=True)).replace(".", ",")[8:].lstrip(),
    "German names": "Gerät: Taster\nKraft: 0,5 mg\n\nRadius\tHöhe\n" + PLAIN.replace(",", "\t"),
    "French names": "Rayon;Hauteur\n" + PLAIN.replace(",", ";"),
    "lines of an instrument": "Date: 1.2.2026, 10:00\nPoints: 5\n" + PLAIN,
    "exponents": "0,0\n5e-1,2.5E-1\n+1.0,1\n1.5e0,225e-2\n2,4.\n",
}
"""What a file may look like; each holds the same points."""

BODIES: dict[str, Any] = {"particles": "auto", "spacing": 0.5, "bulk_stiffness": 1.0, "lower": "rigid_plane"}
PATH: dict[str, Any] = {"kind": "path", "displacements": [0.1, 0.3]}


def tables(**profile: Any) -> dict[str, Any]:
    return {"title": "measured", "bodies": BODIES | {"profile": {"kind": "table"} | profile}, "experiment": PATH}


def in_si(**profile: Any) -> dict[str, Any]:
    bodies = BODIES | {"profile": {"kind": "table"} | profile, "spacing": "0.5 µm", "bulk_stiffness": "1 N/m"}
    return {"title": "si", "bodies": bodies, "experiment": {"kind": "path", "displacements": ["0.1 µm"]}}


def points(scene: Scene) -> tuple[tuple[float, ...] | None, tuple[float, ...] | None]:
    assert isinstance(scene.bodies.profile, Measured)
    return scene.bodies.profile.r, scene.bodies.profile.z


def lines(data: dict[str, Any], folder: Path) -> list[str]:
    with pytest.raises(SceneError) as caught:
        read_scene(data, folder=folder)
    return str(caught.value).split("\n")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A file with the points, in a folder of its own."""
    (tmp_path / "p.csv").write_text(PLAIN, encoding="utf-8")
    return tmp_path / "p.csv"


@pytest.mark.parametrize("name", READABLE)
def test_points_are_read(name: str, file: Path) -> None:
    file.write_text(READABLE[name], encoding="utf-8", newline="")
    assert points(read_scene(tables(file="p.csv"), folder=file.parent)) == (tuple(RADII), tuple(HEIGHTS))


UNREADABLE = {
    "empty radius": ("0,0\n,0.25\n1,1\n", "line 2: r is empty"),
    "blank cell": ("0,0\n0.5,  ,7\n1,1\n", "line 2: z is empty"),
    "empty cell of tabs": ("r\tz\n0\t0\n0.5\t\n", "line 3: z is empty"),
    "nan": ("0,0\n0.5,nan\n1,1\n", "line 2: z is nan"),
    "infinity": ("0,0\n0.5, -inf\n1,1\n", "line 2: z is -inf"),
    "text": ("r,z\n0,0\n0.5,hunter2\n1,1\n", "line 3: z is not a number"),
    "text behind names": ("r,z\nµm,N\n0,0\n1,1\n", "line 1: the unit in the names is not a known length"),
    "line counted with comments": ("# one\n\n0,0\n# four\nx,1\n", "line 5: r is not a number"),
    "one column": ("0\n0.5\n1\n", "line 1: has one column; r and z are needed"),
    "names of another table": ("a:hunter2,b,c\n0,0,0\n", "line 1: the names of its 3 columns are not known"),
    "two kinds of commas": ("r,z\n0,0,0,0\n0,5,0,2\n", "line 2: has 4 numbers under 2 names"),
    "names only": ("r,z\n", "has no points"),
    "comments only": ("# r z\n\n#\n", "has no points"),
    "half a body": ("-1.5,2.25\n-0.5,0.25\n0.5,0.25\n1.5,2.25\n", "at least 4 points from the axis out, not 2"),
    "no axis": ("-2.5,6\n-1.5,2\n-0.5,0\n0.5,0\n1.5,2\n2.5,6\n3.5,9\n-3,9\n", "radii must increase; -3 follows 3.5"),
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


def test_what_is_no_file_is_one_problem(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    for name, words in {"p.csv": "no such file", "inner": "is a directory", "a\0b": "cannot be read"}.items():
        (line,) = lines(tables(file=name), tmp_path)
        assert words in line


@pytest.mark.parametrize(
    ("profile", "paths"),
    [
        ({"file": "p.csv", "r": RADII}, ["bodies.profile.file"]),
        ({"file": "p.csv", "r": RADII, "z": HEIGHTS}, ["bodies.profile.file"]),
        ({"fiel": "p.csv"}, ["bodies.profile.fiel"]),
        ({"kind": "tabel", "file": "p.csv"}, ["bodies.profile.kind"]),
        *(({"file": "p.csv", "scale": scale}, ["bodies.profile.scale"])
          for scale in (0.0, -1.0, float("inf"), True, [1.0], 10**400, "2 N")),
    ],
)  # fmt: skip
def test_a_wrong_key_beside_a_file_is_one_problem(profile: dict[str, Any], paths: list[str], file: Path) -> None:
    assert [line.partition(" = ")[0].partition(":")[0] for line in lines(tables(**profile), file.parent)] == paths


def test_other_mistakes_are_reported_together_with_that_of_the_file(tmp_path: Path) -> None:
    data = tables(file="p.csv")
    data |= {"bodies": data["bodies"] | {"bulk_stiffness": -1.0}, "experiment": PATH | {"displacements": []}}
    assert sorted(line.partition(" ")[0] for line in lines(data, tmp_path)) == [
        "bodies.bulk_stiffness", "bodies.profile.file", "experiment.displacements",
    ]  # fmt: skip


def test_a_file_is_looked_for_beside_the_scene_and_needed_once(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere").mkdir()
    text = 'title = "measured"\n[bodies]\nparticles = "auto"\nspacing = 0.5\nbulk_stiffness = 1.0\n'
    text += 'lower = "rigid_plane"\nprofile = { kind = "table", file = "p.csv", scale = 3.3333333333333335 }\n'
    (tmp_path / "scene.toml").write_text(text + '[experiment]\nkind = "path"\ndisplacements = [0.1, 0.3]\n')
    monkeypatch.chdir(tmp_path / "elsewhere")
    scene = read_scene("../scene.toml")
    assert scene == read_scene(tmp_path / "scene.toml")
    assert points(read_scene("../scene.toml", ["bodies.profile.scale=2"]))[0] == tuple(2.0 * r for r in RADII)
    assert points(read_scene(tables(file=str(file)))) == (tuple(RADII), tuple(HEIGHTS))
    finished = run(scene, tmp_path / "run", figures=False)
    file.unlink()
    again = read_scene(finished.folder / "scene.toml")
    assert again == scene == read_scene(finished.document["scene"])
    assert hash(again) == hash(scene)
    assert read_scene(tomllib.loads(str(again))) == scene


def test_scale_multiplies_radii_and_heights(file: Path) -> None:
    data = tables(file="p.csv", scale=4)
    scene = read_scene(data, folder=file.parent)
    assert scene == read_scene(tables(r=[4.0 * r for r in RADII], z=[4.0 * z for z in HEIGHTS]))
    assert data == tables(file="p.csv", scale=4)
    radii = points(read_scene(in_si(file="p.csv", scale="2 µm"), folder=file.parent))[0]
    assert radii == pytest.approx([2e-6 * r for r in RADII], rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    "names",
    ["r [µm], z [nm]", "z (nm); r (µm)", "r/µm\tz / nm", "r_um,z_nm", "Radius in µm,Height in nm", "r,z\nµm,nm"],
)
def test_units_in_the_names_are_those_of_the_numbers(names: str, file: Path) -> None:
    order = -1 if names.startswith("z") else 1
    part = ";" if ";" in names else "\t" if "\t" in names else ","
    file.write_text("\n".join([names, *(part.join(row.split(",")[::order]) for row in ROWS)]), encoding="utf-8")
    units = {"length_unit": 1e-6, "force_unit": 1e-6}
    scene = read_scene(tables(file="p.csv") | {"material": units}, folder=file.parent)
    assert points(scene)[0] == tuple(RADII)
    # 1e-3 is rounded once, and each product once more
    assert points(scene)[1] == pytest.approx([1e-3 * z for z in HEIGHTS], rel=1e-15, abs=0.0)


def test_a_file_and_a_scene_have_units_both_or_neither(file: Path) -> None:
    (line,) = lines(in_si(file="p.csv"), file.parent)
    assert line.startswith('bodies.profile.file = "p.csv": is in LU, while bodies.spacing = "0.5 µm" has a unit')
    assert 'write scale = "1 µm"' in line
    file.write_text("r [µm], z [µm]\n" + PLAIN, encoding="utf-8")
    (line,) = lines(tables(file="p.csv"), file.parent)
    assert 'while bodies.profile.file = "p.csv" has a unit' in line
    (line,) = lines(in_si(file="p.csv", scale="1 nm"), file.parent)
    assert line.startswith('bodies.profile.scale = "1 nm": ')


def test_both_sides_are_averaged(file: Path) -> None:
    sides = "-2,4.1\n-1.5,2.3\n-1,1\n-0.5,0.3\n1e-9,0\n0.5,0.2\n1,1\n1.5,2.2\n2,3.9\n"
    file.write_text("x,z\n" + sides)
    r, z = points(read_scene(tables(file="p.csv"), folder=file.parent))
    assert r == tuple(RADII)
    assert z == pytest.approx(HEIGHTS, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    "text", ["x,r,z\n9,0,0\n9,1,0.5\n9,2,2\n9,3,4.5\n", "radius\theight\n0\t0\n1\t0.5\n2\t2\n3\t4.5\n"]
)
def test_columns_are_found_by_their_names(text: str, file: Path) -> None:
    file.write_text(text, encoding="utf-8")
    found = points(read_scene(tables(file="p.csv"), folder=file.parent))
    assert found == ((0.0, 1.0, 2.0, 3.0), (0.0, 0.5, 2.0, 4.5))
