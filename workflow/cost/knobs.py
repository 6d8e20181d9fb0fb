"""The numerical knobs of a scene: what its file can turn without changing the physics, the values to try, and how.

They are turned one at a time from a base that is much more exact than the scene asks for (`base_keys`), so that an
error belongs to the knob. base + one knob's keys = a variant;  base + several = a combination. A spacing is turned
with stiffness and drag per length kept, and of neighbour springs stiffness times length.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from contact1d.workflow.experiments import kind_of
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.scene.experiments import Span
from contact1d.workflow.scene.tables import TIMED
from contact1d.workflow.units import Quantity

BASE_TOLERANCE = 1e-5
"""Of the base of a quasistatic scene; in time the scene's own is taken, since time costs by the tolerance."""
Keys = tuple[str, ...]
"""What makes a variant of a scene: "table.key=value", as `--set` takes it, of two the later one; "without <effect>"."""
WITHOUT = "without "


def changed(scene: Scene, keys: Keys) -> Scene:
    """The scene with these keys. Raises SceneError where it is none."""
    values = [key for key in keys if not key.startswith(WITHOUT)]
    return scene_from_dict(scene, values, [key.removeprefix(WITHOUT) for key in keys if key.startswith(WITHOUT)])


def base_keys(scene: Scene) -> Keys:
    """Much more exact than the scene (in time: as exact), on a chain and with a cutoff that are long enough."""
    tolerance = scene.accuracy.tolerance
    return at_tolerance(scene, min(BASE_TOLERANCE, tolerance) if scene.method == "quasistatic" else tolerance)


def at_tolerance(scene: Scene, tolerance: float) -> Keys:
    """The tolerance, and nothing numerical that the scene fixed by itself."""
    keys = [f"accuracy.tolerance={tolerance!r}"]
    if not scene.bodies.profile.has_edge:
        keys.append("bodies.particles=auto")
    if scene.interaction is not None and scene.interaction.attraction is not None:
        keys.append("interaction.cutoff=auto")
    return tuple(keys)


def with_method(scene: Scene, method: str) -> Keys:
    """The scene with the other method: what exists in time only goes, or comes as far as the experiment needs it."""
    if method == "quasistatic":
        return ("experiment.method=quasistatic", *(WITHOUT + name for name in TIMED if name in scene.effects))
    plate = () if scene.experiment.way_is_given else ("plate.mass=auto",)
    return ("experiment.method=dynamic", "damping.coefficient=auto", *plate)


def is_sampled(scene: Scene) -> bool:
    """Whether results are averages over a motion, whose uncertainty is a standard error: with noise, and of a slide."""
    return scene.noise is not None or scene.experiment.motion_is_result


