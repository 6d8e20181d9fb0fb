"""Random scenes of many particles that do not snap: bodies, law, effects, experiment and tolerance, with their numbers
by the independent solver."""

import math
from contextlib import suppress
from random import Random

from validation.doors import IN_TIME, law_table, read_scene, settings_for
from validation.hard.judge import OF_ALL, REFUSED, Case, Expected, Judge
from validation.hard.units import Scene
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.solver import ChainSolver, State
from validation.references.tension_radius import band_limited_radius
from validation.study import Bench, Lines, Refused, Study

QUICK, FULL = 10, 200
SEED = 20071
SOLVER = 2e-6
"""Relative error of the solver's forces and radii themselves."""
COARSE = 0.125
"""First steps of the solver's search over the shortest range: enough where no particle snaps."""
FARTHEST = 5.0
"""Distance of a displacement from the estimate's over that, from which on chains that buckled are what it leads to."""
PATHS, TIMED = 0.2, 0.25
"""Shares of the scenes that are made paths, and that are run in time."""
APART = 12.0
"""Where a path begins and ends, over the range of the attraction."""


def measure(bench: Bench) -> Lines:
    """Rows of all of them; chains of the reference that buckle through each other are a scene that nothing carries."""
    random, judge = Random(SEED), Judge(OF_ALL)
    for number in range(FULL if bench.full else QUICK):
        scene, name = varied(random_scene(random), random), f"random_{number}"
        group = f"{scene['experiment']['kind']} {scene['experiment'].get('method', 'quasistatic')}"
        run = bench.run(name, scene)
        with suppress(RuntimeError):
            if isinstance(run, Refused):
                expected = settings_for(read_scene({"title": "expected"} | scene))
                particles, near = expected.chains.upper, expected.largest_displacement
            else:
                particles = next(iter(run.profiles.values())).x.size
                near = run.results["displacement"].value if "displacement" in run.results else 0.0
            exact = exact_results(scene, model_of(scene, particles), near)
            judge.add(Case(name, group, group, scene, Expected(exact, SOLVER)), run)
    return judge.rows("random scenes", "the independent solver", REFUSED)


def varied(scene: Scene, random: Random) -> Scene:
    """The scene, some of them a path in place of a pull-off, and more of them in time."""
    experiment = scene["experiment"]
    path, timed = random.random() < PATHS, random.random() < TIMED
    if experiment["kind"] == "pull_off" and "horizontal" not in scene and "plate" not in scene and path:
        far, deepest = scene["interaction"]["attraction"]["range"], settings_for(read_scene(scene)).largest_displacement
        way = {"from": -APART * far, "to": deepest, "steps": random.randrange(40, 200)}
        return scene | {"experiment": {"kind": "path", "displacements": way}}
    if timed and "interaction" in scene and "plate" not in scene:
        return scene | IN_TIME | {"experiment": experiment | {"method": "dynamic"}}
    return scene


def random_scene(random: Random) -> Scene:
    """A pull_off or a load of two chains, or a load of one chain on the rigid plane."""
    spacing = 2.0 ** random.uniform(-2.0, 2.0)
    stiffness = random.uniform(0.4, 2.0) * spacing
    radius = 10.0 ** random.uniform(1.7, 2.5) * spacing  # the solver takes seconds for thousands of particles
    scene: Scene = {
        "title": "random",
        "bodies": {
            "particles": "auto",
            "spacing": spacing,
            "profile": {"kind": "parabola", "radius": radius},
            "bulk_stiffness": stiffness,
        },
        "accuracy": {"tolerance": 10.0 ** random.uniform(-4.0, -2.0)},
    }
    if random.random() < 0.5:
        scene["neighbours"] = {"stiffness": random.uniform(0.05, 1.0) * stiffness}
    if random.random() < 0.1:
        scene["bodies"]["lower"] = "rigid_plane"
        depth = (random.uniform(3.0, 30.0) * spacing) ** 2 / radius  # of a contact so many spacings wide
        scene["experiment"] = {"kind": "load", "force": stiffness * depth * math.sqrt(radius * depth) / spacing}
        return scene
    scene["interaction"], force = random_law(random, spacing, stiffness, radius)
    if random.random() < 0.3:
        scene["horizontal"] = {}
    kind, key = ("pull_off", "preload") if random.random() < 0.7 else ("load", "force")
    scene["experiment"] = {"kind": kind, key: force}
    if random.random() < 0.15:
        scene |= IN_TIME
        scene["experiment"]["method"] = "dynamic"
    return scene


