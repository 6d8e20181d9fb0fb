"""Claim: an oblique impact with partial slip is that of Jäger's superposition, from full stick to gross sliding."""

import math
from typing import Any

import numpy as np
import pytest

import contact1d
from validation.references.impact import kelvin_voigt
from validation.references.oblique import PARABOLOID, of_power, sticking
from validation.references.relaxing import KelvinVoigt, Power

KAPPA = 2.0 * (1.0 - 0.3) / (2.0 - 0.3)
MASS, ARM = 0.01, 0.01
PSI = (0.2, 0.6, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
SAME = 1e-6
"""Of impacts with the same ψ and χ; radii of contact by a table of the spacing differ by 5e-7."""
BOOKED = 1e-4
"""Error of energies along the path of contact points between the states of a curve."""
SOLVED = 1e-5
"""Error of the reference, whose motion is integrated in steps."""
SOME = (0.6,)


def hit(slip: float, v: float = 0.1, friction: float = 0.3, chi: float = 1.75 * KAPPA, mass: float = MASS,
        modulus: float = 70e9, spin: float = 0.0, nu: float = 0.3, **profile: Any) -> contact1d.Run:  # fmt: skip
    """A body whose contact point moves along the plane with `slip` [m/s]."""
    kappa = 2.0 * (1.0 - nu) / (2.0 - nu)
    inertia = mass * ARM**2 / (2.0 * chi / kappa - 1.0)
    shape = {"kind": "parabola", "radius": f"{ARM} m"} | profile
    return contact1d.run(
        {
            "title": "Oblique impact",
            "bodies": {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": shape},
            "material": {"upper": {"youngs_modulus": f"{modulus} Pa", "poisson_ratio": nu}, "lower": "rigid"},
            "friction": {"coefficient": friction},
            "plate": {"mass": f"{mass} kg", "lever_arm": f"{ARM} m", "moment_of_inertia": f"{inertia!r} kg·m²"},
            "experiment": {
                "kind": "impact", "velocity": f"{v} m/s", "spin": f"{spin!r} rad/s",
                "tangential_velocity": f"{slip + ARM * spin!r} m/s",
            },
        }
    )  # fmt: skip


def restitution(psi: float, v: float = 0.1, friction: float = 0.3, **given: Any) -> Any:
    return hit(psi * friction * v / KAPPA, v, friction, **given).results["tangential_restitution"]


@pytest.mark.parametrize("psi", [psi if psi in SOME else pytest.param(psi, marks=pytest.mark.slow) for psi in PSI])
def test_a_solid_sphere_rebounds_as_by_superposition(psi: float) -> None:
    found = restitution(psi)
    assert abs(found.value + of_power(psi, 1.75 * KAPPA)) - SOLVED <= found.uncertainty <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(50))
def test_any_power_rebounds_as_by_superposition(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nu, chi, psi = rng.uniform(0.0, 0.5), rng.uniform(0.5, 3.0), 10.0 ** rng.uniform(-1.0, 1.0)
    v, friction, n = 10.0 ** rng.uniform(-3.0, 0.0), rng.uniform(0.05, 1.0), rng.uniform(1.0, 4.0)
    kappa = 2.0 * (1.0 - nu) / (2.0 - nu)
    slip = psi * friction * v / kappa
    run = hit(slip, v, friction, chi, nu=nu, spin=rng.uniform(-1.0, 1.0) * slip / ARM,
              kind="power", exponent=float(n), height="20 µm", radius="1 mm")  # fmt: skip
    found = run.results["tangential_restitution"]
    assert abs(found.value + of_power(psi, chi, Power(n, 1.0))) - SOLVED <= found.uncertainty <= 1e-3
    kinetic = run.curve.kinetic_energy
    booked = kinetic + run.curve.normal_energy + run.curve.tangential_energy + run.curve.slip_energy
    assert np.ptp(booked) <= BOOKED * kinetic[0]


@pytest.mark.parametrize(
    "given",
    [{"v": 1e-4},
     *(pytest.param(one, marks=pytest.mark.slow) for one in (
         {"friction": 0.05}, {"friction": 1.0}, {"v": 100.0}, {"mass": 1e-6}, {"modulus": 1e3}, {"modulus": 1e12},
         {"radius": "10 nm"}, {"radius": "10 m"}))],
)  # fmt: skip
def test_a_paraboloid_knows_two_numbers(given: dict[str, Any]) -> None:
    assert restitution(0.5, **given).value == pytest.approx(restitution(0.5).value, abs=SAME)


@pytest.mark.parametrize(
    "chi", [0.42, *(pytest.param(one, marks=pytest.mark.slow) for one in (0.5, 0.7, 1.0, 1.44, 2.0))]
)
def test_from_an_angle_on_the_contact_slides_throughout(chi: float) -> None:
    for psi in (1.001 * max(1.0, 4.0 * chi - 1.0), 3.0 * max(1.0, 4.0 * chi - 1.0)):
        assert restitution(psi, chi=chi).value == pytest.approx(4.0 * chi / psi - 1.0, abs=SAME)


def test_with_much_friction_nothing_slips() -> None:
    found = restitution(1e-4, friction=1e4)
    assert abs(found.value + sticking(1.75 * KAPPA, PARABOLOID)) <= found.uncertainty


def test_without_slip_at_first_it_is_a_normal_impact() -> None:
    """Spin may do that, too; backspin is as a larger velocity."""
    rolling = hit(0.0, spin=10.0)
    assert rolling.document["tangential_restitution"]["value"] is None
    assert rolling.results["rebound_spin"].value == pytest.approx(10.0, rel=1e-12)
    assert rolling.results["slip_energy"].value == pytest.approx(0.0, abs=1e-6 * 0.5 * MASS * 0.1**2)
    turned, pushed = hit(0.2, spin=-10.0), hit(0.2)
    for name in ("restitution", "contact_time", "peak_force"):
        assert rolling.results[name].value == pytest.approx(pushed.results[name].value, rel=1e-9)
    ours, theirs = (run.results["tangential_restitution"].value for run in (turned, pushed))
    assert ours == pytest.approx(theirs, abs=1e-9)
    slowed = 0.2 * (1.0 + theirs) / (2.0 * 1.75) * 2.5 / ARM
    assert turned.results["rebound_spin"].value == pytest.approx(slowed - 10.0, rel=1e-6)
    assert math.isclose(turned.results["rebound_tangential_velocity"].value, 0.1 - slowed * ARM / 2.5, rel_tol=1e-6)


@pytest.mark.parametrize("n", [2.0, *(pytest.param(n, marks=pytest.mark.slow) for n in (1.0, 3.0))])
@pytest.mark.parametrize("v", [0.1, *(pytest.param(v, marks=pytest.mark.slow) for v in (1e-3, 1.0, 10.0))])
@pytest.mark.parametrize("e", [0.8, *(pytest.param(e, marks=pytest.mark.slow) for e in (0.1, 0.4, 0.99))])
def test_a_restitution_is_that_of_its_retardation_time(n: float, v: float, e: float) -> None:
    profile = {"kind": "power", "exponent": n, "height": "20 µm", "radius": "1 mm"}
    run = contact1d.run(
        {
            "title": "Restitution",
            "bodies": {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile},
            "material": {"contact_modulus": "5 MPa"},
            "viscoelasticity": {"restitution": e},
            "plate": {"mass": f"{MASS} kg"},
            "experiment": {"kind": "impact", "velocity": f"{v} m/s"},
        }
    )
    time, found = run.results["retardation_time"].value, run.results["restitution"]
    law = KelvinVoigt(Power(n, 20e-6 * 1e3**n), time, 5e6)
    assert kelvin_voigt(law, MASS, v).restitution == pytest.approx(e, abs=SAME * (1.0 - e))
    assert abs(found.value - e) <= found.uncertainty
