"""Claim: beside a sphere that an interaction holds stands the theory that the Tabor parameter μ calls for.

References: the limits of Maugis and Dugdale, JKR's F_A = 1.5 πWR and a₀³ = 4.5 πWR²/E*, DMT's 2 and 1.5.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from contact1d import read_scene
from contact1d.workflow.body.cases import Case
from contact1d.workflow.body.theory import applying, tabor
from contact1d.workflow.units import Quantity
from tests.scenes import chains

ROUND_OFF = 1e-12
"""Relative: a few operations."""
LIMIT = 0.08
"""Relative, of Maugis and Dugdale at μ = 4 beside JKR, and at 0.1 beside DMT (`analysis.theory.adhesion`)."""
R = 100.0
PULL = {"kind": "pull_off", "preload": 2.0}


def said(case: Case) -> dict[str, float]:
    (form,) = applying(case)
    return dict(form.values(case))


def of_interaction(mu: float, **bodies: Any) -> Case:
    """Two chains of which the implied W is such that the Tabor parameter is `mu`."""
    asked = read_scene(chains(R, experiment=PULL, bodies={"reduction": "mdr"} | bodies))
    one = Case(asked, {"work_of_adhesion": Quantity(1.0, 0.0, "FU/LU")})
    at_one = tabor(one)
    work = 1.0 if at_one is None else (mu / at_one) ** 1.5
    return Case(asked, {"work_of_adhesion": Quantity(work, 0.0, "FU/LU")})


@pytest.mark.parametrize(("mu", "name"), [(20.0, "JKR"), (1.0, "Maugis-Dugdale"), (0.05, "DMT")])
def test_tabor_s_number_says_which_theory_holds(mu: float, name: str) -> None:
    case = of_interaction(mu)
    assert tabor(case) == pytest.approx(mu, rel=ROUND_OFF)
    (form,) = applying(case)
    assert form.name == name
    assert f"{mu:.3g}" in form.applies(case)


def test_maugis_and_dugdale_lie_between_the_limits() -> None:
    for mu, force, radius in ((4.0, 1.5, 4.5), (0.1, 2.0, 1.5)):
        case = of_interaction(mu)
        W, E = float(case.quantities["work_of_adhesion"]), case.contact_modulus
        values = said(case)
        assert values["adhesion_force"] == pytest.approx(force * math.pi * W * R, rel=LIMIT)
        assert values["zero_load_radius"] == pytest.approx((radius * math.pi * W * R**2 / E) ** (1.0 / 3.0), rel=LIMIT)


def test_the_paper_s_own_contact_stands_beside_none() -> None:
    assert not applying(of_interaction(1.0, reduction="geike_popov"))
