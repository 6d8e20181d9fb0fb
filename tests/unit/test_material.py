"""[material]: elasticity by textbook formulae, the springs and units that follow."""

from __future__ import annotations

import math

import pytest

from contact1d import read_scene
from contact1d.workflow.runs.scales import jkr_scales, scales_of
from contact1d.workflow.scene import Elastic, Material
from contact1d.workflow.units import Quantity, Scales
from tests.materials import E_STAR, PATH, RUBBER, STEEL, UNITS, tables

ROUND_OFF = 1e-13
"""Relative: a few operations each."""
PRINTED = {"LU": 0.05e-9, "FU": 0.05e-6}
"""Half a unit of the last printed figure of Table 1."""

# Elasticity.


def test_contact_modulus_of_two_bodies() -> None:
    material = Material(upper=Elastic(**STEEL), lower=Elastic(**RUBBER))
    by_hand = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.25) / 2e6)
    assert material.effective_modulus() == pytest.approx(by_hand, rel=ROUND_OFF)
    assert Material(upper=Elastic(**RUBBER), lower=Elastic(**STEEL)).effective_modulus() == material.effective_modulus()


@pytest.mark.parametrize("nu", [-0.9, -0.3, 0.0, 0.3, 0.5])
def test_equal_materials_have_the_contact_modulus_g_over_1_minus_nu(nu: float) -> None:
    """And G*/E* = 2(1 − ν)/(2 − ν), Cattaneo and Mindlin's."""
    body = Elastic(youngs_modulus=7.0, poisson_ratio=nu)
    material = Material(upper=body, lower=body)
    shear = 7.0 / (2.0 * (1.0 + nu))
    assert material.effective_modulus() == pytest.approx(shear / (1.0 - nu), rel=ROUND_OFF)
    assert material.tangential_share() == pytest.approx(2.0 * (1.0 - nu) / (2.0 - nu), rel=ROUND_OFF)


def test_tangential_share_of_two_bodies_is_that_of_their_compliances() -> None:
    material = Material(upper=Elastic(**STEEL), lower=Elastic(**RUBBER))
    shear = [body["youngs_modulus"] / (2.0 * (1.0 + body["poisson_ratio"])) for body in (STEEL, RUBBER)]
    g_star = 1.0 / ((2.0 - 0.3) / (4.0 * shear[0]) + (2.0 - 0.5) / (4.0 * shear[1]))
    assert material.tangential_share() == pytest.approx(g_star / material.effective_modulus(), rel=ROUND_OFF)


def test_contact_modulus_alone_makes_springs_alike_in_both_directions() -> None:
    material = Material(contact_modulus=3e9)
    assert (material.effective_modulus(), material.tangential_share()) == (3e9, 1.0)


def test_layer_has_the_contact_modulus_with_the_mdr_and_half_of_it_with_geike_and_popov() -> None:
    material = Material(contact_modulus=3e9)
    assert material.layer_stiffness("mdr") == 3e9
    assert material.layer_stiffness("geike_popov") == 1.5e9


# Springs and units.


@pytest.mark.parametrize("lower", ["particles", "rigid_plane"])
@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 0.5), ("mdr", 1.0)])
def test_springs_of_the_material_make_its_layer(lower: str, reduction: str, share: float) -> None:
    """In SI: the springs of all chains in series, k/χ newtons per metre each 0.5 nm, are the layer c h."""
    scene = read_scene(
        tables(E_STAR | UNITS, PATH, bulk_stiffness="auto", lower=lower, reduction=reduction, spacing=0.5)
    )
    chains = 2 if lower == "particles" else 1
    assert scene.chains == chains
    spring = scene.bulk_stiffness * 1e-6 / 1e-9
    assert spring / chains == pytest.approx(share * 200e9 * 0.5e-9, rel=ROUND_OFF)
    scales = scales_of(scene, {})
    assert scales == Scales(1e-9, 1e-6)


@pytest.mark.parametrize("lower", ["particles", "rigid_plane"])
@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 0.5), ("mdr", 1.0)])
def test_force_unit_follows_from_a_given_stiffness(lower: str, reduction: str, share: float) -> None:
    given = E_STAR | {"length_unit": 1e-9}
    scene = read_scene(tables(given, PATH, lower=lower, reduction=reduction, spacing=0.5))
    scales = scales_of(scene, {})
    assert scales.known
    assert scales.length == 1e-9
    assert 0.83 * scales.force / 1e-9 / scene.chains == pytest.approx(share * 200e9 * 0.5e-9, rel=ROUND_OFF)
    assert (scales.length_uncertainty, scales.force_uncertainty) == (0.0, 0.0)
    back = read_scene(
        tables(given | {"force_unit": scales.force}, PATH, lower=lower, reduction=reduction, spacing=0.5,
               bulk_stiffness="auto")
    )  # fmt: skip
    assert back.bulk_stiffness == pytest.approx(0.83, rel=ROUND_OFF)


