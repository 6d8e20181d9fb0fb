"""Which reduction a scene has if it names none, and how far the paper's is off for a body that it was not derived for.

The paper's takes the profile as drawn, z = c xⁿ, with the layer c_n = E*/2. Under a force F it is wide

    a = [(n + 1) F/(n c E*)]^{1/(n+1)},     the body of that profile on a plane (Galin; κ_n in `profiles`) has
    a = [(n + 1) F/(2 n κ_n c E*)]^{1/(n+1)}

so that the image is (2κ_n)^{1/(n+1)} times as wide and has the inverse square of that as mean pressure. For two equal
spheres, for which it was derived, force and displacement are theirs, and the image is 2 times as wide.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from contact1d.workflow.scene.problems import Problem, shown

if TYPE_CHECKING:
    from contact1d.workflow.scene.draft import Draft
    from contact1d.workflow.scene.material import Reduction
    from contact1d.workflow.scene.tables import Bodies

MEANING = (
    'how the plane model stands for a 3D one: "geike_popov" (profile as drawn) or "mdr" (transformed); absent: "mdr" '
    'with a material, on a rigid plane and for every profile but a parabola, else "geike_popov"'
)
"""What the key is; None stands for absent only until the scene that the bodies belong to chooses."""
SPHERES = ("parabola", "circle")
"""Profiles of which two make the pair of spheres of the paper."""
ALIKE = ("flat_punch", "flat")
"""Profiles that both reductions leave as they are: in model units, where springs are given, nothing differs."""
WIDER_THAN_SPHERES = 2.0
"""Half-width of the paper's image over the contact radius of its two equal spheres."""


def default_reduction(has_material: bool, lower: str, profile: str) -> Reduction:
    """The reduction of a scene that names none: the paper's for its own plane model alone."""
    return "mdr" if has_material or lower == "rigid_plane" or profile != "parabola" else "geike_popov"


def with_reduction(bodies: Bodies, has_material: bool) -> Bodies:
    """The bodies with a reduction, which still counts as not given where it is by default (`Scene.with_`)."""
    if bodies.reduction is not None:
        return bodies
    chosen = bodies.model_copy(update={"reduction": default_reduction(has_material, bodies.lower, bodies.profile.kind)})
    chosen.model_fields_set.discard("reduction")
    return chosen


def galin_factor(n: float) -> float:
    """κ_n = (√π/2) n Γ(n/2)/Γ((n+1)/2)."""
    return 0.5 * math.sqrt(math.pi) * n * math.exp(math.lgamma(0.5 * n) - math.lgamma(0.5 * (n + 1.0)))


def wider_than_body(profile: Mapping[str, Any]) -> float | None:
    """Half-width of the paper's image over the contact radius of that body on a plane, under the same force.

    Args:
        profile: with the keys of a scene file. Of a circle or an ellipsoid the factor is that of its parabola.

    Returns:
        (2κ_n)^{1/(n+1)}; None where no closed form tells.
    """
    exponents = {"cone": 1.0, "parabola": 2.0, "circle": 2.0, "ellipsoid": 2.0, "power": profile.get("exponent")}
    n = exponents.get(str(profile.get("kind")))
    if isinstance(n, bool) or not isinstance(n, int | float) or not n >= 1.0:
        return None
    return float((2.0 * galin_factor(n)) ** (1.0 / (n + 1.0)))


def derived_for_spheres(draft: Draft) -> Iterator[Problem]:
    """With a material the numbers are a body's, and the paper's reduction has those of two equal spheres only."""
    profile = draft.get("bodies", "profile")
    chosen = draft.get("bodies", "reduction") == "geike_popov"
    if not chosen or not draft.has("material") or not isinstance(profile, Mapping) or profile.get("kind") in SPHERES:
        return
    factor = wider_than_body(profile)
    if factor is not None:
        off = (
            f"{factor:.4g} times this body's contact radius under the same force, {factor**-2:.4g} of its mean pressure"
        )
    else:
        off = (
            "half of this body's force at the same displacement"
            if profile.get("kind") in ALIKE
            else "the contact of another body"
        )
    hint = 'write "mdr", which has force, displacement and radius of any axisymmetric body, or leave it out'
    message = f"was derived for two equal spheres; with this profile it has {off}"
    yield Problem("bodies.reduction", message, shown("geike_popov"), hint)
