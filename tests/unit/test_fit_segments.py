"""Approach and retraction are fitted together and alone: what differs is named, with both values."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import fit
from tests.command import contact1d
from tests.scenes import read_json
from validation.references.relaxing import Indentation, Legs, Material, sphere

MODULUS, CLOSING, RADIUS = 2e6, 0.04, 1e-5
NOISE = 2e-9
"""Of the force [N]; the pull-off force is some thousand times as large."""
E, W = PARAMETERS = ["material.contact_modulus", "adhesion.work_of_adhesion"]
SHARE, TIME = (f"viscoelasticity.terms[0].{name}" for name in ("share", "time"))
BALL = {"profile": {"kind": "parabola", "radius": f"{RADIUS} m"}}
BODIES = {"bodies": BALL, "material": {"contact_modulus": "1 MPa"}}
ADHESIVE = BODIES | {"adhesion": {"work_of_adhesion": "30 mJ/m²"}}
Array = np.ndarray[Any, np.dtype[np.float64]]


def jkr(work: float) -> tuple[Array, Array]:
    """d [m] and F [N] of the stable states, from the least displacement on."""
    a = np.linspace(1e-9, 6e-6, 20_001)
    d = a**2 / RADIUS - np.sqrt(2.0 * math.pi * a * work / MODULUS)
    F = 4.0 * MODULUS * a**3 / (3.0 * RADIUS) - np.sqrt(8.0 * math.pi * MODULUS * work * a**3)
    least = int(np.argmin(d))
    return d[least:], F[least:]


def opened(path: Path, work: float) -> Path:
    """A curve, without an instrument, of a contact that closes with W = 40 mJ/m² and opens with `work`."""
    draw, x = np.random.default_rng(2), np.arange(-1e-6, 1.2e-6, 8e-9)
    closing, opening = jkr(CLOSING), jkr(work)
    parts = {
        "approach": (x, np.where(x > 0.0, np.interp(x, *closing), 0.0)),
        "retract": (back := x[::-1][x[::-1] > opening[0][0]], np.interp(back, *opening)),
    }
    rows = [(d, F, name) for name, columns in parts.items() for d, F in zip(*columns, strict=True)]
    lines = [f"{1e9 * d:.3f},{1e9 * (F + draw.normal(0.0, NOISE)):.3f},{name}" for d, F, name in rows]
    path.write_text("\n".join(["d [nm],F [nN],segment", *lines, ""]), encoding="utf-8")
    return path


def record_of(folder: Path) -> dict[str, Any]:
    found = read_json(folder / "fit.json")
    return found


def test_a_contact_that_closes_and_opens_with_different_work_has_both(tmp_path: Path) -> None:
    """E, in which the segments agree, is one number; the page shows all of it."""
    data, work = opened(tmp_path / "curve.csv", 0.043), {"approach": CLOSING, "retract": 0.043}
    result = fit(data, ADHESIVE, tmp_path / "fit", parameters=PARAMETERS)
    assert "work_of_adhesion is " in result.warnings["hysteresis"]
    record = record_of(tmp_path / "fit")
    assert record["parameters"][W] is None
    low, high = record["parameters"][E]["interval"]
    assert low < MODULUS < high < 1.01 * low
    for name, exact in work.items():
        low, high = record["segments"][name]["parameters"][W]["interval"]
        assert low < exact < high < 1.02 * low
    page = tmp_path / "page.html"
    done = contact1d("report", tmp_path / "fit", "--out", page)
    assert done.exit_code == 0, done.output
    text = page.read_text(encoding="utf-8")
    assert all(words in text for words in ("hysteresis.", "measured pull-off force", '"col">retraction</th>'))


def test_one_work_of_adhesion_has_one_value_and_the_measured_pull_off_force(tmp_path: Path) -> None:
    data = opened(tmp_path / "curve.csv", CLOSING)
    result = fit(data, ADHESIVE, tmp_path / "fit", parameters=PARAMETERS)
    record = record_of(tmp_path / "fit")
    assert "hysteresis" not in result.warnings
    assert set(record["segments"]) == {"approach", "retract"}
    low, high = record["parameters"][W]["interval"]
    assert low < CLOSING < high < 1.01 * low
    measured = record["pull_off_force"]
    assert abs(measured["value"] - 1.5 * math.pi * CLOSING * RADIUS) < measured["uncertainty"] < 3.0 * NOISE


@pytest.mark.parametrize("segment", ["approach", "retract"])
def test_one_segment_alone_is_a_curve(segment: str, tmp_path: Path) -> None:
    whole = opened(tmp_path / "curve.csv", CLOSING)
    lines = whole.read_text(encoding="utf-8").splitlines()
    data = tmp_path / "part.csv"
    data.write_text("\n".join(line for line in lines if segment in line or "nm" in line) + "\n", encoding="utf-8")
    alone = fit(data, ADHESIVE, parameters=PARAMETERS)
    chosen = fit(whole, ADHESIVE, parameters=PARAMETERS, segment=segment)
    for result in (alone, chosen):
        assert set(result.segments.fits) == {segment}
        (low, high), (least, most) = (result.fit.intervals[name] for name in PARAMETERS)
        assert low < MODULUS < high
        assert least < CLOSING < most


def pressed(path: Path, slope: float, start: float, hold: int = 0) -> Path:
    """Hertz's contact pressed and released, on a baseline of this slope [N/m], and with a hold of some points."""
    draw, up = np.random.default_rng(7), np.linspace(start, 1e-6, 200)
    d = np.concatenate([up, np.full(hold, up[-1]), up[::-1]])
    words = np.repeat(["approach", "pause", "retract"], [up.size, hold, up.size])
    F = 4.0 / 3.0 * MODULUS * math.sqrt(RADIUS) * np.maximum(d, 0.0) ** 1.5 + slope * d + draw.normal(0.0, 2e-8, d.size)
    lines = [f"{1e9 * x:.3f},{1e9 * y:.3f},{word}" for x, y, word in zip(d, F, words, strict=True)]
    path.write_text("\n".join(["d [nm],F [nN],segment", *lines, ""]), encoding="utf-8")
    return path