def test_tangential_springs_are_the_materials_share_unless_given() -> None:
    both = {"upper": STEEL, "lower": STEEL, "length_unit": 1e-9}
    share = 2.0 * 0.7 / 1.7
    assert read_scene(tables(both)).tangential_stiffness == pytest.approx(share * 0.83, rel=ROUND_OFF)
    automatic = read_scene(tables(both | {"force_unit": 1e-6}, bulk_stiffness="auto"))
    assert automatic.tangential_stiffness == pytest.approx(share * automatic.bulk_stiffness, rel=ROUND_OFF)
    assert read_scene(tables(both, bulk_stiffness_tangential=0.5)).tangential_stiffness == 0.5
    assert read_scene(tables(E_STAR | {"length_unit": 1e-9})).tangential_stiffness == 0.83
    assert read_scene(tables()).tangential_stiffness == 0.83


def test_no_material_has_no_scales() -> None:
    assert not scales_of(read_scene(tables()), {}).known


# Units by JKR.


@pytest.mark.parametrize(
    ("radius", "a_0", "f_a", "length", "force"),
    [
        (1000.0, 28.53, 1.47, 6.1e-9, 39.0e-6),
        (1600.0, 36.14, 1.87, 7.7e-9, 61.8e-6),
        (2000.0, 40.36, 2.09, 8.6e-9, 77.6e-6),
    ],
)
def test_table_1_of_the_paper(radius: float, a_0: float, f_a: float, length: float, force: float) -> None:
    """E* = 200 GPa, γ = 1 N/m; γ = F_A/3πR and E* = 3F_A R/a₀³ (Eq. 9), here solved for the units by hand."""
    scales = jkr_scales(Quantity(f_a, 0.0, "FU"), Quantity(a_0, 0.0, "LU"), radius, 200e9, 1.0)
    gamma, modulus = f_a / (3.0 * math.pi * radius), 3.0 * f_a * radius / a_0**3
    by_hand = (modulus / gamma) * 1.0 / 200e9
    assert scales.length == pytest.approx(by_hand, rel=ROUND_OFF)
    assert scales.force == pytest.approx(by_hand * 1.0 / gamma, rel=ROUND_OFF)
    assert scales.length == pytest.approx(length, abs=PRINTED["LU"])
    assert scales.force == pytest.approx(force, abs=PRINTED["FU"])


def test_uncertainty_of_the_units_is_that_of_the_run() -> None:
    """LU ∝ a₀⁻³ and FU ∝ a₀⁻³ F_A⁻¹, by finite differences of the scales themselves."""

    def of(f_a: float, a_0: float) -> Scales:
        return jkr_scales(Quantity(f_a, 1e-5, "FU"), Quantity(a_0, 2e-4, "LU"), 800.0, 5e6, 0.03)

    middle = of(1.3, 25.0)
    by_force, by_radius = of(1.3 + 1e-5, 25.0), of(1.3, 25.0 + 2e-4)
    length = abs(by_force.length - middle.length) + abs(by_radius.length - middle.length)
    force = abs(by_force.force - middle.force) + abs(by_radius.force - middle.force)
    assert middle.length_uncertainty == pytest.approx(length, rel=1e-4)
    assert middle.force_uncertainty == pytest.approx(force, rel=1e-4)


@pytest.mark.parametrize("found", [{}, {"adhesion_force": 1.0}, {"zero_load_radius": 1.0}])
def test_path_without_f_a_or_a_0_has_no_units(found: dict[str, float]) -> None:
    scene = read_scene(tables(E_STAR | {"surface_energy": 1.0}, PATH))
    assert not scales_of(scene, {name: Quantity(value, 0.0, "") for name, value in found.items()}).known


# One quantity in SI.


@pytest.mark.parametrize(
    ("unit", "factor", "name"),
    [("LU", 2e-9, "m"), ("FU", 3e-6, "N"), ("FU/LU", 1.5e3, "N/m"), ("FU/LU²", 0.75e12, "Pa")],
)
def test_each_unit_in_si(unit: str, factor: float, name: str) -> None:
    exact = Scales(2e-9, 3e-6)
    assert exact.factor(unit) == pytest.approx(factor, rel=ROUND_OFF)
    entry = exact.in_si(-4.0, 0.1, unit)
    assert entry["unit"] == name
    assert entry["value"] == pytest.approx(-4.0 * factor, rel=ROUND_OFF)
    assert entry["uncertainty"] == pytest.approx(0.1 * factor, rel=ROUND_OFF)


@pytest.mark.parametrize(("unit", "share"), [("LU", 0.01), ("FU", 0.03), ("FU/LU", 0.04), ("FU/LU²", 0.05)])
def test_uncertainty_of_the_scales_is_added(unit: str, share: float) -> None:
    """1 % of LU, 3 % of FU; powers of them add up, and a negative value has no negative uncertainty."""
    scales = Scales(2e-9, 3e-6, 0.01 * 2e-9, 0.03 * 3e-6)
    factor = scales.factor(unit)
    assert scales.in_si(-4.0, 0.1, unit)["uncertainty"] == pytest.approx((0.1 + 4.0 * share) * factor, rel=ROUND_OFF)
    assert scales.in_si(0.0, 0.0, unit)["uncertainty"] == 0.0


def test_units_of_time_are_not_made_of_lu_and_fu() -> None:
    with pytest.raises(KeyError):
        Scales(1.0, 1.0).factor("TU")
