"""What an experiment hands over: quantities with uncertainty, the curve, profiles, the schedule, and its doubts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from contact1d.analysis.pressure import Profile, end_pressure_share
from contact1d.workflow.deck.deck import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_share
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.scene import FlatPunch, Scene
from contact1d.workflow.settings.centring import left_by_centring
from contact1d.workflow.settings.chain import decay_length, reflected
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import Quantity


class UntrustedError(RuntimeError):
    """The run ended, but its result can't be trusted; the message says why and what to do."""


class ThroughError(UntrustedError):
    """The bodies went through each other, which may be the way there and not the load (`in_smaller_steps`)."""


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
        lattice: by name, the part of a quantity's uncertainty that the spacing of the particles leaves, whatever the
            settings.
        centring: by name, the part of it that comes from not knowing where the contact's centre lies between particles
            (`workflow.settings.centring`); no finer settings of the run make it smaller.
        refinement: None where the settings were given, or are not refined.
    """

    quantities: Mapping[str, Quantity]
    states: tuple[State, ...]
    profiles: Mapping[str, Profile]
    radii: Mapping[str, float]
    phases: tuple[Phase, ...]
    warnings: Mapping[str, str] = field(default_factory=dict)
    friction: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    lattice: Mapping[str, float] = field(default_factory=dict)
    centring: Mapping[str, float] = field(default_factory=dict)
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
    parts = left_by_centring(scene, settings)
    if "mean_pressure" in outcome.quantities and "contact_radius" in parts:
        share = 2.0 * parts["contact_radius"] / outcome.quantities["contact_radius"].value
        parts["mean_pressure"] = share * abs(outcome.quantities["mean_pressure"].value)
    parts = {name: part for name, part in parts.items() if name in outcome.quantities}
    known = {
        name: Quantity(q.value, q.uncertainty + parts.get(name, 0.0), q.unit) for name, q in outcome.quantities.items()
    }
    warnings = dict(outcome.warnings)
    shares = {name: part / abs(known[name].value) for name, part in parts.items() if known[name].value}
    if open_ := {name: share for name, share in shares.items() if share > scene.accuracy.tolerance}:
        warnings["lattice"] = (
            f"{in_words(open_)} only, more than the tolerance of {scene.accuracy.tolerance:g}, because the contact's "
            "centre may lie on a particle or anywhere between two of this chain: take a smaller bodies.spacing at the "
            "same stiffness and energy per length, or give bodies.particles where these very particles are meant"
        )
    return replace(outcome, quantities=known, centring=parts, warnings=warnings)


END_SHARE_LIMIT = 1.0
"""Pressure at a chain's end over the largest one, per unit of tolerance, from which on the chain cuts the contact."""
INSIDE = 0.5
"""The same from which on the end of the chain is inside the contact."""
RESIDUAL_LIMIT = 0.1
"""Largest residual force of a particle over the force scale, per unit of tolerance, for a converged state."""


def require_trust(scene: Scene, settings: Settings, state: State) -> None:
    """Refuse a state that is no result.

    Raises:
        UntrustedError: bodies that went through each other, particles not at rest, a contact that reaches the end of
            a chain.
    """
    at = f"at displacement {state.displacement:.4g} LU (phase {state.phase})"
    if state.depth > 0.0:
        raise ThroughError(
            f"the bodies went through each other {at}: a particle lies {state.depth:.3g} LU below the opposite "
            "surface. One layer of particles cannot carry this load: lower the load or the displacement, take a "
            "stronger repulsion, a range nearer to the spacing, or stiffer neighbour springs"
        )
    limit = RESIDUAL_LIMIT * scene.accuracy.tolerance * settings.force_scale
    prescribed = scene.method == "quasistatic" or scene.experiment.kind == "path"
    if prescribed and state.residual > limit:
        raise UntrustedError(
            f"not converged {at}: a particle is left with a force of {state.residual:.2g} FU, above the {limit:.2g} FU "
            f"that a tolerance of {scene.accuracy.tolerance:g} allows. What helps is "
            + ("more [damping]" if scene.method == "dynamic" else "a smaller load or smaller displacements")
            + ", or a larger [accuracy] tolerance"
        )
    if _reaches_end(scene, state.profile):
        raise UntrustedError(
            f"the contact reaches the end of the chain {at}: take more bodies.particles than {settings.particles} "
            '(or "auto"), or a smaller load'
        )


def require_no_contradiction(settings: Settings, quantities: Mapping[str, Quantity], states: Iterable[State]) -> None:
    """Refuse a largest tension that a state of the run's own curve exceeds by more than its uncertainty.

    Raises:
        UntrustedError: names the state.
    """
    found = quantities["adhesion_force"]
    for state in states:
        if -state.force > found.value + found.uncertainty + state.residual * settings.particles:
            raise UntrustedError(
                f"the largest tension was found as {found.value:.6g} FU, and the run's own curve has "
                f"{-state.force:.6g} FU at displacement {state.displacement:.6g} LU (phase {state.phase}): the search "
                'was misled. Use kind = "path" through all of the tension, or a smaller [accuracy] tolerance'
            )


