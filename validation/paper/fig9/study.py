"""The study `fig9`: all shipped sweeps of slides and both shipped scenes, their rows and figures."""

from validation.doors import Run, Scene, read_scene, shipped
from validation.figures import Drawing
from validation.paper.fig9 import asperity
from validation.paper.fig9.curved import curved_checks
from validation.paper.fig9.reading import SWEEPS, slides
from validation.row import Reference, Row
from validation.study import Bench, Findings, Rows, Scenes, Study, found

SHIPPED = ("slide", "prandtl_tomlinson")
"""The slides that ship as scenes."""
CLOSED = 5e-3
"""Work that is neither dissipated nor stored, over the largest of the three: the bound that was asked for."""
CAPTIONS = {
    "load": "Friction over the normal load: adhesion leaves some at no load, and some under a pull",
    "radius": "Friction over the radius under one load: the flatter the body, the more particles take part",
    "velocity": "Friction over v^{2/3}, the power of theory for v → 0 where the particle sticks and slips",
    "temperature": "Friction over the temperature: heat carries the particle over the remaining barrier",
    "stiffness": "From stick-slip to smooth sliding: a stiffer cantilever ends the slips, and slow friction",
    "flats": "Flat on flat: of one spacing it sticks; of others its friction is steady, and ends with stiff springs",
}


def scenes(_: Scene) -> Scenes:
    """The points of all sweeps, and the shipped slides."""
    return {name: read_scene(shipped(f"scenes/{name}.toml")) for name in SHIPPED} | {
        slides(sweep).names[place]: scene for sweep in SWEEPS for place, scene in slides(sweep).scenes.items()
    }


def judge(bench: Bench) -> Findings:
    """One law after the other."""
    row = Rows(bench.runs)
    particle, of_particle = asperity.load_checks(row)
    velocity, over_velocity = asperity.velocity_checks(row)
    warmth, over_temperature = asperity.temperature_checks(row)
    stiffness, over_stiffness = asperity.stiffness_checks(row)
    lattices, traces = asperity.lattice_checks(row)
    flats, over_springs = asperity.flat_checks(row)
    curved, over_load, over_radius = curved_checks(row)
    panels = (
        (of_particle, over_load),
        (over_radius,),
        (over_velocity,),
        (over_temperature,),
        over_stiffness,
        (traces, over_springs),
    )
    figures = {name: Drawing(caption, shown) for (name, caption), shown in zip(CAPTIONS.items(), panels, strict=True)}
    finding = (
        "A curved body slides, with adhesion and without a load, as the independent integrator has it. One particle is "
        "Prandtl's and Tomlinson's over load, velocity and the cantilever's stiffness; heat lowers its friction by as "
        "much as Smoluchowski's equation says. A commensurate flat is so many particles, and an incommensurate one is "
        "free above a stiffness that is that of particles that share one height. The cantilever's work is dissipated "
        "or stored."
    )
    rows = [*curved, *particle, *velocity, *warmth, *stiffness, *lattices, *flats, *energy_checks(row)]
    return Findings(rows, figures, text=finding)


def energy_checks(row: Rows) -> list[Row]:
    """Work of the cantilever beside what is dissipated and stored: both shipped slides, and the worst of all others."""
    names = [name for sweep in SWEEPS for name in slides(sweep).every]
    others = ("tolerance", "unknown", "drag", "fast", "energy")
    answers = dict.fromkeys(others, "the energies are asked for, and no mean")
    compared = {f"work that is neither dissipated nor stored, {name}.toml": [name] for name in SHIPPED}
    return [
        row.at_most(words, max(open_energy(row.runs[name]) for name in on),
            Reference(CLOSED, "bound that was asked for", "set bound"), "the drag is sampled at every fifth step",
            on=on, despite=answers, wide="timesteps are chosen for the means, and the energy follows")
        for words, on in (compared | {f"the same, worst of {len(names)} slides of the sweeps": names}).items()
    ]  # fmt: skip


def open_energy(run: Run) -> float:
    """|W − Q − ΔE| over the largest of the three."""
    work, lost, stored = (found(run, name).value for name in ("cantilever_work", "dissipated_energy", "stored_energy"))
    return abs(work - lost - stored) / max(abs(work), abs(lost), abs(stored))


STUDY = Study(
    "fig9",
    "Outlook, Fig. 9: friction of bodies of particles",
    "Fig. 9 shows the set-up of a friction experiment, a normal force and a cantilever that pulls, and no result. "
    "So this is an outlook: its rows hold what the program makes of the set-up against theory and an independent "
    "integrator, none against the paper.",
    judge,
    scenes,
)