def main_results(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Those that have a relative error: present and not 0. With noise the force that a load holds is no result."""
    names = [name for name in kind_of(scene).main_results if scene.noise is None or name != "force"]
    named = {name: quantities[name] for name in names if name in quantities}
    return {name: one for name, one in named.items() if one.value != 0.0 and math.isfinite(one.value)}


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
SPACING_FACTORS = (4.0, 2.0, 1.0, 0.5, 0.125)
"""Over the scene's own."""


class Level(NamedTuple):
    """One value of a knob; `label` says it with its unit."""

    value: float
    label: str
    keys: Keys


@dataclass(frozen=True)
class Order:
    """p of error ∝ h^p, its standard error, and how many points it comes from."""

    order: float
    standard_error: float
    points: int

    def __str__(self) -> str:
        """`0.94 ± 0.04`."""
        return f"{self.order:.2f} ± {self.standard_error:.2f}"


@dataclass(frozen=True)
class Knob:
    """Something that costs time and buys accuracy.

    Attributes:
        name: one word or two.
        meaning: of its value, with the unit.
        own: the value that the scene has, by itself or by the rules; NaN where there is no such.
        levels: to try.
        finer: which values are the more exact ones.
        own_reference: whether its errors are against its own finest level, since the reference does not have it.
        order: of its error, None where there is none to be fitted.
        has_order: whether its error is expected to be a power of the value.
        alternative: whether it is another way, to be compared with the scene's own and not combined with it.
    """

    name: str
    meaning: str
    own: float
    levels: Annotated[tuple[Level, ...], Field(exclude=True)] = ()
    finer: Literal["larger", "smaller"] = "smaller"
    own_reference: bool = False
    order: Order | None = None
    has_order: Annotated[bool, Field(exclude=True)] = True
    alternative: Annotated[bool, Field(exclude=True)] = False

    def coarseness(self, value: float) -> float:
        """What falls as the knob gets finer."""
        return value if self.finer == "smaller" else 1.0 / value


def knobs_of(scene: Scene, own: Settings) -> tuple[tuple[Knob, ...], dict[str, str]]:
    """The knobs that a scene has; and those that one could think of and that are not turned, each with the reason.

    Args:
        scene: whose file is turned.
        own: settings of the scene as it is.
    """
    found = {
        "tolerance": _tolerance(scene),
        "cutoff": _cutoff(scene, own),
        "chain length": _chain(scene, own),
        "damping": _damping(scene, own),
        "load increment": _increment(scene),
        "method": _method(scene),
        "spacing": _spacing(scene),
    }
    reasons = {name: knob for name, knob in found.items() if isinstance(knob, str) and knob}
    return tuple(knob for knob in found.values() if isinstance(knob, Knob)), reasons


def _tolerance(scene: Scene) -> Knob:
    own = scene.accuracy.tolerance
    values: tuple[float, ...] = TOLERANCES[:-1] if scene.method == "dynamic" else TOLERANCES
    if is_sampled(scene):
        values = tuple(min(own * factor, 0.1) for factor in TOLERANCE_FACTORS)
    levels = (Level(t, f"accuracy.tolerance = {t:g}", at_tolerance(scene, t)) for t in dict.fromkeys(values))
    return Knob("tolerance", "accuracy.tolerance, which sets all others", own, tuple(levels))


def _cutoff(scene: Scene, own: Settings) -> Knob | str:
    if own.law is None or own.law.attraction is None:
        physics = "without attraction displacements count from the cutoff, so it is physics"
        return "" if scene.interaction is None else physics
    cutoffs = {share: own.law.cutoff_for(share) for share in CUTOFF_SHARES}
    levels = (Level(share, f"cutoff {c:.3g} LU", (f"interaction.cutoff={c!r}",)) for share, c in cutoffs.items())
    share = math.exp(-(own.cutoff - own.law.force_free_distance()) / own.law.longest_range)
    return Knob("cutoff", "force at the cutoff over the law's own", share, tuple(levels))


def _chain(scene: Scene, own: Settings) -> Knob | str:
    if scene.bodies.profile.has_edge:
        return "a flat punch is as long as it is wide"
    automatic = settings_for(changed(scene, at_tolerance(scene, scene.accuracy.tolerance))).particles
    counts = dict.fromkeys(max(4, 2 * round(0.5 * factor * automatic)) for factor in CHAIN_FACTORS)
    levels = (Level(n, f"chain of {n} particles", (f"bodies.particles={n}",)) for n in counts)
    # The tail of the pressure falls exponentially where a cutoff ends it, algebraically where springs carry it on.
    return Knob("chain length", "particles per body", own.particles, tuple(levels), "larger", has_order=False)


def _damping(scene: Scene, own: Settings) -> Knob | str:
    if scene.damping is None:
        return ""
    values = (factor * own.damping for factor in DAMPING_FACTORS)
    levels = (Level(c, f"damping {c:.3g} FU·TU/LU", (f"damping.coefficient={c!r}",)) for c in values)
    return Knob("damping", "damping of a particle [FU·TU/LU]", own.damping, tuple(levels), has_order=False)


def _increment(scene: Scene) -> Knob | str:
    span = None if scene.experiment.goes_along else getattr(scene.experiment, "displacements", None)
    if not isinstance(span, Span):
        return ""
    counts = dict.fromkeys(max(1, round(span.steps / factor)) for factor in INCREMENT_FACTORS)
    levels = (Level(n, f"{n} increments", (f"experiment.displacements.steps={n}",)) for n in counts)
    return Knob("load increment", "increments of a leg", span.steps, tuple(levels), "larger", own_reference=True)


def _method(scene: Scene) -> Knob | str:
    if scene.experiment.goes_along:
        return "a row is one step, exact as it is"
    if is_sampled(scene):
        return "what is asked for exists in time only"
    other = "dynamic" if scene.method == "quasistatic" else "quasistatic"
    keys = with_method(scene, other)
    levels = (
        Level(t, f"{other}, accuracy.tolerance = {t:g}", at_tolerance(scene, t) + keys) for t in OTHER_METHOD[other]
    )
    meaning = f"the other method, {other}, by its accuracy.tolerance"
    return Knob(f"method {other}", meaning, math.nan, tuple(levels), has_order=False, alternative=True)


def _spacing(scene: Scene) -> Knob | str:
    if scene.bodies.profile.has_edge:
        return "a flat punch is as wide as its particles make it"
    if scene.noise is not None:
        return "thermal motion of a particle belongs to its spacing"
    if scene.interaction is not None:
        return "the force of a row of opposite particles belongs to its spacing: no amplitudes keep it at another one"
    values = (factor * scene.bodies.spacing for factor in SPACING_FACTORS)
    levels = (Level(h, f"spacing {h:g} LU", _at_spacing(scene, h)) for h in values)
    meaning = "spacing [LU], same stiffness per length"
    return Knob("spacing", meaning, scene.bodies.spacing, tuple(levels), own_reference=True)


def _at_spacing(scene: Scene, spacing: float) -> Keys:
    """Scene keys that go with the spacing [LU]."""
    factor, bodies = spacing / scene.bodies.spacing, scene.bodies
    values: dict[str, float] = {"bodies.spacing": spacing, "bodies.mass": factor * bodies.mass}
    if bodies.bulk_stiffness != "auto":
        values["bodies.bulk_stiffness"] = factor * scene.bulk_stiffness
    if bodies.bulk_stiffness_tangential is not None:
        values["bodies.bulk_stiffness_tangential"] = factor * bodies.bulk_stiffness_tangential
    if scene.neighbours is not None:
        values["neighbours.stiffness"] = scene.neighbours.stiffness / factor
    if scene.damping is not None and scene.damping.coefficient != "auto":
        values["damping.coefficient"] = factor * scene.damping.coefficient
    return tuple(f"{key}={value!r}" for key, value in values.items())
