"""The contact models of LAMMPS that grains are simulated with, what each states, and where it is compared."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace

from validation.references.grains import Impact, coeff_restitution, restoring, tsuji, viscoelastic
from validation.references.impact import Adhesive
from validation.references.relaxing import sphere
from validation.row import tables_beside

OURS = "contact1d"
"""Stands in place of a model in the names of the program's own rows."""
HERTZ = "hertz 1.3333333333333333"
"""k = 4/3, E* = 1."""
WORK_OF_ADHESION = 1e-3
"""W of the decks' adhesive spheres."""
SPHERES = Adhesive(sphere(1.0), WORK_OF_ADHESION)
"""By JKR, with E* = R = 1."""


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

DAMPED = (VISCOELASTIC, LIMITED)
BY_RESTITUTION = (RESTITUTION, LIMITED_RESTITUTION, TSUJI, LIMITED_TSUJI)
FITTED = (VISCOELASTIC, LIMITED, RESTITUTION)
GIVEN = SimpleNamespace(**tables_beside(__file__))
"""What the decks are run with."""
DECADE = (10.0**-0.5, 1.0, 10.0**0.5)
"""Velocities; A grows as v^(1/5)."""
STRONGER = 1.527
"""W over that of the spheres with which `jkr` loses the energy of JKR: (7.0922/3.5026)^(3/5)."""
NEAREST_JKR = f"jkr 1.82 0.0 0.3 {0.0005 * STRONGER:.7g} damping velocity"
MEASURED = 1.1
"""Of GIVEN.over: from the restitution at it the sticking velocity follows."""


def coefficient(model: Model, place: int) -> float:
    """The nearest coefficient at GIVEN.timed[place] and velocity 1."""
    near: float = GIVEN.nearest[model.name][place]
    return near if model is RESTITUTION else round(2.0 * GIVEN.timed[place] * near, 6)


def at_number(A: float) -> str:
    """Where a row of a Kelvin-Voigt body is measured."""
    return f"A = {A:g}"


def at_psi(psi: float) -> str:
    """Where a row of an oblique impact is measured."""
    return f"ψ = {psi:g}"


def at_step(step: float) -> str:
    """Where a row of `mdr` is measured, by the increment of the overlap or the timestep."""
    return f"step {step:g}"


def at_velocity(over: float) -> str:
    """Where a row of adhesive spheres is measured, by the velocity over that of sticking."""
    return f"v = {over:g} v_s"


def row_name(model: str, at: str, quantity: str) -> str:
    """By which a page finds a row."""
    return f"{model}{', ' * bool(at)}{at}: {quantity.replace('_', ' ')}"


def near_name(model: Model, A: float, v: float) -> str:
    """The same with the nearest coefficient."""
    return row_name(f"nearest {model.name}", f"{at_number(A)}, v = {v:.3g}", "restitution")
