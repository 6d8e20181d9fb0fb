"""Claim: between the stiff sphere of DMT and the soft one of JKR lies Maugis and Dugdale's, with both as its limits,
and the map of adhesion names a theory that holds there.

Limits with their rates; the reference's own solution of the same contact. The map's second source is Maugis and
Dugdale at the same Tabor number, and Hertz.
"""

import math

import numpy as np
import pytest

from contact1d.analysis.theory.adhesion import (
    LAMBDA_OVER_TABOR,
    LENNARD_JONES_STRESS,
    Dmt,
    MaugisDugdale,
    Theory,
    valid_theory,
)
from contact1d.analysis.theory.indenters import PowerLaw
from validation.references.maugis import Reduced
from validation.references.mdr import ReducedContact

ROUND_OFF = 1e-12
ROOT = 1e-11
"""Relative: the root of the adhesion equation, through differences of terms of order one."""
RATE = 0.06
"""Relative, of the change of an error between two lambda: the next order of the expansion."""
RADIUS, MODULUS, ADHESION, RANGE = 3.0, 7.0, 0.2, 0.01
PLACES = np.array([0.3, 1.0, 3.0])
A_UNIT = math.cbrt(math.pi * ADHESION * RADIUS**2 / (4.0 / 3.0 * MODULUS))
N_UNIT = math.pi * ADHESION * RADIUS
D_UNIT = A_UNIT**2 / RADIUS
UNIT = 1.0, 0.75, 1.0 / math.pi
"""R, E* and W with which a is A, F is N and d is D."""
JKR, DMT = PowerLaw.sphere(*UNIT), Dmt(*UNIT)


def of_lambda(transition: float) -> MaugisDugdale:
    return MaugisDugdale.reduced(transition / LAMBDA_OVER_TABOR)


def off(contact: MaugisDugdale, limit: PowerLaw | Dmt) -> tuple[float, float]:
    """Largest differences of F and d at PLACES."""
    force = [abs(contact.force(a) - limit.force(a)) for a in PLACES]
    return max(force), max(abs(contact.displacement(a) - limit.displacement(a)) for a in PLACES)


@pytest.mark.parametrize("transition", [0.05, 1.0, 3.0])
def test_maugis_is_that_of_the_reference(transition: float) -> None:
    """By t = arcsec(c/a), with units; `test_reference_bodies` holds it against elements."""
    stress = 0.5 * transition * math.cbrt(math.pi * ADHESION * (4.0 / 3.0 * MODULUS) ** 2 / RADIUS)
    contact, exact = MaugisDugdale(RADIUS, MODULUS, ADHESION, ADHESION / stress), Reduced(transition)
    assert contact.transition == pytest.approx(transition, rel=ROUND_OFF)
    for place in PLACES:
        a, state = float(place * A_UNIT), exact.of_radius(place)
        assert contact.force(a) == pytest.approx(N_UNIT * state.load, rel=ROOT, abs=ROOT * N_UNIT)
        d = a**2 / RADIUS - 2.0 * stress * A_UNIT * math.sqrt(state.c**2 - place**2) / MODULUS
        assert contact.displacement(a) == pytest.approx(d, rel=ROOT, abs=ROOT * D_UNIT)
    assert contact.pull_off_force() == pytest.approx(-N_UNIT * exact.critical.load, rel=ROOT)
    assert contact.zero_load_radius() == pytest.approx(A_UNIT * exact.free.a, rel=ROOT)
    assert contact.critical_radius() == pytest.approx(A_UNIT * exact.critical.a, rel=1e-6)  # a flat minimum


def test_dmt_and_jkr_in_reduced_units() -> None:
    """N = F/(pi W R) over A = a/(pi W R^2/K)^(1/3): A^3 - A sqrt(6A) of JKR, A^3 - 2 of DMT."""
    jkr, dmt = PowerLaw.sphere(RADIUS, MODULUS, ADHESION), Dmt(RADIUS, MODULUS, ADHESION)
    for place in PLACES:
        assert jkr.force(place * A_UNIT) == pytest.approx(N_UNIT * (place**3 - place * math.sqrt(6.0 * place)))
        assert dmt.force(place * A_UNIT) == pytest.approx(N_UNIT * (place**3 - 2.0))
        assert dmt.displacement(place * A_UNIT) == pytest.approx(D_UNIT * place**2, rel=ROUND_OFF)
    assert dmt.zero_load_radius() == pytest.approx(A_UNIT * math.cbrt(2.0), rel=ROUND_OFF)


