"""Tables of a run: what is written comes back to the last bit, and nothing half-written stays."""

import csv
import math
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from contact1d.analysis.curve import Columns, by_state, profile_columns, read_columns, write_columns
from contact1d.analysis.pressure import Profile

COLUMNS = "displacement,force,contact_radius,smallest_distance,branch,contact_radius_uncertainty"


def awkward(rng: np.random.Generator, size: int) -> np.ndarray:
    """Doubles of every size that need all 17 digits."""
    values: np.ndarray = rng.normal(size=size) * 10.0 ** rng.uniform(-300.0, 300.0, size)
    return values


@pytest.fixture
def curve() -> Columns:
    rng = np.random.default_rng(4)
    radius = awkward(rng, 6)
    radius[2] = math.nan
    branch = np.array(["loading"] * 3 + ["unloading"] * 3)
    displacement, force, distance, spread = (awkward(rng, 6) for _ in range(4))
    return Columns(dict(zip(COLUMNS.split(","), (displacement, force, radius, distance, branch, spread), strict=True)))


def test_a_curve_comes_back_to_the_last_bit(curve: Columns, tmp_path: Path) -> None:
    """A unit stands in the header, and what is no number is an empty cell."""
    for units in ({}, {"force": "N", "displacement": "m"}):
        write_columns(tmp_path / "curve.csv", curve, units)
        back = read_columns(tmp_path / "curve.csv")
        assert (list(back), back.units) == (list(curve), units)
        for name in curve:
            np.testing.assert_array_equal(getattr(back, name), curve[name])
    header, *rows = (tmp_path / "curve.csv").read_text(encoding="utf-8").splitlines()
    assert header == COLUMNS.replace("displacement,force", "displacement [m],force [N]")
    assert [row.split(",")[2] == "" for row in rows] == [False, False, True, False, False, False]


def test_profiles_come_back_by_the_names_of_their_states(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    profiles = {
        name: Profile(np.sort(awkward(rng, size)), *(awkward(rng, size) for _ in range(4)))
        for name, size in (("zero_load", 7), ("critical", 5))
    }
    write_columns(tmp_path / "profile.csv", profile_columns(profiles))
    with (tmp_path / "profile.csv").open(encoding="utf-8") as file:
        assert next(csv.reader(file)) == ["x", "z_lower", "z_upper", "pressure", "shear", "state"]
    back = by_state(read_columns(tmp_path / "profile.csv"))
    assert list(back) == ["zero_load", "critical"]
    for name, profile in profiles.items():
        for field in fields(profile):
            np.testing.assert_array_equal(getattr(back[name], field.name), getattr(profile, field.name))


def test_a_text_is_no_formula_for_a_spreadsheet_and_numbers_stay_numbers(tmp_path: Path) -> None:
    texts = ["=1+1", "+A1", "-a", "@now", "'=1", "''-a", "\t=1", "'", "it's", "-5", "+1.5e-3"]
    write_columns(tmp_path / "table.csv", {"force": np.linspace(-5.0, 5.0, len(texts)), "state": texts})
    with (tmp_path / "table.csv").open(newline="", encoding="utf-8") as file:
        cells = [row["state"] for row in csv.DictReader(file)]
    assert cells == [*(f"'{text}" for text in texts[:7]), *texts[7:]]
    back = read_columns(tmp_path / "table.csv")
    assert back.state.tolist() == texts
    assert (tmp_path / "table.csv").read_text().splitlines()[1].startswith("-5,")
    np.testing.assert_array_equal(back.force, np.linspace(-5.0, 5.0, len(texts)))


def test_an_interrupted_write_leaves_the_old_table(curve: Columns, tmp_path: Path) -> None:
    path = tmp_path / "curve.csv"
    write_columns(path, curve)
    before = path.read_bytes()
    for force in ([1.0], []):
        with pytest.raises(ValueError, match="zip"):
            write_columns(path, {"displacement": [1.0, 2.0], "force": force})
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no rows"),
        ("displacement,force\n0,1\n", "no column branch, contact_radius"),
        (f"{COLUMNS}\n", "no rows"),
        (f"{COLUMNS}\n0,many,1,1,loading,0\n", "many"),
    ],
)
def test_what_is_no_curve_is_refused(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "curve.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_columns(tmp_path / "curve.csv", ("displacement", "force", "contact_radius", "branch"))
