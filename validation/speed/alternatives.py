"""What was measured and decided against: other styles of `pair_style table`, and another scheme for thermal noise.

    python -m validation.speed.alternatives      # two minutes; writes a table of validation/speed/README.md

No deck has any of it: here the effect [interaction] is replaced by one that asks for another style, and lines in the
text of a deck by `fragments/noise_gjf.lmp`. Away from the contact a chain is made of springs, whose matrix K = k + k_n
(second difference with free ends) gives each thermal scheme's aim,

    ⟨u_i²⟩ = k_BT (K⁻¹)_ii,      u_i a particle's displacement along z from its place in the bulk.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.potentials.table import Table
from contact1d.workflow.cost.change import base_change
from contact1d.workflow.cost.errors import main_results
from contact1d.workflow.cost.study import reference_of
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects import EFFECTS, Contribution
from contact1d.workflow.deck.fragments import fragment
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.runs.campaign import RunError, run
from contact1d.workflow.scene import Scene, read_scene
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.units import Quantity
from validation.judging.markdown import table
from validation.speed.pages import write_between

Array = NDArray[np.float64]
HERE = Path(__file__).parent
SCENES = HERE.parent / "lammps_inputs" / "scenes"
STYLE_POINTS = {
    "spline": (1_000, 2_000, 4_000, 16_000),
    "linear": (1_000, 4_000, 16_000, 64_000),
    "lookup": (1_000, 8_000, 64_000),
    "bitmap": (1_024, 8_192, 65_536),
}
SCHEMES = ("langevin", "gjf")
FACTORS = (1.0, 2.0, 4.0, 8.0)
"""Time steps over the scene's own."""
STEPS, STRIDE, BLOCKS = 60_000, 50, 20
"""Steps of each scheme, between two samples, and blocks whose means give the standard error."""
FORGET = 0.1
"""Part of the steps that come before the first sample."""
APART = 10.0
"""Distance that the bodies are moved apart by, over cutoff and largest displacement."""


@contextmanager
def table_style(style: str) -> Iterator[None]:
    """Decks that are made meanwhile have `pair_style table <style>`; the points are those of the settings' table."""
    usual = EFFECTS["interaction"]

    def other(scene: Scene, settings: Settings) -> Contribution:
        assert settings.table is not None
        points = settings.table.points
        size = points.bit_length() - 1 if style == "bitmap" else points  # a bitmap has 2^size entries
        return replace(usual(scene, settings), pair_style=f"table {style} {size}")

    EFFECTS["interaction"] = other
    try:
        yield
    finally:
        EFFECTS["interaction"] = usual


def style_row(scene: Scene, style: str, points: int, best: Mapping[str, Quantity], folder: Path) -> tuple[str, ...]:
    """Style, points, largest relative error of the main results, processor time; or why there are none."""
    settings = settings_for(scene)
    assert settings.law is not None
    settings = replace(settings, table=Table(settings.law, settings.cutoff, points))
    try:
        with table_style(style):
            done = run(scene, folder, figures=False, settings=settings)
    except RunError as error:
        return style, str(points), error.message.split(":")[0], ""
    found = main_results(scene, done.outcome.quantities)
    error = max(abs(found[name].value / best[name].value - 1.0) for name in best)
    return style, str(points), f"{error:.1e}", f"{done.results['timing']['lammps_cpu_s']:.2g} s"


def styles_markdown(folder: Path) -> str:
    """Every style with every number of points in the shipped pull-off, all else at a tolerance of 1e-5."""
    scene = read_scene(SCENES / "pull_off.toml")
    label, best = reference_of(scene, folder)
    scene = base_change(scene).scene(scene)
    rows = [
        style_row(scene, style, n, best, folder / f"{style}_{n}") for style, many in STYLE_POINTS.items() for n in many
    ]
    head = ("table style", "points", f"largest error against {label}", "CPU")
    return table(head, rows)


@dataclass(frozen=True)
class Sampling:
    """One scheme at one time step.

    Attributes:
        scheme: of SCHEMES.
        time_step: [TU].
        us_per_step: processor time in LAMMPS [µs].
        variance: ⟨u²⟩ of all particles along z over that of equipartition.
        error: its standard error after the steps of all.
    """

    scheme: str
    time_step: float
    us_per_step: float
    variance: float
    error: float