def test_the_errors_of_jkr_fall_as_the_square_and_of_dmt_as_the_power_three_halves() -> None:
    contacts = [of_lambda(value) for value in (30.0, 300.0)]
    curves, shifts = zip(*(off(contact, JKR) for contact in contacts), strict=True)
    pulls = [contact.pull_off_force() - 1.5 for contact in contacts]
    radii = [6.0 ** (1.0 / 3.0) - contact.zero_load_radius() for contact in contacts]
    ends = [JKR.displacement(JKR.fixed_grips_radius()) - c.displacement(c.fixed_grips_radius()) for c in contacts]
    for errors in (curves, shifts, pulls, radii, ends):
        assert abs(errors[0]) < 2e-2
        assert errors[0] == pytest.approx(100.0 * errors[1], rel=RATE)
    pulls = [2.0 - of_lambda(value).pull_off_force() for value in (1e-5, 1e-3)]
    assert 0.0 < pulls[1] < 1e-4
    assert pulls[1] == pytest.approx(1e3 * pulls[0], rel=RATE)
    tiny = of_lambda(1e-6)
    assert max(off(tiny, DMT)) < 5e-3  # A sqrt(lambda), from the ring inside a
    assert tiny.zero_load_radius() == pytest.approx(2.0 ** (1.0 / 3.0), abs=1e-3)


def test_a_pull_off_force_is_the_lowest_load_and_a_radius_that_of_its_force() -> None:
    for contact in map(of_lambda, (0.01, 0.3, 1.0, 10.0)):
        lowest = min(contact.force(place) for place in np.linspace(0.0, 2.0, 401))
        assert -contact.pull_off_force() <= lowest
        assert -contact.pull_off_force() == pytest.approx(lowest, abs=1e-4)  # the grid of the scan
        assert contact.force(contact.contact_radius(0.7)) == pytest.approx(0.7, rel=ROOT)
        assert abs(contact.force(contact.zero_load_radius())) < ROOT
        assert contact.force(0.0) == pytest.approx(contact.force(1e-9), abs=1e-8)  # first touch
        with pytest.raises(ValueError, match="exceeds the pull-off"):
            contact.contact_radius(-contact.pull_off_force() - 1e-6)


def test_lambda_of_tabor() -> None:
    """sigma_0 of the 9-3 law: (8W/3z)[(z/h)^3 - (z/h)^9] is highest at h = 3^(1/6) z; lambda/mu is 1.157 with z_0."""
    heights = np.linspace(1.0, 2.0, 100001)
    law = 8.0 / 3.0 * (heights**-3 - heights**-9)
    assert float(np.max(law)) == pytest.approx(LENNARD_JONES_STRESS, rel=1e-9)
    contact = MaugisDugdale(RADIUS, MODULUS, ADHESION, RANGE)
    assert contact.tabor == pytest.approx((RADIUS * ADHESION**2 / (MODULUS**2 * RANGE**3)) ** (1 / 3), rel=ROUND_OFF)
    surface = MaugisDugdale(RADIUS, MODULUS, ADHESION, RANGE / LENNARD_JONES_STRESS)
    assert surface.transition / contact.tabor == pytest.approx(1.157, abs=5e-4)
    for sphere, factor in ((PowerLaw.sphere, 3.898), (Dmt, 3.246)):
        a = sphere(RADIUS, MODULUS, ADHESION).zero_load_radius()
        stretch = ReducedContact(math.sin, MODULUS, ADHESION).stretch(a)
        assert stretch / RANGE == pytest.approx(factor * contact.tabor, rel=2e-4)  # printed with four digits


@pytest.mark.parametrize(
    ("tabor", "load", "theory"),
    [
        (1e-3, -1.99, Theory.RIGID),
        (1e-3, -2.01, Theory.APART),
        (0.0177, 0.0, Theory.RIGID),  # 5 % of the range are Hertz's compression under 2πWR at μ = 0.01779
        (0.0179, 0.0, Theory.DMT),
        (0.08, 39.0, Theory.DMT),
        (0.08, 41.0, Theory.HERTZ),
        (1.0, -1.57, Theory.MAUGIS),
        (1.0, -1.59, Theory.APART),  # its pull-off force is 1.582
        (6.0, -1.499, Theory.JKR),
        (6.0, -1.501, Theory.MAUGIS),  # JKR holds no more than 3/2, a finite range a little
        (50.0, 2519.9, Theory.JKR),  # [3 + sqrt(6N+9)]/N is 5 % at 2520
        (50.0, 2520.1, Theory.HERTZ),
    ],
)
def test_zones(tabor: float, load: float, theory: Theory) -> None:
    verdict = valid_theory(tabor, load)
    assert verdict.theory is theory
    assert any(character.isdigit() for character in verdict.reason)


def test_what_is_refused() -> None:
    for wrong, words in (
        (lambda: MaugisDugdale(*UNIT, 0.0), "range_of_attraction"),
        (lambda: of_lambda(1.0).force(-0.1), "negative"),
        (lambda: DMT.contact_radius(-2.02), "exceeds"),
        (lambda: valid_theory(math.nan, 1.0), "positive"),
    ):
        with pytest.raises(ValueError, match=words):
            wrong()
