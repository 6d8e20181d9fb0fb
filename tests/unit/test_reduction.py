"""Claim: a scene without a reduction has the one that is right for its body; the paper's is refused, or has a factor.

References: Galin and Sneddon (`analysis.theory.indenters`) for the body, the integral over springs for the image.
"""

import math
import re
from typing import Any

import pytest
from scipy.optimize import brentq

from contact1d import Run, Scene, SceneError, read_scene, run
from contact1d.analysis.theory.indenters import PowerLaw
from tests.scenes import chains

FOUR_DIGITS = 5e-4
"""Relative: of a factor in a sentence."""
MATERIAL = {"contact_modulus": 70e9, "length_unit": 1e-6}
PATH = {"kind": "path", "displacements": [0.1]}
CONE, PUNCH = {"kind": "cone", "slope": 0.1}, {"kind": "flat_punch", "radius": 10.0}
BALL = {"kind": "parabola", "radius": 100.0}
TABLE = {"kind": "table", "r": [0.0, 10.0, 20.0, 30.0], "z": [0.0, 1.0, 4.0, 9.0]}


def scene(profile: dict[str, Any] | None = None, plane: bool = False, **more: Any) -> Scene:
    bodies = {"profile": profile or BALL} | more.pop("bodies", {})
    if plane:
        more["interaction"] = None
        bodies["lower"] = "rigid_plane"
    return read_scene(chains(100.0, bodies=bodies, experiment=PATH, **more))


def test_the_paper_s_reduction_is_that_of_its_own_plane_model_alone() -> None:
    """It is chosen anew when the scene changes, and the file of a run states it."""
    asked = scene()
    assert asked.bodies.reduction == "geike_popov"
    others = [scene(plane=True), scene(material=MATERIAL), scene(CONE), scene({"kind": "circle", "radius": 50.0})]
    assert {one.bodies.reduction for one in others} == {"mdr"}
    assert asked.with_({"bodies.profile": CONE}).bodies.reduction == "mdr"
    assert asked.with_({"bodies.profile": CONE}).with_({"bodies.profile": asked.bodies.profile}) == asked
    given = scene(bodies={"reduction": "geike_popov"})
    assert given.with_({"bodies.profile": CONE}).bodies.reduction == "geike_popov"
    assert given == asked
    assert 'reduction = "geike_popov"' in str(asked)
    assert read_scene(str(asked)) == asked


def refused(profile: dict[str, Any]) -> str:
    """What is said about the paper's reduction with a material, which the MDR has no need of."""
    with pytest.raises(SceneError) as caught:
        scene(profile, True, material=MATERIAL, bodies={"reduction": "geike_popov"})
    said = str(caught.value)
    assert said.startswith('bodies.reduction = "geike_popov": was derived for two equal spheres')
    assert 'write "mdr"' in said
    assert scene(profile, True, material=MATERIAL, bodies={"reduction": "mdr"}).bodies.reduction == "mdr"
    return said


def test_with_a_material_the_paper_s_reduction_of_no_sphere_is_refused() -> None:
    assert "half of this body's force at the same displacement" in refused(PUNCH)
    assert "the contact of another body" in refused(TABLE)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 4.0, 10.0])
def test_factors_are_those_of_the_two_closed_forms(exponent: float) -> None:
    """E* = 1, z = xⁿ: half-width of the springs E*/2 as drawn over the contact radius of the body, at F = 1."""
    body = PowerLaw(1.0, exponent, 1.0)
    a = brentq(lambda a: float(body.force(a)) - 1.0, 0.1, 10.0, xtol=1e-15)
    b = brentq(lambda b: b ** (exponent + 1.0) * exponent / (exponent + 1.0) - 1.0, 0.1, 10.0, xtol=1e-15)
    kinds = [{"kind": "power", "exponent": exponent, "radius": 20.0, "height": 1.0}, *([CONE] if exponent == 1 else [])]
    for kind in kinds:
        found = re.search(r"([\d.]+) times this body's contact radius under the same force, ([\d.]+) of", refused(kind))
        assert found is not None
        assert float(found[1]) == pytest.approx(b / a, rel=FOUR_DIGITS)
        assert float(found[2]) == pytest.approx((a / b) ** 2, rel=FOUR_DIGITS)


def pressed(profile: dict[str, Any]) -> Run:
    """On given springs."""
    loaded = {"kind": "load", "force": 1.0}
    return run(scene(profile, True, bodies={"reduction": "geike_popov"}).with_({"experiment": loaded}))


def test_lengths_of_the_image_have_a_name_of_their_own() -> None:
    """The two equal spheres have half the image's contact radius, a body on a plane under the same force another."""
    ball, cone = pressed(BALL), pressed(CONE)
    image, own, pressure = (ball.results[name] for name in ("image_contact_radius", "contact_radius", "mean_pressure"))
    assert (own.value, own.uncertainty) == (0.5 * image.value, 0.5 * image.uncertainty)
    assert pressure.value == pytest.approx(1.0 / (math.pi * own.value**2), rel=1e-12)
    assert ball.results["peak_pressure"].value == pytest.approx(1.5 * pressure.value, rel=5e-3)  # Hertz
    doubt = ball.warnings["reduction"]
    assert f"{4 ** (1 / 3):.4g} times its contact radius and {4 ** (-2 / 3):.4g} of its mean pressure" in doubt
    assert {"contact_radius", "mean_pressure"}.isdisjoint(cone.results)
    assert "image_contact_radius" in cone.results
    assert f"{math.sqrt(math.pi):.4g} times" in cone.warnings["reduction"]


def test_where_both_reductions_say_the_same_nothing_is_doubted() -> None:
    """A flat punch on given springs; units that make the run's a₀ JKR's."""
    units = {"contact_modulus": 70e9, "surface_energy": 1.0}
    by_run = chains(
        100.0, material=units, experiment={"kind": "pull_off", "preload": 0.3}, bodies={"reduction": "geike_popov"},
        accuracy={"tolerance": 1e-2},
    )  # fmt: skip
    for done in (pressed(PUNCH), run(by_run)):
        assert "reduction" not in done.warnings
        assert not [name for name in done.results if name.startswith("image")]
