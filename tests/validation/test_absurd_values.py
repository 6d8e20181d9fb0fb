"""Claim: what no model can follow in time is refused in a sentence at once, and what is only unusual has its result.

References: JKR, F_A = 1.5πWR; a dashpot body that stops where its springs carry M v/T.
"""

import math
from typing import Any

import pytest

import contact1d
from tests.scenes import in_si

SOLID = {"terms": [{"share": 0.5, "time": "1 s"}]}


def scene(experiment: dict[str, Any], modulus: str = "1 MPa", radius: str = "2 mm", **more: Any) -> dict[str, Any]:
    profile = {"kind": "parabola", "radius": radius}
    return in_si(profile, modulus, title="absurd", experiment=experiment, **more)


def impact(velocity: str = "0.2 m/s", **law: Any) -> dict[str, Any]:
    more = {"viscoelasticity": law} if law else {}
    plate = {"mass": "0.5 g", "free": ["z"]}
    return scene({"kind": "impact", "velocity": velocity}, plate=plate, **more)


def history(key: str, *points: tuple[str, str], law: dict[str, Any] = SOLID, **more: Any) -> dict[str, Any]:
    return scene({"kind": "history", key: [list(point) for point in points], **more}, viscoelasticity=law)


START = ("0 s", "0 µm")
PULL, ADHESION = {"kind": "pull_off", "preload": "1 mN"}, {"work_of_adhesion": "30 mJ/m²"}
SLOW = {"velocity": "1e25 m/s", "exponent": 0.4}


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (impact(retardation_time="1e28 s"), "the body sticks: it creeps out"),
        (impact(terms=[{"share": 0.6, "time": "1 ns"}, {"share": 0.4, "time": "1 µs"}]), "the body sticks: it flows"),
        (scene(PULL | {"velocity": "1 nm/s"}, adhesion=ADHESION | {"rate": SLOW}), "the contact is JKR's within"),
    ],
)
def test_what_is_out_of_all_proportion_is_one_sentence(tables: dict[str, Any], words: str) -> None:
    with pytest.raises(contact1d.SettingsError, match=words):
        contact1d.run(tables)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (history("force", law={"terms": [{"share": 0.7, "time": "1 s"}, {"share": 0.5, "time": "1 s"}]}), "not 1.2"),
        (history("displacement", START, ("2 s", "1 µm"), ("1 s", "0 µm")), "times must rise; 1 s follows 2 s"),
        (history("force", ("0 s", "0 N"), ("9 s", "1 mN"), steps=3), "longer than the shortest time of the body, 1"),
        (
            history("displacement", ("0 s", "1 µm"), ("1 s", "2 µm"), law={"retardation_time": "1 s"}),
            "dashpots resist a jump",
        ),
        (scene(PULL, adhesion=ADHESION, viscoelasticity=SOLID), r"not with \[viscoelasticity\]"),
        (impact() | {"plate": {}}, "must be given in an impact"),
    ],
)
def test_what_goes_together_in_time_is_one_sentence(tables: dict[str, Any], words: str) -> None:
    with pytest.raises(contact1d.SceneError, match=words):
        contact1d.read_scene(tables)


def test_a_range_that_is_just_long_enough_is_jkrs() -> None:
    """The limit that the message names, and the force of adhesion there."""
    with pytest.raises(contact1d.SettingsError, match="too short to be resolved") as caught:
        contact1d.run(scene(PULL, adhesion=ADHESION | {"range": "1e-15 m"}))
    least = float(str(caught.value).split("at least ")[1].split(" pm")[0])
    done = contact1d.run(scene(PULL, adhesion=ADHESION | {"range": f"{1.01 * least} pm"}))
    assert done.results.adhesion_force.value == pytest.approx(1.5 * math.pi * 0.03 * 2e-3, rel=1e-6)


def test_a_slow_impact_of_a_term_with_a_long_time_is_hertz_too() -> None:
    """d = (15 M v²/(16 E* √R))^(2/5) and F = (4/3) E* √R d^(3/2)."""
    found = contact1d.run(impact("2e-13 m/s", terms=[{"share": 1.0, "time": "1e25 s"}])).results
    depth = (15.0 * 5e-4 * 2e-13**2 / (16.0 * 1e6 * math.sqrt(2e-3))) ** 0.4
    assert found.peak_displacement.value == pytest.approx(depth, rel=1e-3, abs=0.0)
    assert found.peak_force.value == pytest.approx(4e6 / 3.0 * math.sqrt(2e-3) * depth**1.5, rel=1e-3, abs=0.0)
    assert found.restitution.value == pytest.approx(1.0, rel=1e-5)


def test_a_paraboloid_is_not_cut_at_its_radius() -> None:
    """F_A = 3/2 and a₀³ = 9πWR²/2E* = 6 with W = 1/π, E* = 3/4, R = 1."""
    pull, work = {"kind": "pull_off", "preload": "0.5 N"}, {"work_of_adhesion": f"{1.0 / math.pi!r} J/m²"}
    done = contact1d.run(scene(pull, "0.75 Pa", "1 m", adhesion=work))
    force, radius = done.results.adhesion_force, done.results.zero_load_radius
    assert abs(force.value - 1.5) <= force.uncertainty <= 1.5e-3
    assert abs(radius.value - 6.0 ** (1 / 3)) <= radius.uncertainty
    assert {"slope", "body_size"} <= done.warnings.keys()
