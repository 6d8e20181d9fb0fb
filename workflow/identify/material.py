"""A sphere of a material: the scene that stands for it, and what JKR says that it holds."""

from __future__ import annotations

from contact1d.analysis.theory.jkr import Jkr, work_of_adhesion
from contact1d.workflow.identify.target import IdentifyError, Target, require_held
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.scene.material import PARABOLA_SHARE

RESOLUTION = 28.5
"""Particles in a₀, unless the length unit is given: as in the first row of the paper's Table 1."""
FEWEST_IN_RADIUS = 8.0
"""Fewest particles in a₀ that a length unit must leave."""
MOST_IN_RADIUS = 2000.0
"""Most particles in a₀."""
LARGEST_RADIUS_SHARE = 0.6
"""Largest a₀ over the radius of the sphere: beyond it neither a parabola nor a half space is meant."""
PRELOAD_SHARE = 0.7
"""Preload of a scene for a material over its F_A."""
SHAPE = {"amplitudes": 2.0, "ranges": 2.0}
"""A over B and b over a of a scene for a material: those of the shipped pull_off scene."""


def material_scene(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None = None, tolerance: float = 1e-3
) -> tuple[Scene, Target]:
    """A scene for a sphere of a material, and its target in model units; the interaction is still to be identified.

    The reduction is the MDR's, so that stiffness, displacement and radius are those of the sphere. FU is chosen so that
    a bulk spring has the stiffness 1 FU/LU.

    Args:
        contact_modulus: E* [Pa].
        radius: R of the sphere, or effective of both [m].
        target: F_A [N] and a₀ [m].
        length_unit: of one LU [m]; None: such that a₀ has some 28 particles.
        tolerance: of the scene.

    Raises:
        IdentifyError: a target out of reach, or a length unit that is too coarse.
    """
    require_held(target, contact_modulus, PARABOLA_SHARE["mdr"] * radius, ("N", "m"))  # the MDR's springs are E*
    coarsest = target.zero_load_radius / FEWEST_IN_RADIUS
    unit = target.zero_load_radius / RESOLUTION if length_unit is None else length_unit
    if unit > coarsest:
        raise IdentifyError(
            f"a length unit of {unit:.4g} m leaves {target.zero_load_radius / unit:.2g} particles in the zero-load "
            f"radius of {target.zero_load_radius:.4g} m: at most {coarsest:.4g} m leaves {FEWEST_IN_RADIUS:g}"
        )
    if unit < target.zero_load_radius / MOST_IN_RADIUS:
        raise IdentifyError(
            f"a length unit of {unit:.4g} m puts {target.zero_load_radius / unit:.2g} particles into the zero-load "
            f"radius of {target.zero_load_radius:.4g} m: at least {target.zero_load_radius / MOST_IN_RADIUS:.4g} m "
            f"leaves {MOST_IN_RADIUS:g}"
        )
    if target.zero_load_radius > LARGEST_RADIUS_SHARE * radius:
        raise IdentifyError(
            f"the zero-load radius of {target.zero_load_radius:.4g} m is {target.zero_load_radius / radius:.2g} of the "
            f"sphere's: JKR is for contacts small beside the sphere, here up to {LARGEST_RADIUS_SHARE:g} of it. A "
            "larger radius, a larger contact modulus or a smaller surface energy has that"
        )
    force_unit = 2.0 * contact_modulus * unit**2
    wanted = Target(target.adhesion_force / force_unit, target.zero_load_radius / unit)
    depth = wanted.zero_load_radius**2 / (radius / unit)
    reach, energy = 0.3 * depth, 0.1 * depth**2
    scene = scene_from_dict(
        {
            "title": f"Sphere of R = {radius:.4g} m, E* = {contact_modulus:.4g} Pa",
            "bodies": {
                "particles": "auto",
                "spacing": 1.0,
                "profile": {"kind": "parabola", "radius": radius / unit},
                "reduction": "mdr",
                "bulk_stiffness": "auto",
            },
            "interaction": {
                "repulsion": {"amplitude": SHAPE["amplitudes"] * energy, "range": reach / SHAPE["ranges"]},
                "attraction": {"amplitude": energy, "range": reach},
            },
            "material": {"contact_modulus": contact_modulus, "length_unit": unit, "force_unit": force_unit},
            "accuracy": {"tolerance": tolerance},
            "experiment": {"kind": "pull_off", "preload": PRELOAD_SHARE * wanted.adhesion_force},
        }
    )
    return scene, wanted


def jkr_target(contact_modulus: float, surface_energy: float, radius: float) -> Target:
    """F_A = 3πγR [N] and a₀ = (9πγR²/E*)^{1/3} [m] of JKR; E* [Pa], γ of one side [J/m²], R [m]."""
    sphere = Jkr(radius, contact_modulus, work_of_adhesion(surface_energy))
    return Target(sphere.pull_off_force(), sphere.zero_load_radius())