def random_law(random: Random, spacing: float, stiffness: float, radius: float) -> tuple[Scene, float]:
    """A law that reaches from a fifth of the spacing to all of it, no pair so strong that it snaps, and a load [FU].

    A pair snaps where its tension rises by k/2 per length; here by a tenth of that at most, as in the paper's contact,
    and less where a row of particles acts together. The load is 0.5 to 6 times the pull-off force, roughly.
    """
    reach = random.uniform(0.2, 1.0) * spacing
    strength, shorter = random.uniform(1.8, 3.0), random.uniform(1.7, 2.5)
    unit = PairInteraction.of(strength, reach / shorter, 1.0, reach)
    rows = 1.0 + 2.0 * reach / spacing
    amplitude = random.uniform(0.02, 0.1) * 0.5 * stiffness / unit.steepest_rise / rows**2
    law = law_table(strength * amplitude, reach / shorter, amplitude, reach)
    return law, random.uniform(3.0, 20.0) * (amplitude * unit.largest_tension) * math.sqrt(radius * reach) / spacing


def model_of(scene: Scene, particles: int) -> ChainModel:
    """The solver's model of a scene, of so many particles per body."""
    bodies = scene["bodies"]
    law = None
    if "interaction" in scene:
        near, far = (Exponential(**scene["interaction"][name]) for name in ("repulsion", "attraction"))
        law = PairInteraction(near, far)
    return ChainModel(
        particles,
        bodies["bulk_stiffness"],
        law,
        radius=bodies["profile"]["radius"] * (0.5 if law is None else 1.0),  # the MDR's parabola on the plane
        spacing=bodies["spacing"],
        neighbour_stiffness=scene.get("neighbours", {"stiffness": 0.0})["stiffness"],
        horizontal="horizontal" in scene,
        rigid_plane=law is None,
    )


def loaded(model: ChainModel, force: float, near: float) -> State:
    """The solver's state under a compressive force, by the secant method from a displacement that is near.

    Raises:
        RuntimeError: there is none within FARTHEST, or a minimisation does not converge.
    """
    solver = ChainSolver(model)
    first, second = solver.equilibrium(near), solver.equilibrium(near * (1.0 + 1e-4) + 1e-6)
    for _ in range(20):
        if abs(second.force - force) <= 1e-10 * force:
            return second
        slope = (second.force - first.force) / (second.displacement - first.displacement)
        place = second.displacement + (force - second.force) / slope if slope else math.inf
        if abs(place - near) > FARTHEST * abs(near):
            raise RuntimeError("no displacement near the estimate's carries the load")
        first, second = second, solver.equilibrium(place, second)
    raise RuntimeError("the secant method did not end")


def radius_of(model: ChainModel, state: State) -> float:
    """Of the largest tension; on the plane of a chain without neighbour springs √(2 R d), which is exact."""
    if model.rigid_plane:
        assert model.radius is not None
        return math.sqrt(2.0 * model.radius * state.displacement)
    return band_limited_radius(model.places(), state.pair_force[:, 1])


def exact_results(scene: Scene, model: ChainModel, near: float) -> dict[str, float]:
    """Main results by the solver, a load's from a displacement [LU] that is near.

    Those of a path are those of a pull-off from any load, since nothing snaps. On the plane neighbour springs leave the
    edge of a contact between two particles.
    """
    experiment = scene["experiment"]
    if experiment["kind"] != "load":
        assert model.interaction is not None
        found = pull_off(model, experiment.get("preload", 0.0), COARSE * model.interaction.shortest_range)
        return {
            "adhesion_force": found.adhesion_force,
            "zero_load_radius": radius_of(model, found.zero_load),
            "critical_radius": radius_of(model, found.critical),
        }
    state = loaded(model, experiment["force"], near)
    if model.rigid_plane and model.neighbour_stiffness > 0.0:
        return {"displacement": state.displacement}
    radius = radius_of(model, state)
    pressure = experiment["force"] / (math.pi * radius**2)
    return {"displacement": state.displacement, "contact_radius": radius, "mean_pressure": pressure}


RANDOM = Study(
    "random",
    "Random scenes of two chains that do not snap",
    "Is every result of two hundred random scenes within its uncertainty?",
    measure,
)
