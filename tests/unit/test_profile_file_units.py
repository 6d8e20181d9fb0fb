"""A profile's file in other units: its scale, units in its names, and scans to both sides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.scene.profile_file import read_profile
from tests.unit.test_profile_file import BODIES, HEIGHTS, PLAIN, RADII, ROWS, lines, points, tables


def test_scale_multiplies_radii_and_heights(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    scene = scene_from_dict(tables(file="p.csv", scale=4.0), folder=tmp_path)
    assert points(scene) == (tuple(4.0 * r for r in RADII), tuple(4.0 * z for z in HEIGHTS))
    assert scene == scene_from_dict(tables(r=[4.0 * r for r in RADII], z=[4.0 * z for z in HEIGHTS]))
    assert points(scene_from_dict(tables(file="p.csv", scale=2), folder=tmp_path))[0] == tuple(2.0 * r for r in RADII)


@pytest.mark.parametrize("scale", [0.0, -1.0, float("inf"), float("nan"), True, [1.0]])
def test_scale_is_a_positive_number(scale: object, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    printed = lines(tables(file="p.csv", scale=scale), tmp_path)
    assert len(printed) == 1
    assert printed[0].startswith("bodies.profile.scale = ")
    assert "must be a number greater than 0" in printed[0]


def test_scale_of_hundreds_of_digits_is_a_problem_of_the_scene(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    assert len(lines(tables(file="p.csv", scale=10**400), tmp_path)) == 1


UNITS = {
    "in brackets": "r [µm], z [nm]\n",
    "in round brackets": "z (nm); r (µm)\n",
    "behind a stroke": "r/µm\tz / nm\n",
    "behind an underscore": "r_um,z_nm\n",
    "in words": "Radius in µm,Height in nm\n",
    "below": "r,z\nµm,nm\n",
}
"""Names that give the same units."""


@pytest.mark.parametrize("name", UNITS)
def test_units_in_the_names_are_those_of_the_numbers(name: str, tmp_path: Path) -> None:
    order = -1 if UNITS[name].startswith("z") else 1
    part = ";" if ";" in UNITS[name] else "\t" if "\t" in UNITS[name] else ","
    rows = [part.join(row.split(",")[::order]) for row in ROWS]
    (tmp_path / "p.csv").write_text(UNITS[name] + "\n".join(rows), encoding="utf-8")
    data = tables(file="p.csv")
    units = {"length_unit": 1e-6, "force_unit": 1e-6}
    scene = scene_from_dict(data | {"material": units}, folder=tmp_path)
    assert points(scene)[0] == tuple(RADII)
    # 1e-3 is rounded once, and each product once more
    assert points(scene)[1] == pytest.approx([1e-3 * z for z in HEIGHTS], rel=1e-15)


def in_si(**profile: Any) -> dict[str, Any]:
    bodies = BODIES | {"profile": {"kind": "table"} | profile, "spacing": "0.5 µm", "bulk_stiffness": "1 N/m"}
    return {"title": "si", "bodies": bodies, "experiment": {"kind": "path", "displacements": ["0.1 µm"]}}


def test_scale_may_have_a_unit(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    radii = points(scene_from_dict(in_si(file="p.csv", scale="2 µm"), folder=tmp_path))[0]
    assert radii == pytest.approx([2e-6 * r for r in RADII], rel=1e-15)


def test_a_file_without_units_in_a_scene_with_units_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(PLAIN)
    assert lines(in_si(file="p.csv"), tmp_path) == [
        'bodies.profile.file = "p.csv": is in LU, while bodies.spacing = "0.5 µm" has a unit, and nothing says what LU '
        'and FU stand for; name its columns with their units, r [µm], z [µm], or write scale = "1 µm"; '
        "or give material.length_unit and material.force_unit"
    ]


def test_a_file_with_units_in_a_scene_without_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("r [µm], z [µm]\n" + PLAIN, encoding="utf-8")
    (line,) = lines(tables(file="p.csv"), tmp_path)
    assert 'while bodies.profile.file = "p.csv" has a unit, and nothing says what LU and FU stand for' in line


def test_units_and_a_scale_exclude_each_other(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("r [µm], z [µm]\n" + PLAIN, encoding="utf-8")
    assert lines(in_si(file="p.csv", scale="1 nm"), tmp_path) == [
        'bodies.profile.scale = "1 nm": not together with units in the file\'s names; remove it'
    ]


def test_both_sides_are_averaged(tmp_path: Path) -> None:
    sides = "-2,4.1\n-1.5,2.3\n-1,1\n-0.5,0.3\n1e-9,0\n0.5,0.2\n1,1\n1.5,2.2\n2,3.9\n"
    (tmp_path / "p.csv").write_text("x,z\n" + sides)
    read = read_profile(tmp_path / "p.csv")
    assert read.r == RADII
    assert read.z == pytest.approx([0.0, 0.25, 1.0, 2.25, 4.0], rel=1e-15)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("-2,4\n-1,1\n0,0\n1,1\n3,9\n", "its places left and right are not the same; shift it"),
        ("-2,8\n-1,2\n0,0\n1,1\n2,4\n", "these differ by 50% of its height"),
        ("4,-2\n1,-1\n0,0\n1,1\n4,2\n", "as if the columns were swapped; name them r and z"),
        ("0,0,1\n1,1,1\n2,4,1\n3,9,1\n", "has 3 columns without names; name the radius r and the height z"),
        ("0,0\n1,-1\n2,-4\n3,-9\n", "fall from the axis on: they count away from the plane; change their sign"),
        ("-1.5,2.25\n-0.5,0.25\n0.5,0.25\n1.5,2.25\n", "must have at least 4 points from the axis out, not 2"),
        ("-2.5,6\n-1.5,2\n-0.5,0\n0.5,0\n1.5,2\n2.5,6\n3.5,9\n-3,9\n", "must begin at the radius 0, not -2.5"),
    ],
)
def test_an_odd_profile_is_one_sentence(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text(text)
    (line,) = lines(tables(file="p.csv"), tmp_path)
    assert words in line


def test_a_long_scan_to_both_sides_in_lists_is_one_sentence() -> None:
    x = [0.1 * i for i in range(-60, 61)]
    assert len(lines(tables(r=x, z=[place**2 for place in x]), Path())) == 1
