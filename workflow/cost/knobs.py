"""The numerical settings of a scene: what its file can change without changing the physics, and the values to try.

One is changed at a time, from a base that is much more exact than the scene asks for (`base_keys`), so that an error
belongs to the setting. With a spacing, stiffness and drag per length are kept, and of neighbour springs stiffness times
length.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from contact1d.workflow.experiments import kind_of
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.runs.scales import scales_of
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
    """The scene with the other method; keys of a dynamic scene are removed, or added as the experiment needs them."""
    if method == "quasistatic":
        return ("experiment.method=quasistatic", *(WITHOUT + name for name in TIMED if name in scene.effects))
    plate = () if scene.experiment.way_is_given else ("plate.mass=auto",)
    return ("experiment.method=dynamic", "damping.coefficient=auto", *plate)


def is_sampled(scene: Scene) -> bool:
    """Whether results are averages over a motion, whose uncertainty is a standard error: with noise, and of a slide."""
    return scene.noise is not None or scene.experiment.motion_is_result


def main_results(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Results that have a relative error: present and not 0. With noise the force that a load holds is no result."""
    names = [name for name in kind_of(scene).main_results if scene.noise is None or name != "force"]
    found = {name: quantities.get(name) for name in names}
    return {name: one for name, one in found.items() if one and one.value != 0.0 and math.isfinite(one.value)}


TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Without the last one in time."""
TOLERANCE_FACTORS = (8.0, 4.0, 2.0, 0.5)
"""Of a scene whose results are averages over time, which cost by the square of the tolerance; over its own."""
OTHER_METHOD = {"dynamic": (1e-2, 3e-3), "quasistatic": (1e-1, 1e-2, 1e-3, 1e-4)}
"""Tolerances of the method that the scene does not have."""
CUTOFF_SHARES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Force at the cutoff over the force scale, its h."""
CHAIN_FACTORS = (0.6, 0.7, 0.8, 0.9)
"""Over the length that is automatic for the scene's tolerance."""
INCREMENT_FACTORS = (1.0, 4.0, 2.0, 0.5)
DAMPING_FACTORS = (1.0, 0.25, 0.5, 2.0, 4.0)
SPACING_FACTORS = (1.0, 4.0, 2.0, 0.5, 0.125)
"""Over the scene's own, which is the first."""


class Level(NamedTuple):
    """A value of a setting as text with its unit; `h` goes to zero as it gets finer, NaN without an order."""

    h: float
    value: str
    keys: Keys


@dataclass(frozen=True)
class Order:
    """p of error ∝ h^p, and its standard error."""

    order: float
    standard_error: float

    def __str__(self) -> str:
        """`0.94 ± 0.04`."""
        return f"{self.order:.2f} ± {self.standard_error:.2f}"


@dataclass(frozen=True)
class Knob:
    """A numerical setting, which costs time and buys accuracy.

    Attributes:
        name: its key in a scene file.
        now: value that the scene has, by itself or by the rules, with its unit.
        h: of this value.
        levels: to try, with the scene's own.
        own_reference: whether its errors are against its own finest level, since the reference does not have it.
        has_order: whether its error is expected to be a power of h.
        order: of its error, None where there is none to be fitted.
    """

    name: str
    now: str
    h: float
    levels: Annotated[tuple[Level, ...], Field(exclude=True)] = ()
    own_reference: bool = False
    has_order: bool = True
    order: Order | None = None


def knobs_of(scene: Scene, own: Settings) -> tuple[tuple[Knob, ...], dict[str, str]]:
    """The settings that a scene has; and those that one could think of and that are not tried, each with the reason.

    Args:
        scene: whose file is changed.
        own: settings of the scene as it is.
    """
    found = {
        "accuracy.tolerance": _tolerance(scene),
        "interaction.cutoff": _cutoff(scene, own),
        "bodies.particles": _chain(scene, own),
        "damping.coefficient": _damping(scene, own),
        "experiment.displacements.steps": _increment(scene),
        "experiment.method": _method(scene),
        "bodies.spacing": _spacing(scene),
    }
    reasons = {name: knob for name, knob in found.items() if isinstance(knob, str) and knob}
    return tuple(knob for knob in found.values() if isinstance(knob, Knob)), reasons


