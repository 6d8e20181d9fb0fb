"""Claim: a half angle in place of a slope, and a second radius, are the contacts of Sneddon, Hertz and JKR.

References, written down here: Sneddon's cone F = (2/π) E* d² tan α, with α from the axis to the flank; Hertz's
F = (4/3) E* √R d^(3/2) and JKR's F_A = 1.5 π W R with 1/R = 1/R₁ + 1/R₂.
"""

import math
import tomllib
from typing import Any

import pytest

import contact1d
from contact1d import Run, read_scene
from tests.scenes import in_si, refused

E_STAR, R = 1e9, 10e-3
PATH = {"kind": "path", "displacements": {"from": "0 nm", "to": "1 µm", "steps": 10}}
PULL_OFF = {"kind": "pull_off", "preload": "1 mN"}
CUP = {"kind": "parabola", "radius": "10 mm", "counter_radius": "-12 mm"}


def tables(profile: dict[str, Any], experiment: dict[str, Any] = PATH, **more: Any) -> dict[str, Any]:
    material = {"contact_modulus": E_STAR}
    return in_si(profile, title="x", material=material, experiment=experiment, **more)


def run(*scene: Any, **more: Any) -> Run:
    return contact1d.run(read_scene(tables(*scene, **more)))


def si(done: Run, name: str) -> tuple[float, float]:
    found = done.results[name]
    return found.value, found.uncertainty


def message(profile: dict[str, Any], **bodies: Any) -> str:
    data = tables(profile)
    data["bodies"] |= bodies
    return str(refused(data))


def cone(angle: object) -> dict[str, Any]:
    return {"kind": "cone", "half_angle": angle}


@pytest.mark.parametrize(("text", "degrees"), [("88°", 88.0), ("1.5 rad", math.degrees(1.5))])
def test_a_cone_by_its_half_angle_is_sneddons(text: str, degrees: float) -> None:
    done = run(cone(text))
    force, uncertainty = si(done, "largest_force")
    sneddon = 2.0 / math.pi * E_STAR * 1e-12 * math.tan(math.radians(degrees))
    assert abs(force - sneddon) <= uncertainty + 1e-12 * sneddon  # round-off
    assert uncertainty <= 1e-3 * sneddon
    (form,) = done.document["theory"]
    assert abs(form["values"]["largest_force"]["deviation"]) <= 1e-3
    scene = read_scene(tables(cone(text)))
    assert read_scene(tomllib.loads(str(scene))) == scene != scene.with_({"bodies.profile.half_angle": "70 deg"})


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        (cone(80), 'half_angle = 80: must be text with a unit, greater than 0° and less than 90°, from the axis to the '
                   'flank: write "80°"'),
        (cone("0 rad"), 'half_angle = "0 rad": must be text with a unit, greater than 0°'),
        (cone("80"), 'half_angle = "80": must be an angle, such as 80°; 80 has no unit'),
        ({"kind": "cone", "slope": "10°"},
         '10° is an angle: its tangent is 0.176327; a cone may have half_angle = "80°" in place of this slope'),
        ({"kind": "cone"}, 'bodies.profile.slope: missing; give one of the two: slope = 0.1, or half_angle = "80°"'),
        (cone("80°") | {"slope": 0.1}, 'bodies.profile.half_angle = "80°": not together with slope; give one'),
    ],
)  # fmt: skip
def test_an_angle_that_is_none_is_one_sentence(profile: dict[str, Any], words: str) -> None:
    printed = message(profile)
    assert words in printed
    assert "\n" not in printed


@pytest.mark.parametrize(("counter", "effective"), [("30 mm", 7.5e-3), ("-12 mm", 60e-3)])
def test_two_radii_are_hertzs_and_jkrs_effective_one(counter: str, effective: float) -> None:
    profile = CUP | {"counter_radius": counter}
    hertz = 4.0 / 3.0 * E_STAR * math.sqrt(effective) * 1e-9
    pressed, torn = run(profile), run(profile, PULL_OFF, adhesion={"work_of_adhesion": "50 mJ/m²"})
    for done, name, exact in (
        (pressed, "largest_force", hertz),
        (pressed, "largest_radius", math.sqrt(effective * 1e-6)),
        (torn, "adhesion_force", 1.5 * math.pi * 0.05 * effective),
    ):
        value, uncertainty = si(done, name)
        assert abs(value - exact) <= uncertainty + 1e-12 * exact
        assert uncertainty <= 2e-3 * exact


def test_the_slope_is_that_of_the_body_with_the_smaller_radius() -> None:
    """The gap of a ball in a cup is nearly plane where the ball itself is not."""
    for counter, smaller in (("-10.5 mm", 10e-3), ("2 mm", 2e-3)):
        done = run(CUP | {"counter_radius": counter}, PATH)
        (check,) = (one for one in done.document["validity"] if one["name"] == "slope")
        assert check["value"] == pytest.approx(si(done, "largest_radius")[0] / smaller, rel=1e-5)  # a step of 1e-6
    assert "slope" in run(CUP | {"counter_radius": "-10.01 mm"}, PATH | {"displacements": ["0 nm", "1 µm"]}).warnings


@pytest.mark.parametrize(
    ("counter", "words"),
    [
        ("-10 mm", "less than -10 mm (concave), else the bodies conform"),
        ("0 mm", "must be greater than 0 (convex)"),
    ],
)
def test_a_cup_is_wider_than_its_ball(counter: str, words: str) -> None:
    printed = message(CUP | {"counter_radius": counter})
    assert printed.startswith(f'bodies.profile.counter_radius = "{counter}": must be greater than 0')
    assert words in printed
    assert "\n" not in printed


def test_only_a_parabola_outside_the_papers_two_equal_spheres_has_it() -> None:
    assert "counter_radius: unknown key" in message({**CUP, "kind": "circle"})
    assert 'not with reduction = "geike_popov"' in message(CUP, reduction="geike_popov")
