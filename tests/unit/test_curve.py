"""Tables of a run: what is written comes back to the last bit, and nothing half-written stays."""

from __future__ import annotations

import csv
import math
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from contact1d.analysis.curve import Curve, profile_columns, read_columns, read_curve, read_profiles, write_columns
from contact1d.analysis.pressure import Profile

COLUMNS = "displacement,force,contact_radius,smallest_distance,branch,contact_radius_uncertainty"


def awkward(rng: np.random.Generator, size: int) -> np.ndarray:
    """Doubles of every size that need all 17 digits."""
    values: np.ndarray = rng.normal(size=size) * 10.0 ** rng.uniform(-300.0, 300.0, size)
    return values


@pytest.fixture
def curve() -> Curve:
    rng = np.random.default_rng(4)
    radius = awkward(rng, 6)
    radius[2] = math.nan
    branch = np.array(["loading"] * 3 + ["unloading"] * 3)
    displacement, force, distance, spread = (awkward(rng, 6) for _ in range(4))
    return Curve(displacement, force, radius, distance, branch, spread)


def test_a_curve_comes_back_to_the_last_bit(curve: Curve, tmp_path: Path) -> None:
    write_columns(tmp_path / "curve.csv", vars(curve))
    back = read_curve(tmp_path / "curve.csv")
    for field in fields(curve):
        np.testing.assert_array_equal(getattr(back, field.name), getattr(curve, field.name))


def test_the_columns_are_those_of_the_contract(curve: Curve, tmp_path: Path) -> None:
    write_columns(tmp_path / "curve.csv", vars(curve))
    header, *rows = (tmp_path / "curve.csv").read_text(encoding="utf-8").splitlines()
    assert header == COLUMNS
    assert len(rows) == 6
    assert rows[2].split(",")[2] == ""


def test_profiles_come_back_by_the_names_of_their_states(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    profiles = {
        name: Profile(np.sort(awkward(rng, size)), *(awkward(rng, size) for _ in range(4)))
        for name, size in (("zero_load", 7), ("critical", 5))
    }
    write_columns(tmp_path / "profile.csv", profile_columns(profiles))
    with (tmp_path / "profile.csv").open(encoding="utf-8") as file:
        assert next(csv.reader(file)) == ["x", "z_lower", "z_upper", "pressure", "shear", "state"]
    back = read_profiles(tmp_path / "profile.csv")
    assert list(back) == ["zero_load", "critical"]
    for name, profile in profiles.items():
        for field in fields(profile):
            np.testing.assert_array_equal(getattr(back[name], field.name), getattr(profile, field.name))


def test_columns_of_numbers_come_back_by_name_beside_words(tmp_path: Path) -> None:
    rng, names = np.random.default_rng(7), ("time", "load", "force")
    columns = {name: awkward(rng, 5) for name in names}
    columns["force"][3] = math.nan
    write_columns(tmp_path / "table.csv", {"beside": ["a", "b, c", '"d"', "", "e"], **columns})
    back = read_columns(tmp_path / "table.csv", names)
    assert tuple(back) == names
    for name in names:
        np.testing.assert_array_equal(back[name], columns[name])
    with pytest.raises(ValueError, match="no column seed"):
        read_columns(tmp_path / "table.csv", ("time", "seed"))
    (tmp_path / "table.csv").write_text("")
    with pytest.raises(ValueError, match="no rows"):
        read_columns(tmp_path / "table.csv", names)


def test_an_interrupted_write_leaves_the_old_table(curve: Curve, tmp_path: Path) -> None:
    path = tmp_path / "curve.csv"
    write_columns(path, vars(curve))
    before = path.read_bytes()
    for force in ([1.0], []):
        with pytest.raises(ValueError, match="zip"):
            write_columns(path, {"displacement": [1.0, 2.0], "force": force})
    assert path.read_bytes() == before


def test_columns_of_a_curve_are_equally_long() -> None:
    with pytest.raises(ValueError, match="equally long"):
        Curve(np.zeros(2), *np.zeros((3, 1)), np.array(["loading"]), np.zeros(1))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("displacement,force\n0,1\n", "no column contact_radius, smallest_distance, branch"),
        (f"{COLUMNS}\n", "no rows"),
        (f"{COLUMNS}\n0,many,1,1,loading,0\n", "many"),
    ],
)
def test_what_is_no_curve_is_refused(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "curve.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_curve(tmp_path / "curve.csv")
