"""The numerical knobs of a scene: what can be turned without changing the physics, the values to try, and how.

They are turned one at a time from a base that is much more exact than the scene asks for (`change.base_change`), so
that an error belongs to the knob.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from contact1d.workflow.cost.change import Change, at_tolerance, with_method
from contact1d.workflow.cost.errors import is_sampled
from contact1d.workflow.cost.row_law import row_law
from contact1d.workflow.cost.spacing import SPACING_FACTORS, at_spacing, spacing_is_physics
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.experiments import Span
from contact1d.workflow.settings.settings import Settings, settings_for

TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
TOLERANCE_FACTORS = (8.0, 4.0, 2.0, 1.0, 0.5)
"""Of a scene whose results are averages over time, which cost by the square of the tolerance; over its own."""
OTHER_METHOD = {"dynamic": (1e-2, 3e-3), "quasistatic": (1e-1, 1e-2, 1e-3, 1e-4)}
"""Tolerances of the method that the scene does not have."""
TABLE_POINTS = (500, 1_000, 2_000, 4_000, 8_000, 16_000)
STYLE_POINTS = {
    "linear": (1_000, 4_000, 16_000, 64_000),
    "lookup": (1_000, 8_000, 64_000),
    "bitmap": (1_024, 8_192, 65_536),
}
"""Of the table styles that decks do not have; a bitmap has a power of two."""
CUTOFF_SHARES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Force at the cutoff over the law's own."""
CHAIN_FACTORS = (0.6, 0.7, 0.8, 0.9)
"""Over the length that is automatic for the scene's tolerance."""
THRESHOLDS = (1e-4, 1e-5, 1e-6, 1e-7)
"""Norm of the residual forces over the force scale."""
INCREMENT_FACTORS = (4.0, 2.0, 1.0, 0.5)
STEP_FACTORS = (8.0, 4.0, 2.0, 1.0, 0.5)
DAMPING_FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)


OTHER_THERMOSTATS = (
    "temp/csvr and nvt scale all velocities alike, so that springs keep the shares of energy that they began with; "
    "langevin with zero stills what all particles do together; brownian, fix gjf and temp/csld move particles in held "
    "directions"
)
"""Why a deck has none of LAMMPS's other schemes; tests/validation/test_noise.py shows it of csvr, nvt and gjf."""


@dataclass(frozen=True)
class Level:
    """One value of a knob; `label` says it with its unit."""

    value: float
    label: str
    change: Change


@dataclass(frozen=True)
class Knob:
    """Something that costs time and buys accuracy.

    Attributes:
        name: one word or two.
        meaning: of its value, with the unit.
        finer: which values are the more exact ones.
        levels: to try.
        own: the value that the scene has, by itself or by the rules; NaN where there is no such.
        has_order: whether its error is expected to be a power of the value.
        own_reference: whether its errors are against its own finest level, since the reference does not have it.
        alternative: whether it is another way, to be compared with the scene's own and not combined with it.
    """

    name: str
    meaning: str
    finer: Literal["larger", "smaller"]
    levels: tuple[Level, ...]
    own: float
    has_order: bool = True
    own_reference: bool = False
    alternative: bool = False


def knobs_of(scene: Scene, own: Settings, base: Settings) -> tuple[Knob, ...]:
    """The knobs that a scene has; `own` and `base` are the settings of the scene as it is and of the base."""
    found = [_tolerance(scene), *_law(scene, own), *_chain(scene, own)]
    if scene.method == "quasistatic":
        found += [_threshold(own)]
    else:
        found += [_time_step(own), _damping(own)]
    found += [*_increment(scene, own, base), *_method(scene), *_thermostat(scene, own), *_spacing(scene, own)]
    return tuple(found)


def left_out(scene: Scene) -> dict[str, str]:
    """Knobs that one could think of and that are not turned, each with the reason."""
    reasons = {}
    if scene.interaction is not None and scene.interaction.attraction is None:
        reasons["cutoff"] = "without attraction displacements count from the cutoff, so it is physics"
    if scene.noise is not None:
        reasons["other thermostats"] = OTHER_THERMOSTATS
    if reason := spacing_is_physics(scene, settings_for(scene)):
        reasons["spacing"] = reason
    if scene.bodies.profile.has_edge:
        reasons["chain length"] = "a flat punch is as long as it is wide"
    if scene.noise is not None or scene.experiment.kind == "slide":
        reasons["method"] = "what is asked for exists in time only"
    return reasons


def _tolerance(scene: Scene) -> Knob:
    own = scene.accuracy.tolerance
    values: tuple[float, ...] = TOLERANCES
    if is_sampled(scene):
        values = tuple(min(own * factor, 0.1) for factor in TOLERANCE_FACTORS)
    elif scene.method == "dynamic":
        values = TOLERANCES[:-1]
    levels = [Level(t, f"accuracy.tolerance = {t:g}", at_tolerance(scene, t)) for t in dict.fromkeys(values)]
    return Knob("tolerance", "accuracy.tolerance, which sets all others", "smaller", tuple(levels), own)


