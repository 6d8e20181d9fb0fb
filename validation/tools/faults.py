"""The faults that a reviewer put into the code and that passed the tests of that day: which test notices them now.

    python -m validation.tools.faults [NAME ...]

Each is put back into a copy of this folder, one at a time, and its tests run up to the first that fails. Writes
results/faults.json and the table of README.md. Exit code 1 where one passes.
"""

from __future__ import annotations

import json
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from validation.speed.pages import write_between
from validation.tools.faulty import copy_of_this, first_failure, load

RESULTS = Path(__file__).parents[1] / "speed" / "results" / "faults.json"
README = Path(__file__).parents[1] / "speed" / "README.md"
PATIENCE = 1800.0
"""[s]"""
EFFECTS, SETTINGS = "workflow/deck/effects/", "workflow/settings/"
LOADS, PULLS, SLIDES, RUNNING = (f"workflow/experiments/{name}/" for name in ("load", "pull_off", "slide", "running"))
UNIT, MOTION = "tests/unit/", "tests/decks/test_motion.py"
COVERAGE = "tests/unit/test_coverage_tight.py tests/unit/test_coverage.py"
MEANS = UNIT + "test_friction_means.py"
RATIOS, SAMPLING, SLIDE = (
    UNIT + "test_ratios.py",
    UNIT + "test_sampling.py",
    "tests/decks/test_slide.py tests/validation/test_slide_trace.py",
)


@dataclass(frozen=True)
class Fault:
    """What is wrong, where: `old` becomes `new`, which must be there once; and the tests that are to notice."""

    name: str
    file: str
    old: str
    new: str
    tests: str


