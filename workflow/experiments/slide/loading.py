"""The way to rest under the normal force, from which a slide starts.

A plate with little drag swings as it is loaded, past its place and through the other body: so the particles have a drag
of their own on the way, critical for the contact, and at rest that of the scene again. It counts as at rest where it
is along both directions, the friction equal to the pull of the cantilever.
"""

from __future__ import annotations

from dataclasses import replace

from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.holding import MOST_HOLDS, Start, at_rest, hold, hold_row
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps, sampled_phase
from contact1d.workflow.experiments.running.trust import PartedError, RestlessError, require_trust
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings


def loading_phase(scene: Scene, settings: Settings, force: float) -> Phase:
    """The planned way: that it takes no longer than usual."""
    if scene.noise is not None:
        return sampled_phase("loading", settings, force, SETTLING_LOOKS)
    scale = abs(force) or settings.force_scale
    rows = [hold_row(scene, _calm(settings), force, scale, Start.KEPT)]
    if settings.calm_damping != settings.damping:
        rows.append(hold_row(scene, settings, force, scale, Start.HERE))
    return Phase("loading", tuple(rows))


def loaded(contact: Contact, force: float) -> State:
    """At rest under the normal force; with noise, after it has forgotten its start.

    Raises:
        PartedError: the bodies part under it.
        UntrustedError: see `hold`; or the plate swings on along x.
    """
    scene, settings = contact.scene, contact.settings
    if scene.noise is not None:
        steps = chunk_steps(settings)
        contact.begin("loading", expected_steps=SETTLING_LOOKS * steps)
        return [contact.row(UnderLoad(force, steps)) for _ in range(SETTLING_LOOKS)][-1]
    contact.begin("loading")
    scale = abs(force) or settings.force_scale
    held = hold(contact, force, scale, settings=_calm(settings))
    if not held.held:
        raise PartedError(f"the bodies do not hold a normal force of {force:.4g} FU: they part", "take a smaller pull")
    state = _settled_along(contact, force, scale, held.last)
    if settings.calm_damping == settings.damping:
        return state
    return contact.row(hold_row(scene, settings, force, scale, Start.HERE))


def _calm(settings: Settings) -> Settings:
    return replace(settings, damping=settings.calm_damping)


def _settled_along(contact: Contact, force: float, scale: float, state: State) -> State:
    """The state when the plate has come to rest along x, too."""
    scene, settings = contact.scene, _calm(contact.settings)
    row = replace(hold_row(scene, settings, force, scale, Start.HERE), rest=0.0)
    row = replace(row, steps=max(1, round(settings.settle_time / settings.time_step)))
    near, drag = at_rest(settings, scale), settings.particles * settings.damping + settings.plate_damping
    for _ in range(MOST_HOLDS):
        friction = -scene.bodies.own_spacing * float(state.profile.shear.sum())
        if max(abs(friction - state.cantilever_force), drag * abs(state.motion["vcm(plate,x)"])) <= near:
            return state
        state = contact.row(row)
        require_trust(scene, settings, state)
    speed = state.motion["vcm(plate,x)"]
    raise RestlessError(
        f"the plate did not come to rest along x under {force:.4g} FU within {MOST_HOLDS * row.steps} timesteps: it is "
        f"left with {speed:.2g} LU/TU",
        "more [damping] or a stiffer cantilever settles it sooner",
    )
