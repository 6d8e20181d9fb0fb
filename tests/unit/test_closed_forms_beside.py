"""Claim: beside a result stands every closed form that applies to it, and none that does not.

References: written down here, K. L. Johnson's and Sneddon's, in the variable that the scene gives.
"""

import math
from typing import Any

import pytest

from contact1d import run
from tests.scenes import chains

ROUND_OFF = 1e-12
"""Relative: a bisection to the last digit, and a few operations."""
LIMIT = 0.08
"""Relative, of Maugis and Dugdale near JKR's and DMT's limits (`analysis.theory.adhesion`)."""
E, R, F, D, WORK = 0.4, 300.0, 7.0, 1.3, 0.01
LOAD, PATH = {"kind": "load", "force": F}, {"kind": "path", "displacements": [0.0, D, 0.5]}
PULL = {"kind": "pull_off", "preload": 2.0}
ADHESION = {"adhesion": {"work_of_adhesion": WORK}}
PROFILES: dict[str, dict[str, Any]] = {
    "parabola": {"kind": "parabola", "radius": R},
    "cone": {"kind": "cone", "slope": 0.05},
    "flat_punch": {"kind": "flat_punch", "radius": 20.0},
}


def forms(profile: str, experiment: dict[str, Any], **more: Any) -> dict[str, dict[str, Any]]:
    """The closed forms beside a contact on a plane, spacing 2 and E* = E, by name."""
    bodies = {"profile": PROFILES[profile], "spacing": 2.0, "lower": "rigid_plane"} | more.pop("bodies", {})
    tables = chains(R, 2.0 * E, interaction=None, bodies=bodies, experiment=experiment, **more)
    return {form["name"]: form for form in run(tables).document["theory"]}


def values(form: dict[str, Any]) -> dict[str, float]:
    return {name: entry["value"] for name, entry in form["values"].items()}


def test_hertz_of_the_paper_s_reduction_is_that_of_its_two_spheres() -> None:
    """c = E*/2 with the stiffness 2E of spacing 2: E* is twice the layer; effective radius R/2."""
    (form,) = forms("parabola", PATH, bodies={"reduction": "geike_popov"}).values()
    force, radius = 4.0 / 3.0 * 2.0 * E * math.sqrt(0.5 * R) * D**1.5, math.sqrt(0.5 * R * D)
    assert form["name"] == "Hertz"
    assert values(form)["largest_force"] == pytest.approx(force, rel=ROUND_OFF)
    assert values(form)["largest_radius"] == pytest.approx(radius, rel=ROUND_OFF)


@pytest.mark.parametrize(
    ("profile", "name", "exact"),
    [
        ("parabola", "Hertz", {"contact_radius": (0.75 * F * R / E) ** (1.0 / 3.0)}),
        ("cone", "Sneddon, cone", {"contact_radius": math.sqrt(2.0 * F / (math.pi * E * 0.05))}),
        ("flat_punch", "Sneddon, flat punch", {"displacement": F / (2.0 * E * 20.0)}),
    ],
)
def test_a_load_has_its_closed_form_and_the_deviation(profile: str, name: str, exact: dict[str, float]) -> None:
    """What the scene gives is no prediction; without a bound there is no peak pressure."""
    (form,) = forms(profile, LOAD).values()
    said = values(form)
    assert form["name"] == name
    assert "force" not in said
    assert ("peak_pressure" in said) == (profile == "parabola")
    for key, value in exact.items():
        assert said[key] == pytest.approx(value, rel=ROUND_OFF)
        assert abs(form["values"][key]["deviation"]) < 0.05


def test_jkr_beside_what_adheres() -> None:
    (form,) = forms("parabola", PULL, **ADHESION).values()
    said, a = values(form), (4.5 * math.pi * WORK * R**2 / E) ** (1.0 / 3.0)
    assert form["name"] == "JKR"
    assert said["adhesion_force"] == pytest.approx(1.5 * math.pi * WORK * R, rel=ROUND_OFF)
    assert said["zero_load_radius"] == pytest.approx(a, rel=ROUND_OFF)
    # Of a path the deepest state is reported, d = a²/R − √(2πaW/E*): not that without a load.
    a *= 1.3
    deepest = a**2 / R - math.sqrt(2.0 * math.pi * WORK * a / E)
    path = {"kind": "path", "displacements": [0.0, deepest]}
    central = 2.0 * E * a / (math.pi * R) - math.sqrt(2.0 * E * WORK / (math.pi * a))
    (form,) = forms("parabola", path, **ADHESION).values()
    assert values(form)["central_pressure"] == pytest.approx(central, rel=1e-9)


def test_kendall_beside_a_punch_that_adheres() -> None:
    (form,) = forms("flat_punch", PULL, **ADHESION).values()
    exact = math.sqrt(8.0 * math.pi * E * WORK * 20.0**3)
    assert form["name"] == "Kendall, flat punch"
    assert values(form)["adhesion_force"] == pytest.approx(exact, rel=ROUND_OFF)


@pytest.mark.parametrize(("tabor", "names"), [(5.5, ["JKR"]), (0.05, ["JKR", "DMT"])])
def test_maugis_and_dugdale_beside_a_range_lie_between_jkr_and_dmt(tabor: float, names: list[str]) -> None:
    span = (R * (WORK / E) ** 2) ** (1.0 / 3.0) / tabor
    found = forms("parabola", PULL, adhesion={"work_of_adhesion": WORK, "range": span})
    maugis = found.pop("Maugis and Dugdale")
    assert list(found) == names
    assert maugis["tabor"] == pytest.approx(tabor, rel=ROUND_OFF)
    assert f"the Tabor parameter is {tabor:.3g}" in maugis["applies"]
    limit = values(found[names[-1]])
    assert limit["adhesion_force"] == pytest.approx((1.5 if tabor > 5.0 else 2.0) * math.pi * WORK * R, rel=ROUND_OFF)
    for name in ("adhesion_force", "zero_load_radius"):
        assert values(maugis)[name] == pytest.approx(limit[name], rel=LIMIT)


@pytest.mark.parametrize(("stiffness", "name", "low"), [(0.83, "Maugis-Dugdale", 1.5), (30.0, "DMT", 2.0)])
def test_a_sphere_that_an_interaction_holds_has_the_theory_of_its_tabor_parameter(
    stiffness: float, name: str, low: float
) -> None:
    """Of the implied W; F_A = 2πWR of DMT's, less of Maugis and Dugdale's; none beside the paper's reduction."""
    tables = chains(100.0, stiffness, experiment=PULL, bodies={"reduction": "mdr"}, accuracy={"tolerance": 1e-2})
    found = run(tables)
    (form,) = found.document["theory"]
    assert form["name"] == name
    unit = math.pi * found.results.work_of_adhesion.value * 100.0
    assert low * unit * (1.0 - ROUND_OFF) <= values(form)["adhesion_force"] <= 2.0 * unit * (1.0 + ROUND_OFF)
    tables["bodies"] |= {"reduction": "geike_popov"}
    if name == "Maugis-Dugdale":
        assert run(tables).document["theory"] == []


def test_where_a_closed_form_does_not_hold_there_is_none() -> None:
    assert forms("parabola", LOAD, neighbours={"stiffness": 0.3}) == {}
    assert forms("cone", PATH, bodies={"reduction": "geike_popov"}) == {}
