"""The experiments of a scene: load, path, pull_off, slide, tangential, hold, history, impact.

Each declares its keys, what it needs and what it excludes: the rules read nothing else of it.

A prescribed path from d₀ to d₁ in n steps holds d_i = (d₀ (n − i) + d₁ i)/n for i = 0…n, and back in the same places.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Annotated, Literal

from annotated_types import MinLen
from pydantic import Discriminator, Field

from contact1d.workflow.scene.kinds import (
    ANY_METHOD,
    TIMELESS,
    UNMOVED,
    UNPULLED,
    UNTIMED,
    Cycles,
    Kind,
    Method,
    Span,
    _for_each,
    _values,
)
from contact1d.workflow.scene.quantities import (
    Compression,
    CompressionOrNone,
    CycleCount,
    Displacement,
    DriveVelocity,
    Duration,
    Force,
    Length,
    Listed,
    LoadingRate,
    OneOrMore,
    RepeatCount,
    Spin,
    StepCount,
    Stiffness,
    Table,
    Time,
    Velocity,
    allowed_by,
)

AnyMethod = Annotated[Method | None, Field(description=ANY_METHOD)]


Displacements = Listed[Displacement] | Span


class Load(Kind):
    """Equilibrium under a normal force."""

    load_key = "force"

    kind: Literal["load"]
    """equilibrium under a force"""
    force: Force
    """normal force on the upper body, compression positive"""
    method: AnyMethod = None


class Path(Kind):
    """Prescribed displacements of the upper body."""

    excludes = {
        **Kind.excludes,
        "plate": "a path prescribes the plate's displacement, so the plate has no motion of its own",
    }
    needs_in_time = ("damping",)
    finds_pull_off = True
    history_is_given = True

    kind: Literal["path"]
    """prescribed displacements"""
    displacements: Displacements
    """displacements of the upper body, compression positive: a list, or a table for evenly spaced ones"""
    start: Literal["approach", "contact"] = "approach"
    """branch of the first point where adhesion has two: approach from afar, or unloading from the largest displacement
    """
    method: AnyMethod = None

    def places(self) -> list[float]:
        """Return the displacements [LU] of the upper body, compression positive, in the order of the load steps.

        Those of a list as given; of a span from its start to its turning point, which is there once, and back unless
        the scene leaves that out.
        """
        return _values(self.displacements)


class PullOff(Kind):
    """Compression by a preload, then unloading up to pull-off."""

    load_key = "preload"
    finds_pull_off = True

    kind: Literal["pull_off"]
    """compress by the preload, then unload up to pull-off"""
    preload: Compression
    """compressive force F_D before the pull"""
    loading_rate: LoadingRate | None = None
    """with [noise]: rate at which the load decreases until the bodies separate"""
    velocity: Velocity | None = None
    """with [noise], in place of loading_rate: velocity of the far end of a spring that retracts the plate; with
    adhesion.rate that of the plate itself
    """
    stiffness: Stiffness | None = None
    """with velocity: stiffness of that spring; absent: that of the contact at zero load"""
    repeats: RepeatCount | None = None
    """with [noise]: number of repeats, each with the next seed; absent: 1"""
    cycles: CycleCount | None = None
    """number of times that the bodies are pressed together and pulled off, without [noise]; results are those of the
    last; absent: 1
    """
    method: AnyMethod = None

    @property
    def is_retracted(self) -> bool:
        """Whether the plate is retracted along z at a given velocity, its own or that of the far end of a spring."""
        return self.velocity is not None

    @property
    def retraction_stiffness(self) -> float:
        """Stiffness [FU/LU] of the spring that retracts the plate; 0 where none is given, for that of the contact."""
        return self.stiffness or 0.0


class Leg(Table):
    """A part of a slide's path, written [velocity, distance]."""

    as_list = True

    velocity: DriveVelocity
    """velocity of the driven end; negative: back, 0: it rests"""
    distance: Length
    """distance of the driven end; at velocity 0 the time that cantilever.velocity takes for it"""