def samplings(scene: Scene, folder: Path, steps: int = STEPS) -> tuple[Sampling, ...]:
    """Every scheme at every time step, for a scene with noise."""
    own = settings_for(scene).time_step
    return tuple(_sampled(scene, s, f * own, folder / f"{s}_{f:g}", steps) for s in SCHEMES for f in FACTORS)


def _sampled(scene: Scene, scheme: str, time_step: float, folder: Path, steps: int) -> Sampling:
    deck = Deck(scene, replace(settings_for(scene), time_step=time_step))
    assert scene.noise is not None
    expected = scene.noise.temperature * _flexibility(deck)
    folder.mkdir(parents=True)
    write_system(deck, folder)
    with Engine.session(folder) as session:
        session.execute(with_gjf(deck) if scheme == "gjf" else deck.head, phase="setting up")
        rest = _parted(session, deck)
        session.execute(f"run {int(FORGET * steps)} post no")
        before = session.lammps_cpu_seconds
        squares = _squares(session, rest, deck.settings.particles * scene.chains, steps // STRIDE)
        cpu = session.lammps_cpu_seconds - before
    means = [float(block.mean()) for block in np.array_split(squares / expected, BLOCKS)]
    error = float(np.std(means, ddof=1)) / np.sqrt(BLOCKS)
    return Sampling(scheme, time_step, 1e6 * cpu / steps, float(np.mean(means)), float(error))


def with_gjf(deck: Deck) -> str:
    """The deck's head with `fix langevin … gjf` in place of its thermostat.

    It must be told which directions are free, and stands after the guide: at the start of every run it turns forces
    into velocities, also those that the guide is about to take away.
    """
    usual, guide = (fragment(name).commands for name in ("noise", "guide"))
    free = f"variable        noise_free_x index {int(deck.scene.horizontal is not None)}\n"
    text = free + (HERE / "fragments" / "noise_gjf.lmp").read_text(encoding="utf-8")
    for block in (usual, guide):
        if deck.head.count(block) != 1:
            raise ValueError(f"the deck's head does not have this once:\n{block}")
    return deck.head.replace(usual, "").replace(guide, guide + text)


def _parted(session: Session, deck: Deck) -> Array:
    """Move the bodies out of each other's reach, and say where along z [LU] all atoms are at rest there."""
    far = APART * (deck.settings.cutoff + abs(deck.settings.largest_displacement) + deck.scene.bodies.spacing)
    session.execute(f"displace_atoms upper_body move 0.0 0.0 {far!r} units box")
    return session.atoms("x")["x"][:, 2]


def _squares(session: Session, rest: Array, count: int, samples: int) -> Array:
    """u² [LU²] of the first `count` atoms, the particles; the next ones are their anchors. Shape (samples, count)."""
    found = []
    for _ in range(samples):
        session.execute(f"run {STRIDE} pre no post no")  # a set-up would add an error of its own, of gjf above all
        moved = session.atoms("x")["x"][:, 2] - rest
        found.append((moved[:count] - moved[count : 2 * count]) ** 2)
    return np.array(found)


def _flexibility(deck: Deck) -> float:
    """Mean of (K⁻¹)_ii [LU/FU]."""
    springs = deck.scene.neighbours
    matrix = deck.settings.bulk_stiffness * np.eye(deck.settings.particles)
    if springs is not None:
        ends = np.diff(np.eye(deck.settings.particles), axis=0)
        matrix += springs.stiffness * ends.T @ ends
    return float(np.mean(np.diag(np.linalg.inv(matrix))))


def thermostats_markdown(folder: Path) -> str:
    """Both schemes in the shipped scene with noise."""
    head = ("thermostat", "time step", "a step", "variance over equipartition")
    rows = [
        (one.scheme, f"{one.time_step:.3g} TU", f"{one.us_per_step:.1f} µs", f"{one.variance:.4f} ± {one.error:.4f}")
        for one in samplings(read_scene(SCENES / "thermal_load.toml"), folder)
    ]
    return table(head, rows)


def main() -> None:
    """The command."""
    with tempfile.TemporaryDirectory() as place:
        text = styles_markdown(Path(place)) + "\n" + thermostats_markdown(Path(place))
    write_between(HERE / "README.md", "alternatives", text)
    print(text)


if __name__ == "__main__":
    main()
