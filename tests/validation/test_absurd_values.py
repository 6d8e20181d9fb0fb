"""Claim: what no model can follow is refused in a sentence at once, and what is only unusual has its result.

References: JKR, F_A = 1.5πWR; a dashpot body that stops where its springs carry M v/T.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import contact1d
from contact1d.workflow.fit.data import files_of
from contact1d.workflow.fit.plan import read_fit


def scene(experiment: dict[str, Any], modulus: str = "1 MPa", radius: str = "2 mm", **more: Any) -> dict[str, Any]:
    profile = {"kind": "parabola", "radius": radius}
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile}
    return {
        "title": "absurd",
        "bodies": bodies,
        "material": {"contact_modulus": modulus},
        "experiment": experiment,
    } | more


def impact(velocity: str = "0.2 m/s", radius: str = "2 mm", **law: Any) -> dict[str, Any]:
    more = {"viscoelasticity": law} if law else {}
    plate = {"mass": "0.5 g", "free": ["z"]}
    return scene({"kind": "impact", "velocity": velocity}, radius=radius, plate=plate, **more)


PULL, ADHESION = {"kind": "pull_off", "preload": "1 mN"}, {"work_of_adhesion": "30 mJ/m²"}
SLOW = {"velocity": "1e25 m/s", "exponent": 0.4}


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (impact(retardation_time="1e4 s"), "the body sticks: it creeps out"),
        (impact(retardation_time="1e28 s"), "the body sticks: it creeps out"),
        (impact(terms=[{"share": 0.6, "time": "1 ns"}, {"share": 0.4, "time": "1 µs"}]), "the body sticks: it flows"),
        (
            scene(PULL, adhesion=ADHESION | {"range": "1e-25 m"}),
            "too short to be resolved beside this contact, at least",
        ),
        (scene(PULL | {"velocity": "1 nm/s"}, adhesion=ADHESION | {"rate": SLOW}), "the contact is JKR's within"),
    ],
)
def test_what_is_out_of_all_proportion_is_one_sentence(tables: dict[str, Any], words: str, tmp_path: Path) -> None:
    with pytest.raises(contact1d.SettingsError, match=words):
        contact1d.run(tables, tmp_path / "run")


def test_a_range_that_is_just_long_enough_is_jkrs(tmp_path: Path) -> None:
    """The limit that the message names, and the force of adhesion there."""
    with pytest.raises(contact1d.SettingsError) as caught:
        contact1d.run(scene(PULL, adhesion=ADHESION | {"range": "1e-15 m"}), tmp_path / "run")
    least = float(str(caught.value).split("at least ")[1].split(" pm")[0])
    done = contact1d.run(scene(PULL, adhesion=ADHESION | {"range": f"{1.01 * least} pm"}))
    assert done.results.adhesion_force.value == pytest.approx(1.5 * math.pi * 0.03 * 2e-3, rel=1e-6)


def test_a_long_time_of_a_term_is_elastic_and_a_slow_impact_is_hertz_too(tmp_path: Path) -> None:
    """Hertz's largest depth goes with v^(4/5)."""
    elastic = contact1d.run(impact()).results
    relaxing = contact1d.run(impact(terms=[{"share": 1.0, "time": "1e25 s"}])).results
    assert relaxing.peak_force.value == pytest.approx(elastic.peak_force.value, rel=1e-3)
    assert relaxing.restitution.value == pytest.approx(1.0, rel=1e-5)
    slow = contact1d.run(impact("2e-13 m/s")).results
    assert slow.peak_displacement.value == pytest.approx(1e-12**0.8 * elastic.peak_displacement.value, rel=1e-3)


def test_a_paraboloid_is_not_cut_at_its_radius() -> None:
    """F_A = 3/2 and a₀³ = 9πWR²/2E* = 6 with W = 1/π, E* = 3/4, R = 1."""
    pull, work = {"kind": "pull_off", "preload": "0.5 N"}, {"work_of_adhesion": f"{1.0 / math.pi!r} J/m²"}
    done = contact1d.run(scene(pull, "0.75 Pa", "1 m", adhesion=work))
    force, radius = done.results.adhesion_force, done.results.zero_load_radius
    assert abs(force.value - 1.5) <= force.uncertainty <= 1.5e-3
    assert abs(radius.value - 6.0 ** (1 / 3)) <= radius.uncertainty
    assert {"slope", "body_size"} <= done.warnings.keys()


def test_data_of_a_fit_may_be_an_absolute_pattern(tmp_path: Path) -> None:
    names = [tmp_path / "deep" / f"{name}.csv" for name in "ab"]
    names[0].parent.mkdir()
    for name in names:
        name.touch()
    base = scene({"kind": "load", "force": "1 N"})
    for pattern in (f"{tmp_path}/deep/*.csv", f"{tmp_path}/**/?.csv"):
        plan = read_fit({"data": pattern, "parameters": ["material.contact_modulus"], "base": base})
        assert files_of(plan) == names
