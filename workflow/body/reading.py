"""The body that the results of a run describe: with the paper's reduction a length of the image is not the body's.

The reduction of Geike and Popov represents two equal spheres R. Their force and displacement are those of the run;
their contact radius is half of the image's half-width, and their mean pressure F/πa² four times that of the image.
Where a scene chooses that reduction against the default, the half-width is reported as `image_contact_radius`, and
`contact_radius` is that of the two spheres.
"""

from __future__ import annotations

from collections.abc import Mapping

from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.tables import ALIKE, SPHERES, WIDER_THAN_SPHERES, default_reduction, wider_than_body
from contact1d.workflow.units import Quantity

IMAGE = "image_"
"""Prefix of the name of a length that is the image's and not the body's."""


def _is_image(scene: Scene) -> bool:
    """Whether lengths of the run are those of the image; units that follow from F_A and a₀ make a₀ the body's."""
    bodies = scene.bodies
    by_run = scene.material is not None and scene.material.surface_energy is not None
    by_default = default_reduction(scene.material is not None, bodies.lower, bodies.profile.kind)
    return bodies.reduction == "geike_popov" != by_default and bodies.profile.kind not in ALIKE and not by_run


def stands_for_spheres(scene: Scene) -> bool:
    """Whether the results are those of the paper's two equal spheres, and lengths of the image are reported as well."""
    return _is_image(scene) and scene.bodies.profile.kind in SPHERES


def of_the_body(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return the quantities of a run by names that state the body to which they belong.

    Unchanged where that is the image's. Lengths of the image have the prefix "image_"; of the paper's spheres there are
    a contact radius of half, and a mean pressure of four times, those of the image; a mean pressure of other bodies is
    left out.
    """
    if not _is_image(scene):
        return dict(quantities)
    named: dict[str, Quantity] = {}
    spheres = scene.bodies.profile.kind in SPHERES
    for name, quantity in quantities.items():
        if name.endswith("radius"):
            named[IMAGE + name] = quantity
            if spheres:
                named[name] = product(1.0 / WIDER_THAN_SPHERES, quantity.unit, (quantity, 1.0))
        elif name == "mean_pressure":
            if spheres:
                named[name] = product(WIDER_THAN_SPHERES**2, quantity.unit, (quantity, 1.0))
        else:
            named[name] = quantity
    return named


def doubt_of_the_image(scene: Scene) -> dict[str, str]:
    """Return {"reduction": warning}: the body for which the results hold, and the factors for another one.

    {} where the results are those of the body.
    """
    if not _is_image(scene):
        return {}
    kind = scene.bodies.profile.kind
    factor = wider_than_body(scene.bodies.profile.model_dump(by_alias=True))
    one_body = "" if factor is None else (
        f": under the same force the image has {factor:.4g} times its contact radius and {factor**-2:.4g} of its mean "
        "pressure"
    )  # fmt: skip
    if kind in SPHERES:
        whose = (
            "the numbers are those of two equal spheres of this radius pressed together, whose force, displacement and "
            f"contact radius are right; the image (image_…, curve.csv, profile.csv) is {WIDER_THAN_SPHERES:g} times as "
            "wide as their contact. "
        )
    else:
        whose = f"it was derived for two equal spheres, and a {kind.replace('_', ' ')} as given represents no body. "
    return {"reduction": f"geike_popov was chosen: {whose}For one body on a plane use mdr{one_body}"}


def product(factor: float, unit: str, *powers: tuple[Quantity, float]) -> Quantity:
    """Return `factor` times the product of quantities, each to its power, in `unit`; their uncertainties add up."""
    value, spread = factor, 0.0
    for quantity, power in powers:
        part = quantity.value**power
        change = power * quantity.value ** (power - 1.0) * quantity.uncertainty
        value, spread = value * part, spread * abs(part) + abs(value * change)
    return Quantity(value, spread, unit)