class Slide(Kind):
    """Sliding under a normal force, pulled through the cantilever; always dynamic."""

    one_of = ((("distance", "path"), "give a distance (LU), or a path = [[velocity, distance], …]; not both"),)
    only_method = "dynamic"
    excludes = {
        "adhesion": "it is that of a rigid plane, which cannot drag the upper body",
        "friction": "its friction results from the interaction of the particles",
        "viscoelasticity": "it is that of a body on a rigid plane, which cannot drag the upper body",
    }
    needs = ("horizontal", "damping", "plate", "cantilever")
    load_key = "normal_force"
    history_is_given = True
    motion_is_result = True

    kind: Literal["slide"]
    """sliding under a normal force, pulled by the cantilever; always dynamic"""
    normal_force: Force
    """normal force during sliding, compression positive; 0 or tensile where bodies attract each other"""
    distance: Length | None = None
    """distance of the driven end of the cantilever at cantilever.velocity; absent with a path"""
    path: Listed[Leg] | None = None
    """legs [velocity, distance] of the driven end in place of one distance: a negative velocity moves it back, at 0 it
    rests for the time that cantilever.velocity takes for the distance
    """

    def legs(self, velocity: float) -> tuple[Leg, ...]:
        """Return the legs (velocity [LU/TU], distance [LU] > 0) of the driven end: the given path.

        Else one leg of the given distance at `velocity` [LU/TU], which a path does not use. ValidationError without
        both.
        """
        return self.path or (Leg(velocity=velocity, distance=self.distance or 0.0),)

    @property
    def excursion(self) -> float:
        """Largest displacement [LU] ≥ 0 of the driven end to either side of its start: by the distance, or the path."""
        ends = accumulate(leg.distance * ((leg.velocity > 0.0) - (leg.velocity < 0.0)) for leg in self.path or ())
        return max([self.distance or 0.0, *map(abs, ends)])


class Tangential(Kind):
    """Normal load, then tangential displacement, with Coulomb's friction on a rigid plane."""

    one_of = (
        (
            ("normal_force", "normal_displacement"),
            "give a normal_force (FU) or a normal_displacement (LU), one for all points or one for each; not both",
        ),
        (("displacements", "cycles"), "give displacements (LU), or cycles = { amplitude, number, points }; not both"),
    )
    only_method = "quasistatic"
    excludes = {
        "adhesion": "whether shear peels an adhesive edge or makes it slip is a criterion of its own (Savkoor and "
        "Briggs), which neither JKR nor Mindlin has",
        "neighbours": "friction depends on the loading history, and a minimiser, which such springs need, has none",
        "viscoelasticity": UNTIMED,
        "damping": TIMELESS,
        "noise": TIMELESS,
        "plate": f"{TIMELESS}; a plate with inertia would oscillate about it, and friction depends on this history",
        "cantilever": UNPULLED,
    }
    needs = ("friction",)
    history_is_given = True
    goes_along = True

    kind: Literal["tangential"]
    """normal load, then tangential displacement with friction"""
    normal_force: OneOrMore[Compression, CompressionOrNone] | None = None
    """compressive force: one, or one for each of the displacements"""
    normal_displacement: OneOrMore[Displacement, Displacement] | None = None
    """in place of the force: displacement in normal direction, compression positive; one, or one for each of the
    displacements
    """
    displacements: Displacements | None = None
    """tangential displacements, from the position 0 at which the load is applied: a list, or a table for evenly spaced
    ones
    """
    cycles: Cycles | None = None
    """in place of displacements: closed cycles along x between two displacements ±u_m"""

    @property
    def compression(self) -> float | None:
        """The largest normal force [FU] ≥ 0 of all load steps, compression positive; None without forces."""
        return max(_for_each(self.normal_force, 1), default=None)

    def places(self) -> list[float]:
        """Return the normal displacement [LU], compression positive, of each load step; a single one is repeated.

        Empty where forces are given.
        """
        return _for_each(self.normal_displacement, len(self.along()))

    def along(self) -> list[float]:
        """Return the displacement along x [LU] of each load step, of the cycles, the list or the span; signed."""
        return _values(self.cycles or self.displacements or ())

    def normal_forces(self) -> list[float]:
        """Return the normal force [FU], compression positive, of each load step; a single one is repeated.

        Empty where displacements are given.
        """
        return _for_each(self.normal_force, len(self.along()))

    @property
    def excursion(self) -> float:
        """Largest magnitude [LU] of the tangential displacements of all load steps, ≥ 0."""
        return max(map(abs, self.along()))


