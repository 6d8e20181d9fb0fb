"""The contact models of LAMMPS that grains are simulated with, what each states, and where it is compared."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from validation.references.grains import Impact, coeff_restitution, restoring, spheres, tsuji, viscoelastic

OURS = "contact1d"
"""Stands in place of a model in the names of the program's own rows."""
HERTZ = "hertz 1.3333333333333333"
"""k = 4/3, E* = 1."""
WORK_OF_ADHESION = 1e-3
"""W of the decks' adhesive spheres."""
SPHERES = spheres(WORK_OF_ADHESION)


@dataclass(frozen=True)
class Model:
    """A damped one.

    Attributes:
        damping: as in the manual.
        force: what the model states, solved by its coefficient, and by whether it is limited.
        limited: whether it has limit_damping.
    """

    damping: str
    force: Callable[[float, bool], Impact]
    limited: bool = False

    @property
    def name(self) -> str:
        """The keywords."""
        return self.damping + " limit_damping" * self.limited

    @property
    def words(self) -> str:
        """Of `pair_coeff`, with {} for the coefficient."""
        return f"{HERTZ} {{}} damping {self.name}"

    def law(self, coefficient: float) -> Impact:
        """What the model states."""
        return self.force(coefficient, self.limited)


VISCOELASTIC = Model("viscoelastic", viscoelastic)
RESTITUTION = Model("coeff_restitution", lambda e, limited: restoring(coeff_restitution(e), limited))
TSUJI = Model("tsuji", lambda e, limited: restoring(tsuji(e), limited))
LIMITED, LIMITED_RESTITUTION, LIMITED_TSUJI = (
    replace(model, limited=True) for model in (VISCOELASTIC, RESTITUTION, TSUJI)
)

ELASTIC = {"hertz": f"{HERTZ} 0.0 damping velocity", "hertz/material": "hertz/material 1.82 0.0 0.3 damping velocity"}
DAMPED = (VISCOELASTIC, LIMITED)
BY_RESTITUTION = (RESTITUTION, LIMITED_RESTITUTION, TSUJI, LIMITED_TSUJI)
FITTED = (VISCOELASTIC, LIMITED, RESTITUTION)
NUMBERS = (0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)
"""A = τ/(m²/(E*² R v))^(1/5) of a Kelvin-Voigt body."""
TIMED = (0.1, 0.3, 1.0)
"""Those whose contact time and largest force are compared, and in the middle of a decade of velocities."""
ASKED = (0.9, 0.6, 0.3)
"""Coefficients of restitution that a model is given."""
DECADE = (10.0**-0.5, 1.0, 10.0**0.5)
"""Velocities; A grows as v^(1/5)."""
NEAREST: Mapping[str, tuple[float, float, float]] = {
    VISCOELASTIC.name: (0.95, 0.88, 0.68), LIMITED.name: (0.97, 0.94, 0.89), RESTITUTION.name: (0.83, 0.61, 0.28),
}  # fmt: skip
"""η over 2 E* τ/m, and e, with the smallest largest error of e over a decade around each of TIMED."""
ADHESIVE = {"jkr": "jkr 1.82 0.0 0.3 0.0005 damping velocity", "dmt": "dmt 1.82 0.0 0.3 0.0005 damping velocity"}
STRONGER = 1.527
"""W over that of the spheres with which `jkr` loses the energy of JKR: (7.0922/3.5026)^(3/5)."""
NEAREST_JKR = f"jkr 1.82 0.0 0.3 {0.0005 * STRONGER:.7g} damping velocity"
RIGID = "hertz/material 2.0 0.0 0.3 damping velocity"
"""The wall of a sphere with E = 1 that acts as a rigid one."""
ON_WALL = "jkr 1.0 0.0 0.3 0.0005 damping velocity"
MEASURED = 1.1
"""Of OVER_STICKING: from the restitution at it the sticking velocity follows."""
OVER_STICKING = (0.8, 1.1, 1.5, 3.0, 10.0)
"""Velocities over that below which spheres of JKR stick."""
DRAWN = (0.8, 0.5, 0.2, 0.0, -0.2, -0.35, -0.4, -0.5, -0.6, -0.7)
"""Overlaps over (π²W²R/E*²)^(1/3) while the spheres are drawn apart."""


def coefficient(model: Model, place: int) -> float:
    """The nearest coefficient at TIMED[place] and velocity 1."""
    near = NEAREST[model.name][place]
    return near if model is RESTITUTION else round(2.0 * TIMED[place] * near, 6)


def at_number(A: float) -> str:
    """Where a row of a Kelvin-Voigt body is measured."""
    return f"A = {A:g}"


def row_name(model: str, at: str, quantity: str) -> str:
    """By which a page finds a row."""
    return f"{model}{', ' * bool(at)}{at}: {quantity.replace('_', ' ')}"


def near_name(model: Model, A: float, v: float) -> str:
    """The same with the nearest coefficient."""
    return row_name(f"nearest {model.name}", f"{at_number(A)}, v = {v:.3g}", "restitution")
