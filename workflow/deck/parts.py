"""What bodies, lower body, units and method bring to a deck, beside the effects."""

from __future__ import annotations

from collections.abc import Sequence

from contact1d.workflow.deck.box import bin_size
from contact1d.workflow.deck.effects import Contribution, Stage
from contact1d.workflow.deck.effects.base import number
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.units import DeckUnits
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

PLANE_DEPTH = 1e3
"""Distance of the wall's origin below the plane over the deepest expected displacement."""
MINIMISER_ITERATIONS = 20_000
RELAXATION = 0.1
"""First step of a relaxation over the time step of a run in time: ten times as much is 0.5/ω_max."""
GENTLE_RESIDUAL = 1e-3
"""Residual force over one particle's at which gentle moves have led into a minimum that Newton's method finishes."""
CHOSEN_BINS = ("far_bin", "wide_bin")
"""Variables with which effects choose the edge of a bin."""


def standing(scene: Scene, settings: Settings) -> list[Contribution]:
    """A body whose particles stand still, over a rigid plane that has their springs: by steps, or moved in time."""
    plane = _plane("standing_plane", scene, settings)
    if not scene.is_stepped:
        clock = {"time_step": number(settings.time_step)}
        return [
            Contribution("bodies", Stage.BODIES, ("standing_plate",)),
            plane,
            Contribution("dynamic", Stage.MOTION, ("clock",), clock),
        ]
    steps = ("sweep", "along") if scene.experiment.goes_along else ("sweep",)
    return [
        Contribution("bodies", Stage.BODIES, ("standing",)),
        plane,
        Contribution("quasistatic", Stage.MOTION, steps),
    ]


def moving(scene: Scene, settings: Settings) -> list[Contribution]:
    """Bodies whose particles find their own places, each on the spring of its bulk."""
    softer = min(settings.bulk_stiffness, scene.tangential_stiffness)
    coefficient = softer if settings.far else settings.bulk_stiffness
    found = [
        Contribution("bodies", Stage.BODIES, ("bodies",), {"bulk_bond_coefficient": number(coefficient / 2)}),
        Contribution("guide", Stage.GUIDE, ("guide",), {} if scene.horizontal is not None else {"guide_x": "0.0"}),
        _method(scene, settings),
    ]
    if scene.bodies.lower == "rigid_plane":
        found.append(_plane("rigid_plane", scene, settings))
    if scene.bodies.lower == "rigid_chain":
        found.append(Contribution("rigid_chain", Stage.GUIDE, ("rigid_chain",)))
    if scene.bodies.periodic:
        found.append(Contribution("periodic", Stage.BODIES, ("periodic",)))
    return found


def bins(scene: Scene, settings: Settings, brought: Sequence[Contribution]) -> list[Contribution]:
    """The edge of a bin, where LAMMPS's own or that chosen by what is `brought` makes too many."""
    chosen = [float(part.variables[name]) for part in brought for name in CHOSEN_BINS if name in part.variables]
    edge = bin_size(bodies(scene, settings), scene, settings, max(chosen, default=0.0))
    return [Contribution("bins", Stage.MOTION, ("bins",), {"bin_edge": number(edge)})] if edge else []


def own_units(units: DeckUnits) -> Contribution:
    """What takes numbers of a deck that has units of its own back to LU and FU."""
    variables = {"unit_length": number(units.length), "unit_force": number(units.force)}
    return Contribution("units", Stage.MOTION, ("units",), variables)


def _plane(fragment: str, scene: Scene, settings: Settings) -> Contribution:
    depth = PLANE_DEPTH * max(settings.largest_displacement, scene.bodies.spacing)
    variables = {
        "plane_position": number(-depth),
        "plane_reach": number(depth),
        "plane_half_stiffness": number(settings.plane_stiffness / 2),
    }
    if fragment == "rigid_plane":
        variables["plane_stiffness"] = number(settings.plane_stiffness)
    return Contribution("rigid_plane", Stage.SPRINGS, (fragment,), variables)


def _method(scene: Scene, settings: Settings) -> Contribution:
    if scene.method == "quasistatic":
        variables = {
            "force_tolerance": number(settings.force_tolerance),
            "minimiser_iterations": str(MINIMISER_ITERATIONS),
            "relaxation_step": number(RELAXATION * settings.time_step),
        }
        if settings.gentle:
            variables["gentle_move"] = number(settings.longest_move)
            variables["gentle_tolerance"] = number(GENTLE_RESIDUAL * settings.force_scale)
        return Contribution("quasistatic", Stage.MOTION, ("quasistatic",), variables)
    variables = {"time_step": number(settings.time_step)}
    return Contribution("dynamic", Stage.MOTION, ("dynamic",), variables, integrates="particles")