def _knob(
    scene: Scene,
    name: str,
    values: Iterable[float],
    h: Callable[[float], float] = float,
    unit: str = "",
    keys: Callable[[float], Keys] | None = None,
    **more: Any,
) -> Knob:
    """A setting of these values, the first of them the scene's own; others than `keys` are changed from the base."""
    keys = keys or (lambda value: (*base_keys(scene), f"{name}={value!r}"))
    words = scales_of(scene, {}).in_words
    levels = tuple(Level(h(value), words(f"{value:g}{unit}"), keys(value)) for value in dict.fromkeys(values))
    return Knob(name, levels[0].value, levels[0].h, levels, **more)


def _inverse(value: float) -> float:
    return 1.0 / value


def _tolerance(scene: Scene) -> Knob:
    own = scene.accuracy.tolerance
    values: Iterable[float] = TOLERANCES[:-1] if scene.method == "dynamic" else TOLERANCES
    if is_sampled(scene):
        values = (min(own * factor, 0.1) for factor in TOLERANCE_FACTORS)
    return _knob(scene, "accuracy.tolerance", (own, *values), keys=lambda value: at_tolerance(scene, value))


def _cutoff(scene: Scene, own: Settings) -> Knob | str:
    if (law := own.forces.law) is None or law.attraction is None:
        physics = "without attraction displacements are measured from the cutoff"
        return "" if scene.interaction is None else physics
    cutoffs = (own.forces.cutoff, *map(law.cutoff_for, CUTOFF_SHARES))
    free, reach = law.force_free_distance(), law.longest_range
    return _knob(
        scene, "interaction.cutoff", map(_rounded, cutoffs), lambda cutoff: math.exp((free - cutoff) / reach), " LU"
    )


def _rounded(value: float) -> float:
    return float(f"{value:.3g}")


def _chain(scene: Scene, own: Settings) -> Knob | str:
    if scene.bodies.profile.has_edge:
        return "its chain is as long as the flat punch is wide"
    automatic = settings_for(changed(scene, at_tolerance(scene, scene.accuracy.tolerance))).chains.upper
    counts = (max(4, 2 * round(0.5 * factor * automatic)) for factor in CHAIN_FACTORS)
    # The tail of the pressure falls exponentially where a cutoff ends it, algebraically where springs carry it on.
    return _knob(scene, "bodies.particles", (own.chains.upper, *counts), _inverse, has_order=False)


def _damping(scene: Scene, own: Settings) -> Knob | str:
    if scene.damping is None:
        return ""
    values = (_rounded(factor * own.motion.damping) for factor in DAMPING_FACTORS)
    return _knob(scene, "damping.coefficient", values, unit=" FU·TU/LU", has_order=False)


def _increment(scene: Scene) -> Knob | str:
    span = None if scene.experiment.goes_along else getattr(scene.experiment, "displacements", None)
    if not isinstance(span, Span):
        return ""
    counts = (max(1, round(span.steps / factor)) for factor in INCREMENT_FACTORS)
    return _knob(scene, "experiment.displacements.steps", counts, _inverse, own_reference=True)


def _method(scene: Scene) -> Knob | str:
    if scene.experiment.goes_along:
        return "a load step is one timestep, exact to round-off"
    if is_sampled(scene):
        return "the experiment exists in time only"
    other = "dynamic" if scene.method == "quasistatic" else "quasistatic"
    keys = with_method(scene, other)
    others = (Level(math.nan, f"{other}, tolerance {t:g}", at_tolerance(scene, t) + keys) for t in OTHER_METHOD[other])
    levels = Level(math.nan, scene.method, ()), *others
    return Knob("experiment.method", scene.method, math.nan, levels, has_order=False)


def _spacing(scene: Scene) -> Knob | str:
    if scene.bodies.profile.has_edge:
        return "the particles define the width of a flat punch"
    if scene.noise is not None:
        return "thermal motion of a particle belongs to its spacing"
    if scene.interaction is not None:
        return "the force of a chain of opposite particles depends on its spacing, whatever the amplitudes"
    values = (factor * scene.bodies.spacing for factor in SPACING_FACTORS)
    return _knob(
        scene, "bodies.spacing", values, unit=" LU", keys=lambda value: _at_spacing(scene, value), own_reference=True
    )


def _at_spacing(scene: Scene, spacing: float) -> Keys:
    """Keys of the base with those that go with the spacing [LU]."""
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
    return (*base_keys(scene), *(f"{key}={value!r}" for key, value in values.items()))
