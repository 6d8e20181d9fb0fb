"""Claim: a scene without a reduction has the one that is right for its body; the paper's is refused, or has a factor.

References: Galin and Sneddon (`analysis.theory.indenters`) for the body, the integral over springs for the image.
"""

from __future__ import annotations

import math
import tomllib
from typing import Any

import pytest
from scipy.optimize import brentq

from contact1d import Scene, SceneError, read_scene
from contact1d.analysis.theory.indenters import PowerLaw
from contact1d.workflow.body.reading import doubt_of_the_image, of_the_body
from contact1d.workflow.scene.tables import wider_than_body
from contact1d.workflow.units import Quantity
from tests.scenes import chains

ROUND_OFF = 1e-12
"""Relative: a root, and a few operations."""
MATERIAL = {"contact_modulus": 70e9, "length_unit": 1e-6}
PATH = {"kind": "path", "displacements": [0.1]}
CONE, PUNCH = {"kind": "cone", "slope": 0.1}, {"kind": "flat_punch", "radius": 10.0}
POWER = {"kind": "power", "exponent": 4.0, "radius": 20.0, "height": 1.0}
TABLE = {"kind": "table", "r": [0.0, 10.0, 20.0, 30.0], "z": [0.0, 1.0, 4.0, 9.0]}


def scene(profile: dict[str, Any] | None = None, plane: bool = False, **more: Any) -> Scene:
    bodies = {"profile": profile or {"kind": "parabola", "radius": 100.0}} | more.pop("bodies", {})
    if plane:
        more["interaction"] = None
        bodies["lower"] = "rigid_plane"
    return read_scene(chains(100.0, bodies=bodies, experiment=PATH, **more))


def test_the_paper_s_own_plane_model_has_the_paper_s_reduction() -> None:
    assert scene().bodies.reduction == "geike_popov"


@pytest.mark.parametrize(
    "asked",
    [
        scene(plane=True), scene(material=MATERIAL), scene(material=MATERIAL, plane=True),
        *(scene(profile) for profile in (CONE, PUNCH, POWER, TABLE, {"kind": "circle", "radius": 50.0})),
    ],
)  # fmt: skip
def test_every_other_scene_has_the_mdr(asked: Scene) -> None:
    assert asked.bodies.reduction == "mdr"
    assert not doubt_of_the_image(asked)


def test_what_is_chosen_by_default_is_chosen_anew_when_the_scene_changes() -> None:
    asked = scene()
    assert asked.with_({"bodies.profile": CONE}).bodies.reduction == "mdr"
    assert asked.with_({"bodies.profile": CONE}).with_({"bodies.profile": asked.bodies.profile}) == asked
    given = scene(bodies={"reduction": "geike_popov"})
    assert given.with_({"bodies.profile": CONE}).bodies.reduction == "geike_popov"
    assert given == asked


def test_the_file_of_a_run_states_its_reduction() -> None:
    for asked in (scene(), scene(CONE)):
        text = str(asked)
        assert tomllib.loads(text)["bodies"]["reduction"] == asked.bodies.reduction
        assert read_scene(tomllib.loads(text)) == asked


@pytest.mark.parametrize(("profile", "words"), [
    (CONE, "1.772 times this body's contact radius under the same force, 0.3183 of its mean pressure"),
    (POWER, "1.398 times this body's contact radius"),
    (PUNCH, "half of this body's force at the same displacement"),
    (TABLE, "the contact of another body"),
])  # fmt: skip
def test_with_a_material_the_paper_s_reduction_of_no_sphere_is_refused(profile: dict[str, Any], words: str) -> None:
    for plane in (False, True):
        with pytest.raises(SceneError) as caught:
            scene(profile, plane, material=MATERIAL, bodies={"reduction": "geike_popov"})
        said = str(caught.value)
        assert said.startswith('bodies.reduction = "geike_popov": was derived for two equal spheres')
        assert words in said
        assert 'write "mdr"' in said
        assert scene(profile, plane, material=MATERIAL, bodies={"reduction": "mdr"}).bodies.reduction == "mdr"


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 4.0, 10.0])
def test_factor_is_that_of_the_two_closed_forms(exponent: float) -> None:
    """E* = 1, z = xⁿ: half-width of the springs E*/2 as drawn over the contact radius of the body, at F = 1."""
    body = PowerLaw(1.0, exponent, 1.0)
    a = brentq(lambda a: float(body.force(a)) - 1.0, 0.1, 10.0, xtol=1e-15)
    image = brentq(
        lambda b: 0.5 * 2.0 * (b ** (exponent + 1.0) * exponent / (exponent + 1.0)) - 1.0, 0.1, 10.0, xtol=1e-15
    )
    profile = {"kind": "power", "exponent": exponent}
    assert wider_than_body(profile) == pytest.approx(image / a, rel=ROUND_OFF)


def test_lengths_of_the_image_have_a_name_of_their_own() -> None:
    asked = scene(plane=True, bodies={"reduction": "geike_popov"})
    found = of_the_body(
        asked, {"contact_radius": Quantity(8.0, 0.1, "LU"), "mean_pressure": Quantity(1.0, 0.1, "FU/LU²")}
    )
    assert found["image_contact_radius"] == Quantity(8.0, 0.1, "LU")
    assert found["contact_radius"] == Quantity(4.0, 0.05, "LU")
    assert found["mean_pressure"] == Quantity(4.0, 0.4, "FU/LU²")
    doubt = doubt_of_the_image(asked)["reduction"]
    assert f"{4 ** (1 / 3):.4g} times its contact radius and {4 ** (-2 / 3):.4g} of its mean pressure" in doubt
    cone = of_the_body(scene(CONE, bodies={"reduction": "geike_popov"}), {"contact_radius": Quantity(8.0, 0.1, "LU")})
    assert set(cone) == {"image_contact_radius"}
    assert (
        f"{math.sqrt(math.pi):.4g} times"
        in doubt_of_the_image(scene(CONE, bodies={"reduction": "geike_popov"}))["reduction"]
    )


def test_where_both_reductions_say_the_same_nothing_is_doubted() -> None:
    """A flat punch on given springs; the paper's chains; units that make the run's a₀ JKR's."""
    units = {"contact_modulus": 70e9, "surface_energy": 1.0}
    pull_off = {"kind": "pull_off", "preload": 0.3}
    by_run = chains(100.0, material=units, experiment=pull_off, bodies={"reduction": "geike_popov"})
    for asked in (scene(PUNCH, True, bodies={"reduction": "geike_popov"}), scene(), read_scene(by_run)):
        radius = {"contact_radius": Quantity(8.0, 0.1, "LU")}
        assert of_the_body(asked, radius) == radius
        assert not doubt_of_the_image(asked)
