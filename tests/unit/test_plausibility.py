"""Sizes that no contact in a laboratory has are told by name; ordinary ones are not."""

from __future__ import annotations

from typing import Any

import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.runs.plausibility import implausible
from contact1d.workflow.units import Quantity, Scales

STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
RUBBER = {"youngs_modulus": "2 MPa", "poisson_ratio": 0.5}
SI = Scales(1.0, 1.0)


def scene(material: dict[str, Any], **bodies: Any) -> Scene:
    profile = {"kind": "parabola", "radius": "10 mm"}
    own = {"particles": "auto", "spacing": "4 µm", "bulk_stiffness": "auto", "lower": "rigid_plane", "reduction": "mdr"}
    experiment = {"kind": "load", "force": "10 N"}
    return read_scene(
        {"title": "t", "bodies": own | {"profile": profile} | bodies, "material": material, "experiment": experiment}
    )


@pytest.mark.parametrize("other", [STEEL, RUBBER, {"youngs_modulus": 1e30, "poisson_ratio": 0.0}])
def test_ordinary_materials_and_a_rigid_one_are_not_told(other: dict[str, Any]) -> None:
    assert implausible(scene({"upper": STEEL, "lower": other}), SI, {}) == {}


@pytest.mark.parametrize(
    ("given", "name", "words"),
    [
        (scene({"upper": STEEL | {"youngs_modulus": 210}, "lower": STEEL}), "implausible_modulus",
         "material.upper.youngs_modulus is 210 Pa, softer than any gel: was 210 GPa meant?"),
        (scene({"contact_modulus": "1 mPa"}), "implausible_modulus",
         "0.001 Pa, softer than any gel: check its unit"),
        (scene({"contact_modulus": "210e6 GPa"}), "implausible_modulus", "2.1e+17 Pa is stiffer than diamond"),
        (scene({"upper": STEEL, "lower": STEEL | {"poisson_ratio": -0.3}}), "implausible_poisson_ratio",
         "material.lower.poisson_ratio is -0.3, and few materials have one below 0: check its sign"),
        (scene({"contact_modulus": "1 GPa"}, profile={"kind": "parabola", "radius": "50 m"}), "implausible_size",
         "bodies.profile.radius is 50 m, and no ball of such a radius is smooth: check its unit"),
        (scene({"contact_modulus": "1 GPa"}, profile={"kind": "circle", "radius": "0.1 nm"}, spacing="0.1 pm"),
         "implausible_size", "bodies.spacing is 1e-13 m, a hundredth of an atom"),
    ],
)  # fmt: skip
def test_what_looks_wrong_is_said(given: Scene, name: str, words: str) -> None:
    told = implausible(given, SI, {})
    assert list(told) == [name]
    assert words in told[name]


def test_a_contact_below_an_atom_is_told() -> None:
    steel = scene({"upper": STEEL, "lower": STEEL})
    small = {"contact_radius": Quantity(3e-11, 1e-13, "LU"), "force": Quantity(1e-11, 0.0, "FU")}
    assert implausible(steel, SI, small) == {
        "below_an_atom": "the contact radius is 3e-11 m, less than that of an atom, 1e-10 m"
    }
    assert implausible(steel, SI, {"contact_radius": Quantity(3e-9, 1e-13, "LU")}) == {}