def test_a_slope_of_the_baseline_is_found_and_is_no_contact(tmp_path: Path) -> None:
    data = pressed(tmp_path / "curve.csv", 0.3, -1e-6)
    found = fit(data, BODIES, parameters=[E])
    assert found.fit.values["force_slope"] == pytest.approx(0.3, rel=0.05)
    low, high = found.fit.intervals[E]
    assert low < MODULUS < high < 1.02 * low
    flat = fit(data, BODIES, parameters=[E], instrument={"baseline": "flat"})
    assert flat.fit.intervals[E][0] > MODULUS
    assert "misfit" in flat.warnings or "hysteresis" in flat.warnings


def test_a_curve_without_a_baseline_says_what_it_costs(tmp_path: Path) -> None:
    data = pressed(tmp_path / "curve.csv", 0.0, 5e-8, hold=30)
    found = fit(data, BODIES, parameters=[E])
    assert "times as wide" in found.warnings["baseline"]
    low, high = found.fit.intervals[E]
    assert low < MODULUS < high


def test_a_body_that_relaxes_has_an_apparent_modulus_until_its_terms_are_fitted(tmp_path: Path) -> None:
    """Ting's contact: the approach alone has a lower modulus; with the term free it is the instantaneous one."""
    share, time, t = 0.5, 0.4, np.linspace(0.0, 2.0, 240)
    legs = Legs(((0.0, -5e-7), (1.0, 1e-6), (2.0, -5e-7)))
    contact = Indentation(sphere(RADIUS), Material(((share, time),), MODULUS), legs)
    F = np.array([contact.force(float(x)) for x in t])
    F = F + np.random.default_rng(3).normal(0.0, 2e-3 * F.max(), t.size)
    d = np.array([legs(float(x)) for x in t])
    lines = [f"{x:.6f},{1e9 * y:.4f},{1e9 * z:.4f}" for x, y, z in zip(t, d, F, strict=True)]
    data = tmp_path / "curve.csv"
    data.write_text("\n".join(["t [s],d [nm],F [nN]", *lines, ""]), encoding="utf-8")
    elastic = fit(data, BODIES, parameters=[E])
    assert "apparent modulus" in elastic.warnings["hysteresis"]
    assert elastic.segments.fits["approach"].intervals[E][1] < 0.9 * MODULUS
    terms = BODIES | {"viscoelasticity": {"terms": [{"share": 0.3, "time": "1 s"}]}}
    found = fit(data, terms, parameters=[E, SHARE, TIME])
    for key, exact in {E: MODULUS, SHARE: share, TIME: time}.items():
        low, high = found.fit.intervals[key]
        assert low < exact < high < 1.5 * low
    assert found.difference <= found.allowed
