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
    """Return whether the lengths of a run are those of the plane image of Geike and Popov, and not those of the body.

    So it is where the scene chooses "geike_popov" although the default is the MDR. False of a flat or flat-punch
    profile, for which both reductions are the same, and where the units follow from `material.surface_energy`.
    """
    bodies = scene.bodies
    by_run = scene.material is not None and scene.material.surface_energy is not None
    by_default = default_reduction(scene.material is not None, bodies.lower, bodies.profile.kind)
    return bodies.reduction == "geike_popov" != by_default and bodies.profile.kind not in ALIKE and not by_run


def stands_for_spheres(scene: Scene) -> bool:
    """Return whether the results are those of two equal spheres, and the lengths of their image are reported as well.

    So it is for a parabola or a circle where the scene chooses "geike_popov" although the default is the MDR, and the
    units do not follow from `material.surface_energy`.
    """
    return _is_image(scene) and scene.bodies.profile.kind in SPHERES


def image_ratio(scene: Scene) -> float:
    """Return the width of the contact in the particle model over that of the body, dimensionless.

    It is 2 where results are those of two equal spheres (the reduction of Geike and Popov, chosen against the default,
    of a parabola or a circle), else 1.
    """
    return WIDER_THAN_SPHERES if stands_for_spheres(scene) else 1.0


def of_the_body(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return a new dict of the quantities of a run, by names that state the body to which they belong.

    Where the scene chooses "geike_popov" although the default is the MDR, a name that ends in "radius" gets the prefix
    "image_". For a parabola or a circle (two equal spheres) the name without the prefix is added with half of the
    value, and "mean_pressure" is four times that of the image; for other profiles "mean_pressure" is left out.
    Everything else, and all quantities of other scenes, stay as they are.
    """
    if not _is_image(scene):
        return dict(quantities)
    named: dict[str, Quantity] = {}
    spheres = scene.bodies.profile.kind in SPHERES
    for name, quantity in quantities.items():
        is_radius = name.endswith("radius")
        if is_radius:
            named[IMAGE + name] = quantity
        if not is_radius and name != "mean_pressure":
            named[name] = quantity
        elif spheres:
            factor = 1.0 / WIDER_THAN_SPHERES if is_radius else WIDER_THAN_SPHERES**2
            named[name] = product(factor, quantity.unit, (quantity, 1.0))
    return named


def doubt_of_the_image(scene: Scene) -> dict[str, str]:
    """Return {"reduction": warning} where a scene chooses "geike_popov" although the default is the MDR; else {}.

    The warning names the body for which the results hold, and where known the factors of contact radius and mean
    pressure for one body on a plane. {} also of a flat or flat-punch profile, and where the units follow from
    `material.surface_energy`.
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
    """Return `factor` times the product of quantities, each to its power, as a quantity in `unit`.

    The unit is taken as given, not computed. The uncertainty is the largest change of the size of the product as each
    quantity grows by its own; of a power below 1 to first order. `factor` has none.

    Raises:
        ZeroDivisionError: a quantity is 0, and its power below 1.
    """
    value, spread = factor, 0.0
    for quantity, power in powers:
        part, size = quantity.value**power, abs(quantity.value)
        if power < 1.0:
            change = abs(power * part / quantity.value) * quantity.uncertainty
        else:
            change = (size + quantity.uncertainty) ** power - size**power
        value, spread = value * part, spread * abs(part) + (abs(value) + spread) * change
    return Quantity(value, spread, unit)
