"""The units LU and FU of a finished run in SI, where the scene has a [material].

With `length_unit`:      c LU² h χ / k = FU,  c the layer's stiffness per length, h the spacing, k the stiffness of a
                         bulk spring, χ = 2 chains in series, or 1 on a rigid plane.
With `surface_energy`:   γ = F_A/3πR and E* = 3 F_A R/a₀³ hold in both systems (Geike and Popov, Eq. 9), so that
                         LU = (γ/γ_model) (E*_model/E*),  FU = (γ/γ_model) LU.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from contact1d.workflow.scene import Scene
from contact1d.workflow.units import UNKNOWN, Quantity, Scales

UNIT_FIXING_RESULTS = ("adhesion_force", "zero_load_radius")
"""Results that must be positive for `surface_energy` to fix the units of a run."""


def scales_of(scene: Scene, quantities: Mapping[str, Quantity]) -> Scales:
    """Return the scales of a run: LU [m], FU [N] and, where the scene gives it, MU [kg], with their uncertainties.

    They are unknown (`known` is False) without a [material], or without the results that fix them. Numbers of the
    material with ± that are no part of the model, as where it has its own stiffness, make the scales uncertain: `ends`
    has the scales at both ends of each.

    Args:
        scene: of the run.
        quantities: results in units of the model by name, of which `adhesion_force` and `zero_load_radius` may be
            needed.
    """
    ends = tuple(
        tuple(_scales(scene.moved(key, 1.0 + side * share), quantities) for side in (-1.0, 1.0))
        for key, share in scene.shares.items()
        if key.startswith("material.")
    )
    return replace(_scales(scene, quantities), ends=ends)


def _scales(scene: Scene, quantities: Mapping[str, Quantity]) -> Scales:
    """Return the scales of a run by the values of the numbers, without the uncertainty due to their ±.

    They are unknown (`known` is False) without a [material], or without the results that fix them.
    """
    material = scene.material
    if material is None or unfound(scene, quantities):
        return UNKNOWN
    if material.surface_energy is not None:
        force, radius = (quantities[name] for name in UNIT_FIXING_RESULTS)
        curvature = scene.bodies.profile.curvature_radius
        assert curvature is not None
        return jkr_scales(force, radius, curvature, material.effective_modulus(), material.surface_energy)
    length, force_unit = material.length_unit, material.force_unit
    assert length is not None
    if force_unit is None:
        layer = material.layer_stiffness(scene.bodies.reduction)
        force_unit = scene.chains * layer * scene.bodies.spacing * length**2 / scene.bulk_stiffness
    return Scales(length, force_unit, mass=material.mass_unit)


def unfound(scene: Scene, quantities: Mapping[str, Quantity]) -> tuple[str, ...]:
    """Return the names of F_A and a₀ where the scene's units need them and they are missing or not above 0; else ().

    Only `surface_energy` in [material] needs them.
    """
    if scene.material is None or scene.material.surface_energy is None:
        return ()
    return tuple(name for name in UNIT_FIXING_RESULTS if name not in quantities or not quantities[name].value > 0.0)


def jkr_scales(
    adhesion_force: Quantity,
    zero_load_radius: Quantity,
    curvature_radius: float,
    contact_modulus: float,
    surface_energy: float,
) -> Scales:
    """Return the scales, LU [m] and FU [N], with which a run is JKR's contact of a material, with uncertainties.

    These are due to F_A and a₀. MU is not known.

    Args:
        adhesion_force: F_A > 0 [FU], tension positive.
        zero_load_radius: a₀ > 0 [LU].
        curvature_radius: R [LU].
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].
    """
    tension, radius = adhesion_force.value, zero_load_radius.value
    energy = surface_energy / (tension / (3.0 * math.pi * curvature_radius))
    modulus = contact_modulus / (3.0 * tension * curvature_radius / radius**3)
    length = energy / modulus
    force = energy * length
    # LU ∝ a₀⁻³ F_A⁰ and FU ∝ a₀⁻³ F_A⁻¹
    uncertainty = 3.0 * zero_load_radius.uncertainty / radius
    return Scales(length, force, length * uncertainty, force * (uncertainty + adhesion_force.uncertainty / tension))
