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

        0 and ±u_m are exact.
        """
        n = self.points // 4
        steps = range(-n, self.number * self.points + 1)
        return [self.amplitude * (abs(i % self.points / n - 2.0) - 1.0) for i in steps]


def _values(listed: Sequence[float] | Span | Cycles) -> list[float]:
    """Return the displacements [LU] of a list, a span or cycles, in order."""
    return list(listed) if isinstance(listed, Sequence) else listed.values()


def _for_each(given: tuple[float, ...] | float | None, count: int) -> list[float]:
    """Return a value for each of `count` points, by a list as it is, or by one number for all; empty for None."""
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
        """The only possible method, else the one that the scene names; None where it follows from the effects."""
        return self.only_method or getattr(self, "method", None)

    @property
    def is_retracted(self) -> bool:
        """Whether the plate is retracted along z at a given velocity; False by default."""
        return False

    @property
    def retraction_stiffness(self) -> float:
        """Stiffness [FU/LU] of the spring that retracts the plate along z; 0, as by default, where none is given."""
        return 0.0

    @property
    def lasts(self) -> float | None:
        """Duration [TU] of the motion that the scene prescribes.

        None, as by default, where the motion ends in equilibrium or with the drive.
        """
        return None

    @property
    def compression(self) -> float | None:
        """Normal force [FU] that presses the bodies together, 0 for a tensile one.

        None where displacements are prescribed.
        """
        force = getattr(self, self.load_key or "", None)
        return None if force is None else max(force, 0.0)

    def places(self) -> list[float]:
        """Return the prescribed displacements [LU] in order, compression positive.

        Empty, as by default, without any.
        """
        return []

    @property
    def excursion(self) -> float:
        """Largest tangential displacement [LU] ≥ 0 of the bodies against each other; 0, as by default, without one."""
        return 0.0