def _law(scene: Scene, own: Settings) -> Iterator[Knob]:
    if own.table is None or own.law is None or scene.interaction is None:
        return
    points = [Level(n, f"table of {n} points", Change(settings=(("table_points", n),))) for n in TABLE_POINTS]
    yield Knob("table points", "points of the spline table over r²", "larger", tuple(points), own.table.points)
    for style, counts in STYLE_POINTS.items():
        styled = [Level(n, f"{style} table of {n} points", _styled(style, n)) for n in counts]
        meaning = f"points of a table over r², pair_style table {style}"
        yield Knob(f"table style {style}", meaning, "larger", tuple(styled), own.table.points, alternative=True)
    if scene.interaction.attraction is None:
        return
    levels = []
    for share in CUTOFF_SHARES:
        cutoff = own.law.cutoff_for(share)
        change = Change((f"interaction.cutoff={cutoff!r}",))
        levels.append(Level(share, f"cutoff {cutoff:.3g} LU", change))
    share = math.exp(-(own.cutoff - own.law.force_free_distance()) / own.law.longest_range)
    yield Knob("cutoff", "force at the cutoff over the law's own", "smaller", tuple(levels), share)


def _styled(style: str, points: int) -> Change:
    return Change(settings=(("table_points", points), ("table_style", style)))


def _chain(scene: Scene, own: Settings) -> Iterator[Knob]:
    if scene.bodies.profile.has_edge:
        return
    automatic = settings_for(at_tolerance(scene, scene.accuracy.tolerance).scene(scene)).particles
    counts = dict.fromkeys(max(4, 2 * round(0.5 * factor * automatic)) for factor in CHAIN_FACTORS)
    levels = [Level(n, f"chain of {n} particles", Change((f"bodies.particles={n}",))) for n in counts]
    # The tail of the pressure falls exponentially where a cutoff ends it, algebraically where springs carry it on.
    yield Knob("chain length", "particles per body", "larger", tuple(levels), own.particles, has_order=False)


def _threshold(own: Settings) -> Knob:
    levels = [
        Level(s, f"residual {s:.0e}", Change(settings=(("force_tolerance", s * own.force_scale),))) for s in THRESHOLDS
    ]
    value = own.force_tolerance / own.force_scale
    meaning = "norm of the residual forces over the force scale"
    return Knob("convergence threshold", meaning, "smaller", tuple(levels), value)


def _time_step(own: Settings) -> Knob:
    steps = [factor * own.time_step for factor in STEP_FACTORS]
    levels = [Level(dt, f"time step {dt:.3g} TU", Change(settings=(("time_step", dt),))) for dt in steps]
    return Knob("time step", "time step [TU]", "smaller", tuple(levels), own.time_step)


def _thermostat(scene: Scene, own: Settings) -> Iterator[Knob]:
    if scene.noise is None:
        return
    steps = [factor * own.time_step for factor in STEP_FACTORS]
    levels = [Level(dt, f"gjf, time step {dt:.3g} TU", gjf(dt)) for dt in steps]
    meaning = "time step [TU] of fix langevin gjf"
    yield Knob("thermostat gjf", meaning, "smaller", tuple(levels), own.time_step, alternative=True)


def gjf(time_step: float) -> Change:
    """The other thermostat that a deck can have, at that time step [TU]."""
    return Change(settings=(("time_step", time_step), ("thermostat", "gjf")))


def _damping(own: Settings) -> Knob:
    values = [factor * own.damping for factor in DAMPING_FACTORS]
    levels = [Level(c, f"damping {c:.3g} FU·TU/LU", Change((f"damping.coefficient={c!r}",))) for c in values]
    return Knob("damping", "damping of a particle [FU·TU/LU]", "smaller", tuple(levels), own.damping, has_order=False)


def _increment(scene: Scene, own: Settings, base: Settings) -> Iterator[Knob]:
    experiment = scene.experiment
    if experiment.kind == "path":
        if not isinstance(experiment.displacements, Span):
            return
        counts = dict.fromkeys(max(1, round(experiment.displacements.steps / f)) for f in INCREMENT_FACTORS)
        rows = [Level(n, f"{n} increments", Change((f"experiment.displacements.steps={n}",))) for n in counts]
        own_count = experiment.displacements.steps
        yield Knob("load increment", "increments of a leg", "larger", tuple(rows), own_count, own_reference=True)
    elif scene.method == "quasistatic":
        fields = ("smooth_step" if own.is_smooth else "displacement_step", "longest_move")
        levels = [
            Level(
                f, f"{f:g} × the increment", Change(settings=tuple((name, f * getattr(base, name)) for name in fields))
            )
            for f in INCREMENT_FACTORS
        ]
        yield Knob("load increment", "increment over the automatic one", "smaller", tuple(levels), 1.0, has_order=False)


def _method(scene: Scene) -> Iterator[Knob]:
    if scene.noise is not None or scene.experiment.kind == "slide":
        return
    other = "dynamic" if scene.method == "quasistatic" else "quasistatic"
    change = with_method(scene, other)
    levels = [
        Level(t, f"{other}, accuracy.tolerance = {t:g}", at_tolerance(scene, t) + change) for t in OTHER_METHOD[other]
    ]
    meaning = f"the other method, {other}, by its accuracy.tolerance"
    yield Knob(f"method {other}", meaning, "smaller", tuple(levels), math.nan, has_order=False, alternative=True)


def _spacing(scene: Scene, own: Settings) -> Iterator[Knob]:
    if spacing_is_physics(scene, own):
        return
    spacing = scene.bodies.spacing
    row = None if own.law is None else spacing
    values = [factor * spacing for factor in SPACING_FACTORS[scene.bodies.lower]]
    levels = [Level(h, f"spacing {h:g} LU", Change(at_spacing(scene, h), row_spacing=row)) for h in values]
    meaning = "spacing [LU], same stiffness per length"
    if own.law is not None:
        misfit = max(row_law(own.law, spacing, h).misfit for h in values)
        meaning += f", opposite rows with the same force per length within {misfit:.0e} of the largest tension"
    yield Knob("spacing", meaning, "smaller", tuple(levels), spacing, has_order=own.law is None, own_reference=True)
