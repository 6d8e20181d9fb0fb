"""The declarations of every kind of experiment, and displacements that a scene gives as a span or as cycles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import (
    CycleCount,
    Displacement,
    Length,
    StepCount,
    Table,
)

Method = Literal["quasistatic", "dynamic"]
UNPULLED = "only a slide is pulled through a spring"
UNTIMED = "its states have no time, which a body that relaxes needs"
UNMOVED = "it has no tangential displacement, so that friction has no effect"
TIMELESS = "it is quasi-static, each load step in equilibrium"
"""Reasons for which an experiment excludes an effect."""


ANY_METHOD = (
    '"quasistatic" (equilibrium) or "dynamic" (in time); absent: "dynamic" with [plate], [damping] or [noise], '
    'else "quasistatic"'
)


class Span(Table):
    """Evenly spaced displacements from one value to another, by default there and back."""

    from_: Displacement = Field(alias="from")
    """displacement at the start"""
    to: Displacement
    """displacement at the turning point"""
    steps: StepCount
    """number of steps of one leg"""
    return_: bool = Field(default=True, alias="return")
    """whether to go back to the start as well"""

    @model_validator(mode="after")
    def _ends_differ(self) -> Self:
        """Return this span; raise PydanticCustomError where both ends are equal."""
        if self.from_ == self.to:
            raise PydanticCustomError("scene", '"from" and "to" must differ')
        return self

    def values(self) -> list[float]:
        """Return the displacements [LU] in order: steps + 1 forward, then `steps` back, unless the return is left out.

        The turning point is there once.
        """
        n = self.steps
        between = [(self.from_ * (n - i) + self.to * i) / n for i in range(1, n)]
        forward = [self.from_, *between, self.to]
        return forward + forward[-2::-1] if self.return_ else forward


class Cycles(Table):
    """Closed cycles between two displacements ±u_m in equal load steps, after the initial loading from 0 to u_m."""

    amplitude: Length
    """largest displacement u_m to either side"""
    number: CycleCount
    """whole cycles, each from u_m to −u_m and back"""
    points: CycleCount
    """load steps in one cycle, a multiple of 4: a quarter of them is the initial loading"""

    def values(self) -> list[float]:
        """Return the displacements [LU] in order: 0, points/4 steps to u_m, then `points` steps of each cycle.

        The last one is u_m. There are 1 + points/4 + number·points of them; 0 and ±u_m are exact. `points` must be a
        multiple of 4, which is checked elsewhere; ZeroDivisionError for fewer than 4.
        """
        n = self.points // 4
        steps = range(-n, self.number * self.points + 1)
        return [self.amplitude * (abs(i % self.points / n - 2.0) - 1.0) for i in steps]


def with_article(kind: str) -> str:
    """Return the kind of an experiment with its article: "a load", "an impact"."""
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _values(listed: Sequence[float] | Span | Cycles) -> list[float]:
    """Return the displacements [LU] of a list, a span or cycles, in order, as a new list."""
    return list(listed) if isinstance(listed, Sequence) else listed.values()


def _for_each(given: tuple[float, ...] | float | None, count: int) -> list[float]:
    """Return a list with a value for each of `count` points: a number repeated, a tuple as it is; [] of None.

    The length of a tuple is not compared with `count`.
    """
    return [] if given is None else list(given) if isinstance(given, tuple) else [given] * count


class Kind(Table):
    """The experiment. Each kind declares the properties that other modules use.

    Attributes:
        only_method: the only method that is possible; None: the key `method` or the effects determine it.
        excludes: effects that are not possible with any method, and why.
        needs: effects that are necessary with any method.
        needs_in_time: effects that are necessary with the dynamic method.
        load_key: the key of the normal force, which may be tensile (not a preload) if the bodies attract.
        finds_pull_off: whether the results have F_A and a₀.
        history_is_given: the scene prescribes the loading history, so that there is no search and states are unique.
        motion_is_result: the motion itself is examined, so that the scene exists in time only and gives the drag.
        is_retracted: the plate is retracted through a spring along z.
        is_massless: the mass of a particle has no effect; a plate that moves has all the mass.
        goes_along: the scene also prescribes positions along x, on a plane, and has no other method.
    """

    only_method: ClassVar[Method | None] = None
    excludes: ClassVar[Mapping[str, str]] = {
        "cantilever": UNPULLED, "friction": UNMOVED, "viscoelasticity": UNTIMED,
    }  # fmt: skip
    needs: ClassVar[tuple[str, ...]] = ()
    needs_in_time: ClassVar[tuple[str, ...]] = ("damping", "plate")
    load_key: ClassVar[str | None] = None
    finds_pull_off: ClassVar[bool] = False
    history_is_given: ClassVar[bool] = False
    motion_is_result: ClassVar[bool] = False
    is_massless: ClassVar[bool] = False
    goes_along: ClassVar[bool] = False

    @property
    def given_method(self) -> Method | None:
        """The only possible method of the experiment, "quasistatic" or "dynamic", else the one that the scene gives.

        None where it gives none, so that the method follows from the effects.
        """
        return self.only_method or getattr(self, "method", None)

    @property
    def is_oblique(self) -> bool:
        """Whether a free body also moves along x on a plane: an impact with tangential velocity or spin; else False."""
        return False

    @property
    def is_retracted(self) -> bool:
        """Whether the plate is retracted along z at a given velocity: a pull-off that has one; False for all others."""
        return False

    @property
    def retraction_stiffness(self) -> float:
        """Stiffness [FU/LU] ≥ 0 of the spring that retracts the plate along z in a pull-off, as the scene gives it.

        0 where it gives none, and for all other experiments.
        """
        return 0.0

    @property
    def lasts(self) -> float | None:
        """Duration [TU] that the scene prescribes: of a hold, and of a history from its first point to its last.

        None for all other experiments, whose motion ends in equilibrium or with the drive.
        """
        return None

    @property
    def compression(self) -> float | None:
        """Normal force [FU] ≥ 0 that presses the bodies together: as given, and 0 where that is tensile.

        The largest one of a tangential path or a history under forces; the preload of a pull-off. None where
        displacements are prescribed instead, and of a path and an impact.
        """
        force = getattr(self, self.load_key or "", None)
        return None if force is None else max(force, 0.0)

    def places(self) -> list[float]:
        """Return the prescribed normal displacements [LU] in order, compression positive.

        Those of a path, of a tangential path (one for each load step), of a hold, and of the points of a history. Empty
        where these give forces, and for all other experiments.
        """
        return []

    @property
    def excursion(self) -> float:
        """Largest magnitude [LU] ≥ 0 of the displacement along x; 0 for all but a slide and a tangential path.

        That of the driven end in a slide, from its start; that of the upper body in a tangential path.
        """
        return 0.0
