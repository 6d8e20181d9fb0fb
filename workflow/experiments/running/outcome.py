"""What an experiment hands over: quantities with uncertainty, the curve, profiles, the schedule, and its warnings."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.centring import left_by_centring
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import Quantity


@dataclass(frozen=True)
class Refinement:
    """How a run was refined: the tolerance of its settings in the end, how often that was lowered, why not further."""

    tolerance: float
    count: int
    ended: str


@dataclass(frozen=True)
class Outcome:
    """The result of one experiment.

    Attributes:
        quantities: by the names of the contract.
        states: every measured state of the final schedule, in order.
        profiles: the states that are reported, by name.
        radii: contact radius of each reported profile.
        phases: the schedule.
        warnings: by name, what limits the trust in the numbers.
        friction: columns of friction.csv, for a slide.
        tables: columns of further files, by the names of these: slips, detachments, samples.
        spacing_uncertainty: by name, the part of a quantity's uncertainty that the spacing of the particles leaves,
            whatever the settings.
        centring: by name, the part of it that comes from not knowing where the contact's centre lies between particles
            (`workflow.settings.centring`); no finer settings of the run make it smaller.
        prescribed: names of the quantities that the scene prescribes, which are no results.
        compared_with: by name, what an uncertainty is compared with where that is not the quantity itself, in its unit.
        refinement: None where the settings were given, or are not refined.
    """

    quantities: Mapping[str, Quantity]
    states: tuple[State, ...]
    profiles: Mapping[str, Profile]
    radii: Mapping[str, float]
    phases: tuple[Phase, ...]
    warnings: Mapping[str, str] = field(default_factory=dict)
    friction: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    tables: Mapping[str, Mapping[str, tuple[float, ...]]] = field(default_factory=dict)
    spacing_uncertainty: Mapping[str, float] = field(default_factory=dict)
    centring: Mapping[str, float] = field(default_factory=dict)
    prescribed: frozenset[str] = frozenset()
    compared_with: Mapping[str, float] = field(default_factory=dict)
    refinement: Refinement | None = None

    @property
    def on_own_lattice(self) -> dict[str, Quantity]:
        """The quantities as uncertain as the run leaves them, its particles being where they are."""
        return {
            name: Quantity(known.value, known.uncertainty - self.centring.get(name, 0.0), known.unit)
            for name, known in self.quantities.items()
        }


def anywhere_between(scene: Scene, settings: Settings, outcome: Outcome) -> Outcome:
    """The outcome of a contact whose centre may lie anywhere between particles: more uncertain, and a warning if much.

    F and a of the mean pressure F/πa² are a load's own.
    """
    parts = dict(left_by_centring(scene, settings))
    if "mean_pressure" in outcome.quantities and "contact_radius" in parts:
        share = 2.0 * parts["contact_radius"] / outcome.quantities["contact_radius"].value
        parts["mean_pressure"] = share * abs(outcome.quantities["mean_pressure"].value)
    parts = {name: part for name, part in parts.items() if name in outcome.quantities}
    known = {
        name: Quantity(q.value, q.uncertainty + parts.get(name, 0.0), q.unit) for name, q in outcome.quantities.items()
    }
    warnings = dict(outcome.warnings)
    sizes = {name: outcome.compared_with.get(name, abs(known[name].value)) for name in parts}
    shares = {name: part / sizes[name] for name, part in parts.items() if sizes[name]}
    # A radius that is 0 here, and not where the contact's centre lies elsewhere.
    shares |= {name: math.inf for name in parts.keys() - shares.keys() if parts[name] and name.endswith("radius")}
    if open_ := {name: share for name, share in shares.items() if share > scene.accuracy.tolerance}:
        limits = f"{in_words(open_)} only, more than the tolerance of {scene.accuracy.tolerance:g}, because "
        warnings["lattice"] = limits + (
            f"the edge of the contact moves through cells: take a bodies.spacing of {_finer(scene, open_):.2g} LU at "
            "the same stiffness per length"
            if scene.adheres and scene.adhesion is not None
            else "the contact's centre may lie on a particle or anywhere between two of this chain: take a smaller "
            "bodies.spacing at the same stiffness and energy per length, or give bodies.particles where these very "
            "particles are meant"
        )
    return replace(outcome, quantities=known, centring=parts, warnings=warnings)


def _finer(scene: Scene, shares: Mapping[str, float]) -> float:
    """The spacing [LU] that leaves half of the tolerance: with the same layer errors go with its square."""
    return scene.bodies.spacing * math.sqrt(0.5 * scene.accuracy.tolerance / min(1.0, max(shares.values())))


def unmet(scene: Scene, outcome: Outcome) -> dict[str, float]:
    """Relative uncertainties of the main results that are known less well than the tolerance; with noise of none.

    What a scene prescribes is no result. That of a radius of 0 is infinite.
    """
    if scene.noise is not None:
        return {}
    shares = {}
    for name, quantity in outcome.on_own_lattice.items():
        size = outcome.compared_with.get(name, abs(quantity.value))
        if name not in outcome.prescribed and (size != 0.0 or name.endswith("radius")):
            shares[name] = quantity.uncertainty / size if size else math.inf
    return {name: share for name, share in shares.items() if share > scene.accuracy.tolerance}


def left_open_by_spacing(scene: Scene, outcome: Outcome, names: Iterable[str]) -> set[str]:
    """Those of the named results that the spacing alone leaves less certain than the tolerance."""
    tolerance, known = scene.accuracy.tolerance, outcome.quantities
    return {name for name in names if outcome.spacing_uncertainty.get(name, 0.0) > tolerance * abs(known[name].value)}


def in_words(shares: Mapping[str, float]) -> str:
    """What `unmet` found: "critical_radius is known to 3.1e-04"."""
    return ", ".join(
        f"{name} is known to {share:.1e}" if share < 1.0 else f"{name} cannot be told from 0 and is known to 1 or worse"
        for name, share in shares.items()
    )
