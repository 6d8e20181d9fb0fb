"""What of validation/speed/peers runs without the other solvers: the contacts, their errors, and the record's table."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from validation.speed.pages import between
from validation.speed.peers.contacts import (
    A_0,
    DEPTH,
    F_A,
    Curve,
    closed_form,
    displacements,
    errors,
    law_range,
    reduced_distance,
)  # fmt: skip
from validation.speed.peers.table import quickest, ratios, section, write_section

INTERPOLATION = 1e-8  # of F_A, between 50000 radii
ROUND_OFF = 1e-15
SHIFT, SPLINE = 0.004, 1e-5  # of a_0²/R; of the shift, by the spline beyond its last point
PEAK = 1e-3  # of F_A, which lies between two of 50 points


def exact(contact: str) -> Curve:
    d = displacements(contact)
    force, radius = closed_form(contact, d)
    return Curve(d, force, radius, 1.0, 0.0, (force, radius))


def test_the_hertz_curve_ends_at_the_zero_load_radius_of_jkr() -> None:
    force, radius = closed_form("hertz", displacements("hertz"))
    assert radius[-1] == pytest.approx(A_0, rel=1e-14)
    assert force[-1] == pytest.approx(4.0 / 3.0 * 0.2 * np.sqrt(6100.0) * DEPTH**1.5, rel=1e-14)


def test_jkr_by_displacement_has_its_known_places() -> None:
    force, radius = closed_form("jkr", np.array([DEPTH / 3.0, (0.25 ** (2 / 3) - 2.0 / 3.0 * 0.25 ** (1 / 6)) * DEPTH]))
    assert force / F_A == pytest.approx([0.0, -1.0], abs=INTERPOLATION)
    assert radius / A_0 == pytest.approx([1.0, 0.25 ** (1 / 3)], abs=INTERPOLATION)


def test_jkr_beyond_its_fold_is_refused() -> None:
    with pytest.raises(ValueError, match="stable branch"):
        closed_form("jkr", np.array([-0.28 * DEPTH]))


def test_an_exact_curve_has_no_error() -> None:
    for contact in ("hertz", "jkr"):
        found = errors(contact, exact(contact))
        missed = found.pop("theory_pull_off", 0.0)
        assert all(value < ROUND_OFF for name, value in found.items() if not name.endswith("place"))
        assert -PEAK < missed <= 0.0
    assert reduced_distance(exact("jkr")) < 2.0 * PEAK


@pytest.mark.parametrize("contact", ["hertz", "jkr"])
def test_a_curve_that_is_shifted_has_an_error_in_displacement(contact: str) -> None:
    curve = exact(contact)
    shift = SHIFT * DEPTH
    force, radius = closed_form(contact, curve.displacement - shift)
    found = errors(contact, replace(curve, force=force, radius=radius))
    assert found["limit_displacement"] == pytest.approx(SHIFT, rel=SPLINE)
    assert found["theory_displacement"] == found["limit_displacement"]


def test_the_range_is_that_of_the_tabor_number() -> None:
    assert law_range(5.0) == pytest.approx(0.1696, abs=1e-4)


def record(seconds: float, error: float) -> dict[str, Any]:
    found = {f"{against}_{name}": error for against in ("limit", "theory") for name in ("force", "pull_off", "radius")}
    return {
        "solver": "contact1d", "contact": "jkr", "setting": "a_0/8", "seconds": seconds, "import_s": 0.1,
        "start_up_s": 0.2, "parts": {}, "errors": found, "tabor": None,
    }  # fmt: skip


def test_the_quickest_setting_is_one_that_is_good_enough() -> None:
    rough, fine, finest = record(0.1, 0.02), record(0.2, 0.009), record(0.4, 0.001)
    assert quickest([rough, finest, fine]) is fine
    assert quickest([rough]) is None


def test_rows_in_lammps_stand_beside_a_peers_solve() -> None:
    """Both without what is done once for any number of curves: reading bodies here, making a model there."""
    ours, theirs = record(0.02, 0.009), record(9e-3, 0.001)
    for one in (ours, theirs):
        one["contact"] = "hertz"
        one["errors"] |= {"limit_relative": 0.0, "limit_worst_relative": 0.0}
    ours["parts"], theirs["solver"] = {"lammps": 2e-3, "rows": 6e-4}, "tamaas"
    said = ratios({"records": [ours, theirs]})
    assert "- Hertz, 1 % of the largest force (rms): **0.45** (tamaas a_0/8 9 ms, contact1d a_0/8 20 ms)" in said
    times = "(tamaas a_0/8 9 ms, contact1d a_0/8 0.6 ms)"
    assert f"- Hertz, rows in LAMMPS alone, 1 % of the largest force (rms): **15** {times}" in said


def test_the_table_goes_between_the_markers(tmp_path: Path) -> None:
    machine = {"processor": "P", "cores": 2, "python": "3.11", "versions": {"numpy": "2"}}
    document = {"machine": machine, "records": [record(0.2, 0.009)], "closed_form_s": {"jkr": 1e-3}}
    page = tmp_path / "README.md"
    page.write_text("before\n<!-- peers: begin -->\nold\n<!-- peers: end -->\nafter\n")
    write_section(document, page)
    assert between(page, "peers")[1] == section(document) + "\n"
    assert "| contact1d | a_0/8 | 200 ms | 100 ms + 200 ms | 0.9 % | 0.9 % |" in page.read_text()