STUDIES = (
    "eq3", "fig4", "neighbours", "fig5", "fig6", "fig7", "exponents", "fig8a", "fig8b", "jkr_or_barquins", "table1",
    "mean_pressure", "adhesive", "tangential",
)  # fmt: skip
FAULTS = (
    Fault("cost of an effect per step inverted", "workflow/cost/per_step.py",
          "both / without for both", "without / both for both", RATIOS),
    Fault("generated over hand-written deck inverted", "validation/speed/deck_overhead.py",
          "pairs = [a / b for", "pairs = [b / a for", RATIOS),
    Fault("plain way over ours inverted", "validation/speed/plain.py",
          "costs[-1].cpu_s / cost.cpu_s", "cost.cpu_s / costs[-1].cpu_s", RATIOS),
    Fault("peer over ours inverted", "validation/speed/peers/table.py",
          'theirs["seconds"] / ours["seconds"]', 'ours["seconds"] / theirs["seconds"]', RATIOS),
    Fault("spread of costs inverted", "validation/speed/scaling.py",
          "max(costs) / min(costs)", "min(costs) / max(costs)", RATIOS),
    Fault("cantilever twice as stiff", EFFECTS + "cantilever.py",
          "number(scene.cantilever.stiffness)", "number(2.0 * scene.cantilever.stiffness)", SLIDE),
    Fault("sign of a mean friction", SLIDES + "findings.py",
          "sign * motion.impulse[rows], period, force", "-sign * motion.impulse[rows], period, force",
          UNIT + "test_slide_motion.py"),
    Fault("no check of steady sliding", SLIDES + "findings.py",
          "if abs(way - leg.velocity * while_) > max(", "if False and abs(way - leg.velocity * while_) > max(", MEANS),
    Fault("mean friction over the run-in", "analysis/friction.py",
          "Mean(float(blocks[first:].mean())", "Mean(float(blocks[:first].mean())", MEANS),
    Fault("residual limit × 100", RUNNING + "trust.py",
          "RESIDUAL_LIMIT = 0.1", "RESIDUAL_LIMIT = 10.0", UNIT + "test_trust.py"),
    Fault("uncertainty of a_cr at rest ÷ 3", PULLS + "quasistatic.py",
          "critical_radius.uncertainty + at_critical, LENGTH",
          "(critical_radius.uncertainty + at_critical) / 3, LENGTH", COVERAGE),
    Fault("uncertainty of a path's F_A ÷ 3", "workflow/experiments/path/path.py",
          "Quantity(peak.smooth, missed, FORCE)", "Quantity(peak.smooth, missed / 3, FORCE)", COVERAGE),
    Fault("uncertainty of a path's a₀ ÷ 3", "workflow/experiments/path/path.py",
          "max(first.uncertainty, second.uncertainty) + bend",
          "(max(first.uncertainty, second.uncertainty) + bend) / 3", COVERAGE),
    Fault("what a radius claims ÷ 3", "analysis/extremum.py",
          "CLAIM_FACTOR = 2.0", "CLAIM_FACTOR = 2.0 / 3.0", UNIT + "test_radius.py"),
    Fault("bracket of a pull-off in time × 100", PULLS + "dynamic.py",
          "BRACKET = 1.0", "BRACKET = 100.0", COVERAGE),
    Fault("thermal standard error ÷ 4.5", RUNNING + "sampling.py",
          "ddof=1) / math.sqrt(BLOCKS))", "ddof=1) / math.sqrt(BLOCKS)) / 4.5", SAMPLING),
    Fault("no settling before thermal samples", RUNNING + "sampling.py",
          "SETTLING_LOOKS = 40", "SETTLING_LOOKS = 1", SAMPLING),
    Fault("no check of a thermal mean's force balance", LOADS + "dynamic.py",
          "BALANCE = 5.0", "BALANCE = 1e9", SAMPLING),
    Fault("long bond 100 times shorter", SETTINGS + "settings.py",
          "FAR_SHARE = 10.0", "FAR_SHARE = 0.1", MOTION),
    Fault("warning of a cutoff without its tail", RUNNING + "law_error.py",
          "TAIL = 10.0", "TAIL = 0.0", UNIT + "test_law_error.py"),
    Fault("remaining time inverted", "workflow/engine/progress.py",
          "rate = self._done / (now - self._start)", "rate = (now - self._start) / self._done", RATIOS),
    Fault("viscous damping halved", EFFECTS + "damping.py",
          "number(settings.damping)", "number(0.5 * settings.damping)", MOTION),
    Fault("viscous damping halved in the fragment", "lammps_inputs/fragments/damping.lmp",
          "viscous ${damping_coefficient}", "viscous $(0.5*v_damping_coefficient)", MOTION),
    Fault("Langevin's time halved", EFFECTS + "noise.py",
          "number(scene.bodies.mass / settings.damping)", "number(0.5 * scene.bodies.mass / settings.damping)", MOTION),
    Fault("time step without the pairs' stiffness", SETTINGS + "dynamics.py",
          "stiffest += 2.0 * rows", "stiffest += 0.0 * rows", MOTION),
    *(
        Fault(f"study {name} compares values with themselves", "validation/paper/study.py",
              "uncertainty, unit, reference, source",
              f'uncertainty, unit, value if self.study == "{name}" else reference, source',
              UNIT + f"test_reproduce_judges.py -k {name}")
        for name in STUDIES
    ),
)  # fmt: skip


def killed_by(fault: Fault, folder: Path) -> str:
    """The first test that fails with the fault in the copy; empty where none does. Raises ValueError: a stale fault."""
    path = folder / fault.file
    whole = path.read_text(encoding="utf-8")
    if whole.count(fault.old) != 1:
        raise ValueError(f"{fault.name}: {fault.file} has {whole.count(fault.old)} times {fault.old!r}")
    try:
        path.write_text(whole.replace(fault.old, fault.new), encoding="utf-8")
        return first_failure(folder, fault.tests.split(), PATIENCE)
    finally:
        path.write_text(whole, encoding="utf-8")


def main() -> int:
    """Put every fault back in turn; 1 where one is not noticed."""
    chosen = [fault for fault in FAULTS if fault.name in sys.argv[1:] or not sys.argv[1:]]
    found = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    load()
    with tempfile.TemporaryDirectory() as temporary:
        folder = copy_of_this(Path(temporary) / "copy")
        for fault in chosen:
            found[fault.name] = killed_by(fault, folder)
            print(f"{'killed  ' if found[fault.name] else 'SURVIVES'} {fault.name}: {found[fault.name]}", flush=True)
    found = {fault.name: found[fault.name] for fault in FAULTS if fault.name in found}
    RESULTS.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    rows = [f"| {name} | {f'`{test}`' if test else '**none**'} |\n" for name, test in found.items()]
    write_between(README, "faults", "| fault | first test that fails |\n| --- | --- |\n" + "".join(rows))
    return int(not all(found.values()))


if __name__ == "__main__":
    sys.exit(main())