def unmet(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, float]:
    """Relative uncertainties of the main results that are known less well than the tolerance; with noise of none.

    What a scene prescribes is no result, and neither is the pressure of a contact that is to carry nothing. That of a
    radius of 0 is infinite.
    """
    if scene.noise is not None:
        return {}
    prescribed = {"preload"}
    if scene.experiment.kind == "load" and scene.experiment.force == 0.0:
        prescribed |= {"force", "mean_pressure"}
    shares = {
        name: quantity.uncertainty / abs(quantity.value) if quantity.value else math.inf
        for name, quantity in quantities.items()
        if name not in prescribed and (quantity.value != 0.0 or name.endswith("radius"))
    }
    return {name: share for name, share in shares.items() if share > scene.accuracy.tolerance}


def left_open_by_spacing(scene: Scene, outcome: Outcome, names: Iterable[str]) -> set[str]:
    """Those of the named results that the spacing alone leaves less certain than the tolerance."""
    tolerance, known = scene.accuracy.tolerance, outcome.quantities
    return {name for name in names if outcome.lattice.get(name, 0.0) > tolerance * abs(known[name].value)}


def in_words(shares: Mapping[str, float]) -> str:
    """What `unmet` found: "critical_radius is known to 3.1e-04"."""
    return ", ".join(
        f"{name} is known to {share:.1e}" if share < 1.0 else f"{name} cannot be told from 0 and is known to 1 or worse"
        for name, share in shares.items()
    )


def _reaches_end(scene: Scene, profile: Profile) -> bool:
    """Whether the contact's edge, the largest tension or else the last loaded particle, is a chain's last particle.

    That of a flat punch is meant to be.
    """
    if isinstance(scene.bodies.profile, FlatPunch):
        return False
    pressure = profile.pressure
    if scene.interaction is not None and scene.interaction.attraction is not None:
        largest = float(pressure.min())
        inside = end_pressure_share(profile) > INSIDE  # the chain is shorter than the compressed middle
        return inside or (largest < 0.0 and largest in (pressure[0], pressure[-1]))
    return bool(max(pressure[0], pressure[-1]) > 0.0)


def doubts(scene: Scene, settings: Settings, states: tuple[State, ...]) -> dict[str, str]:
    """Named warnings about states that are results, but limited ones."""
    found = {}
    share = max(end_pressure_share(state.profile) for state in states)
    if not isinstance(scene.bodies.profile, FlatPunch) and share > END_SHARE_LIMIT * scene.accuracy.tolerance:
        found["chain_end"] = (
            f"the outermost particles carry up to {share:.2g} of the largest pressure, so the chain of "
            f'{settings.particles} particles cuts the contact: take more bodies.particles, or "auto"'
        )
    ends = reflected(scene, settings.estimate, settings.largest_displacement, settings.particles)
    if not isinstance(scene.bodies.profile, FlatPunch) and ends > scene.accuracy.tolerance:
        found["chain_end"] = (
            f"neighbour springs spread the load over {decay_length(scene):.3g} LU to each side, and the chain of "
            f"{settings.particles} particles ends so near to the contact that up to {ends:.1g} of that comes back from "
            'there: take more bodies.particles, or "auto"'
        )
    share = law_share(scene, settings)
    if share > scene.accuracy.tolerance:
        found["cutoff"] = (
            f"what is left out of the law (beyond a cutoff of {settings.cutoff:.3g} LU, by a table of particles that "
            f"all but stand on each other, or of a plane not quite rigid) changes a force by a share of up to "
            f'{share:.1g}, and the radii with it: take a longer interaction.cutoff, or "auto", or a smaller load'
        )
    if slow := slowness(scene, settings):
        found["slow"] = slow
    if settings.estimate.snaps and scene.experiment.kind in ("load", "pull_off"):
        found["snaps"] = (
            "the attraction of a pair of particles is steeper than its springs are stiff, so that pairs can snap "
            "together and apart: there are several equilibria under one load, and which one is reached depends on the "
            "way there. The uncertainties are those of this way; another preload or method may end in another "
            "equilibrium, a few particles wider or narrower. Stiffer springs or a longer range of the interaction "
            "leave one equilibrium only"
        )
    closest = min(state.smallest_distance for state in states)
    if settings.table is not None and closest < settings.table_from:
        error = settings.table.error_beyond(max(closest, settings.table.core))
        found["table_core"] = (
            f"opposite particles came as close as {closest:.3g} LU; the table was chosen for {settings.table_from:.3g} "
            f"LU and follows the law within {error:.1e} FU there"
        )
    return found
