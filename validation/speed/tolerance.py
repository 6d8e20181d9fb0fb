"""What accuracy costs: error against a reference that shares no code with the program, and time, by tolerance.

The spacing is left to the program, as all else that a scene may leave open.
"""

import statistics
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

import contact1d
from validation.figures import Panel, Series, figure
from validation.hard.cases import PAPER_BODIES, PAPER_LAW, PAPER_NUMBERS
from validation.references import hertz, indenters, interaction, mindlin, model
from validation.references.pull_off import pull_off
from validation.row import at_most
from validation.study import Bench, Findings, Study

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
DEFAULT = 1e-3
ROUNDS = 5
"""Runs of each, of which the median counts; the first one of a process is not among them."""
RADIUS, MODULUS, WORK = 10e-3, 60e9, 0.05
"""R [m], E* [Pa], W [N/m]."""
WIDTH, HEIGHT = 100e-6, 1e-6
"""Contact radius of a blunt body, and its height there [m]."""
FRICTION, DEPTH, SLIDING = 0.3, 1e-6, 0.5
"""μ, displacement of a ball [m], and the amplitude of a cycle over that from which on all slips."""


class Contact(NamedTuple):
    """A scene and the values of its results."""

    tables: Mapping[str, Any]
    exact: Mapping[str, float]

    def run(self, bench: Bench, name: str, tolerance: float) -> tuple[float, float]:
        """The largest relative error, and the time [s]."""
        scene = contact1d.read_scene({"title": name, **self.tables, "accuracy": {"tolerance": tolerance}})
        folder, times = bench.folder / name.replace(" ", "_"), []
        for _ in range(ROUNDS + 1):
            began = time.perf_counter()
            done = contact1d.run(scene, folder, figures=False)
            times.append(time.perf_counter() - began)
        errors = [abs(done.results[key].value / value - 1.0) for key, value in self.exact.items()]
        return max(errors), statistics.median(times[1:])


def ball(profile: Mapping[str, Any], experiment: Mapping[str, Any], **effects: Any) -> dict[str, Any]:
    """A body on a plane in SI, its spacing chosen by the program."""
    body = dict.fromkeys(("particles", "spacing", "bulk_stiffness"), "auto") | {"lower": "rigid_plane"}
    return {
        "bodies": body | {"profile": profile},
        "material": {"contact_modulus": MODULUS},
        "experiment": experiment,
        **effects,
    }


def contacts() -> dict[str, Contact]:
    """Five, each by another theory or solver."""
    sphere = {"kind": "parabola", "radius": f"{RADIUS!r} m"}
    force = float(hertz.hertz_force(DEPTH, RADIUS, MODULUS))
    adhesive = indenters.jkr(RADIUS, MODULUS, WORK)
    blunt = indenters.Indenter(HEIGHT / WIDTH**4, 4.0, MODULUS)
    amplitude = SLIDING * FRICTION * DEPTH
    cycles = {"amplitude": f"{amplitude!r} m", "number": 1, "points": 40}
    law = interaction.PairInteraction.of(*PAPER_NUMBERS)
    marks = pull_off(model.ChainModel(200, 0.83, law, radius=1000.0, neighbour_stiffness=0.3), 1.0)
    preload = f"{adhesive.pull_off_force()!r} N"
    return {
        "Hertz's ball": Contact(
            ball(sphere, {"kind": "load", "force": f"{force!r} N"}),
            {"displacement": DEPTH, "contact_radius": float(hertz.hertz_contact_radius(DEPTH, RADIUS))},
        ),
        "blunt body, z ∝ r⁴": Contact(
            ball({"kind": "power", "exponent": 4.0, "radius": f"{WIDTH!r} m", "height": f"{HEIGHT!r} m"},
                 {"kind": "load", "force": f"{float(blunt.force(WIDTH))!r} N"}),
            {"displacement": float(blunt.displacement(WIDTH)), "contact_radius": WIDTH},
        ),
        "JKR's ball": Contact(
            ball(sphere, {"kind": "pull_off", "preload": preload}, adhesion={"work_of_adhesion": f"{WORK!r} J/m²"}),
            {"adhesion_force": adhesive.pull_off_force(), "zero_load_radius": adhesive.zero_load_radius()},
        ),
        "Mindlin's cycle": Contact(
            ball(sphere, {"kind": "tangential", "normal_displacement": f"{DEPTH!r} m", "cycles": cycles},
                 friction={"coefficient": FRICTION}),
            {"dissipated_energy_per_cycle": mindlin.mindlin_loop_area(amplitude, force, FRICTION, FRICTION * DEPTH)},
        ),
        "pull-off of two chains": Contact(
            {"bodies": PAPER_BODIES | {"reduction": "geike_popov"}, "interaction": PAPER_LAW,
             "neighbours": {"stiffness": 0.3}, "experiment": {"kind": "pull_off", "preload": 1.0}},
            {"adhesion_force": marks.adhesion_force},
        ),
    }  # fmt: skip


def measure(bench: Bench) -> Findings:
    """A row for each contact and tolerance, and error over time."""
    rows = []
    lines, defaults = [], []
    for name, contact in contacts().items():
        found = np.asarray([contact.run(bench, name, tolerance) for tolerance in TOLERANCES])
        lines.append(Series(name, found[:, 1], found[:, 0]))
        defaults.append(found[TOLERANCES.index(DEFAULT)])
        rows += [
            at_most(f"largest relative error over the tolerance {tolerance:g}: {name}", error / tolerance, 1.0,
                    "asked for", "the run", "closed form")
            for tolerance, (error, _) in zip(TOLERANCES, found, strict=True)
        ]  # fmt: skip
    errors, times = np.transpose(defaults)
    lines.append(Series(f"as it is by default, tolerance {DEFAULT:g}", times, errors))
    panel = Panel("time of a run (s)", "largest relative error of the results", lines, log="xy")
    caption = "Error of five contacts over the time of a run at tolerances of 10⁻² to 10⁻⁵"
    return Findings(rows, figure(caption, panel))


TOLERANCE = Study("tolerance", "Error and time by tolerance", "What does accuracy cost?", measure)
