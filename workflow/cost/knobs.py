"""The numerical knobs of a scene: what its file can turn without changing the physics, the values to try, and how.

They are turned one at a time from a base that is much more exact than the scene asks for (`base_change`), so that an
error belongs to the knob. base + one knob's change = a variant;  base + several = a combination. A spacing is turned
with stiffness and drag per length kept, and of neighbour springs stiffness times length.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from contact1d.workflow.experiments import kind_of
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.scene.experiments import Span
from contact1d.workflow.scene.tables import TIMED
from contact1d.workflow.units import Quantity

BASE_TOLERANCE = 1e-5
"""Of the base of a quasistatic scene; in time the scene's own is taken, since time costs by the tolerance."""


@dataclass(frozen=True)
class Change:
    """What makes a variant of a scene.

    Attributes:
        overrides: "table.key=value", as `--set` takes them.
        without: effects left out.
    """

    overrides: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    def __add__(self, later: Change) -> Change:
        """Both; where they meet, the later one prevails."""
        return Change(self.overrides + later.overrides, tuple(dict.fromkeys(self.without + later.without)))

    def scene(self, scene: Scene) -> Scene:
        """The changed scene. Raises SceneError where it is none."""
        return scene_from_dict(scene, self.overrides, self.without)


def base_change(scene: Scene) -> Change:
    """Much more exact than the scene (in time: as exact), on a chain and with a cutoff that are long enough."""
    tolerance = scene.accuracy.tolerance
    if scene.method == "quasistatic":
        tolerance = min(BASE_TOLERANCE, tolerance)
    return at_tolerance(scene, tolerance)


def at_tolerance(scene: Scene, tolerance: float) -> Change:
    """The tolerance, and nothing numerical that the scene fixed by itself."""
    overrides = [f"accuracy.tolerance={tolerance!r}"]
    if not scene.bodies.profile.has_edge:
        overrides.append("bodies.particles=auto")
    if scene.interaction is not None and scene.interaction.attraction is not None:
        overrides.append("interaction.cutoff=auto")
    return Change(tuple(overrides))


def with_method(scene: Scene, method: str) -> Change:
    """The scene with the other method: what exists in time only goes, or comes as far as the experiment needs it."""
    if method == "quasistatic":
        return Change(("experiment.method=quasistatic",), tuple(name for name in TIMED if name in scene.effects))
    needed = ["damping.coefficient=auto"] + ([] if scene.experiment.way_is_given else ["plate.mass=auto"])
    return Change(("experiment.method=dynamic", *needed))


def is_sampled(scene: Scene) -> bool:
    """Whether results are averages over a motion, whose uncertainty is a standard error: with noise, and of a slide."""
    return scene.noise is not None or scene.experiment.motion_is_result


def main_results(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Those that have a relative error: present and not 0. With noise the force that a load holds is no result."""
    names = [name for name in kind_of(scene).main_results if scene.noise is None or name != "force"]
    named = {name: quantities[name] for name in names if name in quantities}
    return {name: one for name, one in named.items() if one.value != 0.0 and math.isfinite(one.value)}


SPACING_FACTORS = (4.0, 2.0, 1.0, 0.5, 0.125)
"""Over the scene's own."""


def spacing_is_physics(scene: Scene) -> str:
    """Why the spacing cannot be turned with the physics kept; "" where it can."""
    if scene.bodies.profile.has_edge:
        return "a flat punch is as wide as its particles make it"
    if scene.noise is not None:
        return "thermal motion of a particle belongs to its spacing"
    if scene.interaction is not None:
        return "the force of a row of opposite particles belongs to its spacing: no amplitudes keep it at another one"
    return ""


def at_spacing(scene: Scene, spacing: float) -> tuple[str, ...]:
    """Scene keys that go with the spacing [LU]."""
    factor, bodies = spacing / scene.bodies.spacing, scene.bodies
    keys = [f"bodies.spacing={spacing!r}", f"bodies.mass={factor * bodies.mass!r}"]
    if bodies.bulk_stiffness != "auto":
        keys.append(f"bodies.bulk_stiffness={factor * scene.bulk_stiffness!r}")
    if bodies.bulk_stiffness_tangential is not None:
        keys.append(f"bodies.bulk_stiffness_tangential={factor * bodies.bulk_stiffness_tangential!r}")
    if scene.neighbours is not None:
        keys.append(f"neighbours.stiffness={scene.neighbours.stiffness / factor!r}")
    if scene.damping is not None and scene.damping.coefficient != "auto":
        keys.append(f"damping.coefficient={factor * scene.damping.coefficient!r}")
    return tuple(keys)


TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
TOLERANCE_FACTORS = (8.0, 4.0, 2.0, 1.0, 0.5)
"""Of a scene whose results are averages over time, which cost by the square of the tolerance; over its own."""
OTHER_METHOD = {"dynamic": (1e-2, 3e-3), "quasistatic": (1e-1, 1e-2, 1e-3, 1e-4)}
"""Tolerances of the method that the scene does not have."""
CUTOFF_SHARES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Force at the cutoff over the law's own."""
CHAIN_FACTORS = (0.6, 0.7, 0.8, 0.9)
"""Over the length that is automatic for the scene's tolerance."""
INCREMENT_FACTORS = (4.0, 2.0, 1.0, 0.5)
DAMPING_FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)


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