class Hold(Kind):
    """A displacement or a normal force, held for a time; always dynamic."""

    one_of = ((("displacement", "force"), "give a displacement (LU) or a force (FU); not both"),)
    only_method = "dynamic"
    needs = ("damping",)
    load_key = "force"

    kind: Literal["hold"]
    """hold a displacement or a force for a time; always dynamic"""
    displacement: Displacement | None = None
    """displacement held, compression positive"""
    force: Force | None = None
    """in place of the displacement: normal force held, compression positive; needs [plate]"""
    duration: Duration
    """how long it is held"""

    @property
    def lasts(self) -> float:
        """The duration [TU] for which the displacement or force is held."""
        return self.duration

    def places(self) -> list[float]:
        """Return the one displacement [LU] that is held, compression positive; empty where a force is held."""
        return _for_each(self.displacement, 1)


class Moment(Table):
    """A point of a history, written [time, displacement]."""

    as_list = True

    time: Time
    """time; each is later than the one before"""
    displacement: Displacement
    """displacement then, compression positive"""


class LoadedMoment(Table):
    """A point of a history, written [time, force]."""

    as_list = True

    time: Time
    """time; each is later than the one before"""
    force: CompressionOrNone
    """compressive force then"""


class History(Kind):
    """Displacement or force over time, on a rigid plane."""

    one_of = (
        (("displacement", "force"), "give displacement = [[time, displacement], …] or force = [[time, force], …]"),
    )
    only_method = "quasistatic"
    excludes = {
        "cantilever": UNPULLED,
        "friction": UNMOVED,
        "neighbours": "it is one of springs that know nothing of their neighbours",
        "damping": TIMELESS,
        "noise": TIMELESS,
        "plate": "a history prescribes the plate's displacement or force, so the plate has no motion of its own",
    }
    history_is_given = True
    is_massless = True

    kind: Literal["history"]
    """displacement or force over time"""
    displacement: Annotated[tuple[Moment, ...], Field(strict=False), MinLen(2)] | None = None
    """points [time, displacement], with linear change between them"""
    force: Annotated[tuple[LoadedMoment, ...], Field(strict=False), MinLen(2)] | None = None
    """in place of the displacement: points [time, force], with linear change between them"""
    steps: StepCount | None = None
    """load steps of each leg; absent: by accuracy.tolerance"""

    @property
    def times(self) -> list[float]:
        """Times [TU] of the points of the history, of displacements or of forces, in the order of the scene."""
        return [point.time for point in self.displacement or self.force or ()]

    @property
    def lasts(self) -> float:
        """Duration [TU] from the first point to the last."""
        return self.times[-1] - self.times[0]

    @property
    def compression(self) -> float | None:
        """The largest force [FU] ≥ 0 of the points, compression positive; None where displacements are given."""
        return max((point.force for point in self.force or ()), default=None)

    def places(self) -> list[float]:
        """Return the displacements [LU] of the points, compression positive; empty where forces are given."""
        return [point.displacement for point in self.displacement or ()]


class Impact(Kind):
    """A body that hits the rigid plane; always dynamic."""

    only_method = "dynamic"
    excludes = {
        "cantilever": UNPULLED,
        "neighbours": "it is one of springs that know nothing of their neighbours",
        "damping": "nothing but the contact slows the body",
        "noise": "nothing but the contact slows the body",
    }
    history_is_given = True
    is_massless = True

    kind: Literal["impact"]
    """a body that hits the plane; always dynamic"""
    velocity: Velocity
    """normal impact velocity; plate.mass is the mass of the body"""
    tangential_velocity: DriveVelocity | None = None
    """velocity of the centre of mass along x before the impact; needs [friction]"""
    spin: Spin | None = None
    """angular velocity before the impact: the contact point moves along x with the velocity tangential_velocity −
    plate.lever_arm · spin; needs [friction]
    """

    @property
    def is_oblique(self) -> bool:
        """Whether the scene gives a tangential velocity or a spin, be it 0."""
        return self.tangential_velocity is not None or self.spin is not None


Experiment = Annotated[Load | Path | PullOff | Slide | Tangential | Hold | History | Impact, Discriminator("kind")]

KINDS: dict[str, type[Kind]] = {
    kind: table for kind, table in allowed_by(Experiment).kinds.items() if issubclass(table, Kind)
}
"""The tables of experiments by their `kind`."""