def knobs_of(scene: Scene, own: Settings) -> tuple[Knob, ...]:
    """The knobs that a scene has; `own` are the settings of the scene as it is."""
    found = [_tolerance(scene), *_cutoff(scene, own), *_chain(scene, own)]
    if scene.damping is not None:
        found.append(_damping(own))
    return (*found, *_increment(scene), *_method(scene), *_spacing(scene))


def left_out(scene: Scene) -> dict[str, str]:
    """Knobs that one could think of and that are not turned, each with the reason."""
    reasons = {}
    if scene.interaction is not None and scene.interaction.attraction is None:
        reasons["cutoff"] = "without attraction displacements count from the cutoff, so it is physics"
    if reason := spacing_is_physics(scene):
        reasons["spacing"] = reason
    if scene.bodies.profile.has_edge:
        reasons["chain length"] = "a flat punch is as long as it is wide"
    if scene.noise is not None or scene.experiment.motion_is_result:
        reasons["method"] = "what is asked for exists in time only"
    if scene.experiment.goes_along:
        reasons["method"] = "a row is one step, exact as it is"
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


def _cutoff(scene: Scene, own: Settings) -> Iterator[Knob]:
    if own.law is None or own.law.attraction is None:
        return
    levels = []
    for share in CUTOFF_SHARES:
        cutoff = own.law.cutoff_for(share)
        levels.append(Level(share, f"cutoff {cutoff:.3g} LU", Change((f"interaction.cutoff={cutoff!r}",))))
    share = math.exp(-(own.cutoff - own.law.force_free_distance()) / own.law.longest_range)
    yield Knob("cutoff", "force at the cutoff over the law's own", "smaller", tuple(levels), share)


def _chain(scene: Scene, own: Settings) -> Iterator[Knob]:
    if scene.bodies.profile.has_edge:
        return
    automatic = settings_for(at_tolerance(scene, scene.accuracy.tolerance).scene(scene)).particles
    counts = dict.fromkeys(max(4, 2 * round(0.5 * factor * automatic)) for factor in CHAIN_FACTORS)
    levels = [Level(n, f"chain of {n} particles", Change((f"bodies.particles={n}",))) for n in counts]
    # The tail of the pressure falls exponentially where a cutoff ends it, algebraically where springs carry it on.
    yield Knob("chain length", "particles per body", "larger", tuple(levels), own.particles, has_order=False)


def _damping(own: Settings) -> Knob:
    values = [factor * own.damping for factor in DAMPING_FACTORS]
    levels = [Level(c, f"damping {c:.3g} FU·TU/LU", Change((f"damping.coefficient={c!r}",))) for c in values]
    return Knob("damping", "damping of a particle [FU·TU/LU]", "smaller", tuple(levels), own.damping, has_order=False)


def _increment(scene: Scene) -> Iterator[Knob]:
    span = None if scene.experiment.goes_along else getattr(scene.experiment, "displacements", None)
    if not isinstance(span, Span):
        return
    own = span.steps
    counts = dict.fromkeys(max(1, round(own / factor)) for factor in INCREMENT_FACTORS)
    rows = [Level(n, f"{n} increments", Change((f"experiment.displacements.steps={n}",))) for n in counts]
    yield Knob("load increment", "increments of a leg", "larger", tuple(rows), own, own_reference=True)


def _method(scene: Scene) -> Iterator[Knob]:
    experiment = scene.experiment
    if scene.noise is not None or experiment.motion_is_result or experiment.goes_along:
        return
    other = "dynamic" if scene.method == "quasistatic" else "quasistatic"
    change = with_method(scene, other)
    levels = [
        Level(t, f"{other}, accuracy.tolerance = {t:g}", at_tolerance(scene, t) + change) for t in OTHER_METHOD[other]
    ]
    meaning = f"the other method, {other}, by its accuracy.tolerance"
    yield Knob(f"method {other}", meaning, "smaller", tuple(levels), math.nan, has_order=False, alternative=True)


def _spacing(scene: Scene) -> Iterator[Knob]:
    if spacing_is_physics(scene):
        return
    spacing = scene.bodies.spacing
    values = [factor * spacing for factor in SPACING_FACTORS]
    levels = [Level(h, f"spacing {h:g} LU", Change(at_spacing(scene, h))) for h in values]
    meaning = "spacing [LU], same stiffness per length"
    yield Knob("spacing", meaning, "smaller", tuple(levels), spacing, own_reference=True)
