"""docs/grains.md from the record of the studies: its tables, between markers, its figures, and grains.yaml."""

import json
import math
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from validation.figures import Drawing, Panel, Series, save
from validation.grains import cases
from validation.grains.cases import GIVEN, OURS, SPHERES, at_number, at_psi, at_step, at_velocity, near_name, row_name
from validation.grains.studies import ABOUT, AGREES, CHI, LATE, LENGTH, TENSION
from validation.page import measured, number, table, write_between
from validation.references.grains import kelvin_voigt
from validation.references.oblique import of_power
from validation.row import Row, tables_beside
from validation.study import Record

DENSE = 25
"""Points of a line."""
HEAD = ("model", "quantity", "LAMMPS", "exact", "deviation", "what to use")
SOLVED, ROUND_OFF = 1e-5, 1e-8
"""Uncertainties of the references of the page: of motions that are integrated, and of closed forms."""
NOWHERE, STICK = "–", "the spheres stick"
TABLES = tables_beside(__file__)
QUANTITIES = TABLES["quantities"]
JKR_IN_NAMES = {"jkr": "`jkr`", "dmt": "`dmt`", "nearest jkr": f"`jkr`, {cases.STRONGER:g} γ"}


class Rows(dict[str, Row]):
    """All rows of a record by name."""

    def __init__(self, record: Record) -> None:
        """Of all studies."""
        super().__init__({row.name: row for row in record.rows})

    def ours(self, at: str, quantity: str) -> str:
        """A cell for the program's own result."""
        row = self[row_name(OURS, at, quantity)]
        return measured(row.value, row.uncertainty, "1") if row.value else STICK

    def of(self, models: Sequence[cases.Model], at: str, quantity: str = "restitution") -> list[Row]:
        """The rows of models at the same place."""
        return [self[row_name(model.name, at, quantity)] for model in models]

    def beside(self, A: float, quantity: str = "restitution") -> list[str]:
        """Cells of a Kelvin-Voigt body: what is exact, the program's own, LAMMPS's without and with a limit."""
        found = self.of(cases.DAMPED, at_number(A), quantity)
        return [value(found[0].reference.value), self.ours(at_number(A), quantity), *map(both, found)]


def value(number: float) -> str:
    """Four digits, as decimals of a restitution; what is 0 within ABOUT is shown to its decimals, without a sign."""
    text = f"{number:.3f}" if abs(number) < ABOUT or abs(number) >= 2.0 else f"{number:.4f}"
    return text.replace("-", "−" if float(text) else "")


def deviation(row: Row) -> str:
    """Of LAMMPS from what is exact, in percent; 0 within what a row allows."""
    if not row.reference.value:
        return NOWHERE if abs(row.value) > AGREES else "0"
    part = row.value / row.reference.value - 1.0
    return "0" if abs(part) <= AGREES else f"{'+' if part > 0.0 else ''}{number(100.0 * part, 2)} %"


def both(row: Row) -> str:
    """Value and deviation."""
    return f"{value(row.value)} ({deviation(row)})" if row.known else value(row.value)


def apart(row: Row, decimals: int) -> str:
    """Value and difference."""
    return f"{value(row.value)} ({row.value - row.reference.value:+.{decimals}f})".replace("-", "−")


def write(record: Record) -> None:
    """The page, its figures and its numbers as data."""
    folder = Path(__file__).parent
    for name, text in blocks(record).items():
        write_between(folder / "grains.md", name, text)
    (folder / "grains.yaml").write_text("".join(unit_tests(record)), encoding="utf-8")
    for name, drawing in drawings(record).items():
        save(drawing, folder / name)


def blocks(record: Record) -> dict[str, str]:
    """What stands between the markers of docs/grains.md, by their name."""
    rows = Rows(record)
    return {
        "version": f"Measured {record.answers[0].date} with {version(record.versions['lammps'])}.\n",
        "models": table(HEAD, _models(rows)),
        "viscoelastic": _viscoelastic(rows),
        "times": _times(rows),
        "asked": _asked(rows),
        "nearest": _nearest(rows),
        "adhesive": _adhesive(rows),
        "drawn": _drawn(rows),
        "mdr": _mdr(rows),
        "oblique": _oblique(rows),
        "chung_ooi": _chung_ooi(rows),
        "wall": _wall(rows),
    }


def version(package: str) -> str:
    """The version of its package by LAMMPS's own name.

    >>> version("2025.7.22.4.0")
    'LAMMPS 22 Jul 2025, update 4'
    """
    year, month, day, update, *_ = (int(part) for part in f"{package}.0".split("."))
    names = "JanFebMarAprMayJunJulAugSepOctNovDec"
    return f"LAMMPS {day} {names[3 * month - 3 : 3 * month]} {year}{f', update {update}' if update else ''}"


def _models(rows: Rows) -> Iterator[Sequence[str]]:
    near = {name: f"{all_of[1]:g}" for name, all_of in GIVEN.nearest.items()}
    eta = f"`limit_damping` and η = {near[cases.LIMITED.name]} · 2 E* τ/m"
    stronger = f"a surface energy of {cases.STRONGER:g} γ, if restitution matters more than pull-off"
    for model, shown, at, quantity, use in TABLES["models"]:
        row = rows[row_name(model, at, quantity)]
        where = f"{QUANTITIES.get(quantity, quantity)}{', ' * bool(at)}{at}"
        yield (
            shown,
            where,
            value(row.value),
            value(row.reference.value),
            deviation(row),
            use.format(eta=eta, stronger=stronger),
        )


def _viscoelastic(rows: Rows) -> str:
    lines = [[f"{A:g}", *rows.beside(A)] for A in GIVEN.numbers]
    return table(["A", "exact restitution", OURS, *map(_words, cases.DAMPED)], lines)


def _times(rows: Rows) -> str:
    names = ("contact_time", "peak_force")
    lines = [[f"{A:g}", QUANTITIES[name], *rows.beside(A, name)] for A in GIVEN.timed for name in names]
    return table(["A", "quantity", "exact", OURS, *map(_words, cases.DAMPED)], lines)


def _asked(rows: Rows) -> str:
    lines = [[f"{e:g}", *map(both, rows.of(cases.BY_RESTITUTION, f"e = {e:g}"))] for e in GIVEN.asked]
    return table(["given restitution", *map(_words, cases.BY_RESTITUTION)], lines)


def _words(model: cases.Model) -> str:
    return f"`{model.name.replace(' ', '` with `')}`"


def _nearest(rows: Rows) -> str:
    lines = []
    for place, A in enumerate(GIVEN.timed):
        for model in cases.FITTED:
            found = [rows[near_name(model, A, v)] for v in cases.DECADE]
            given = GIVEN.nearest[model.name][place]
            words = f"e = {given:g}" if model is cases.RESTITUTION else f"η = {given:g} · 2 E* τ/m"
            lines.append([f"{A:g}", _words(model), words, *(apart(row, 4) for row in found)])
    return table(["A", "model", "nearest coefficient", "e at v/√10", "at v", "at √10 v"], lines)


def _adhesive(rows: Rows) -> str:
    lines = []
    for over in GIVEN.over:
        at = at_velocity(over)
        found = [rows.get(row_name(name, at, "restitution")) for name in JKR_IN_NAMES]
        assert found[0]
        exact = value(found[0].reference.value) if over > 1.0 else STICK
        cells = [both(row) if row and row.reference.value else value(row.value) if row else NOWHERE for row in found]
        lines.append([f"{over:g}", exact, rows.ours(at, "restitution"), *cells])
    return table(["v/v_s", "exact restitution, JKR", OURS, *JKR_IN_NAMES.values()], lines)


def _drawn(rows: Rows) -> str:
    lines = []
    for name in ("pull off", "separation", "dissipated"):
        jkr, dmt = (rows[row_name(model, "", name)] for model in ("jkr", "dmt"))
        lines.append([QUANTITIES[name], value(jkr.reference.value), both(jkr), value(dmt.reference.value), both(dmt)])
    return table(["quantity", "exact, JKR", "`jkr`", "exact, DMT", "`dmt`"], lines)


def _mdr(rows: Rows) -> str:
    words = {"pull_off": (QUANTITIES["pull off"], "R"), "restitution": ("restitution, v = 1.5 v_s", "T")}
    lines = []
    for name, step in GIVEN.steps:
        found, mended = (rows[row_name(model, at_step(step), name)] for model in ("mdr", "mdr, factor 1"))
        quantity, unit = words[name]
        cell = number(found.value, 8 if name == "restitution" else 4)
        lines.append([quantity, f"{step:g} {unit}", value(found.reference.value), cell, value(mended.value)])
    return table(["quantity", "step", "exact, JKR", "`mdr`", "`mdr` with factor 1, emulated"], lines)


def _oblique(rows: Rows) -> str:
    lines, ours = [], row_name(OURS, at_psi(GIVEN.psi[0]), "tangential_restitution") in rows
    for psi in GIVEN.psi:
        found = [rows[row_name(model, at_psi(psi), "slip")] for model in GIVEN.tangential]
        own = [rows.ours(at_psi(psi), "tangential_restitution")] if ours else []
        lines.append([f"{psi:g}", value(found[0].reference.value), *own, *(apart(row, 3) for row in found)])
    own = ["contact1d, −v_s′/v_s"] if ours else []
    return table(["ψ", "exact v_s′/v_s", *own, *(f"`{model}`" for model in GIVEN.tangential)], lines)


def _chung_ooi(rows: Rows) -> str:
    lines = []
    for test, body, at, *_ in GIVEN.tests:
        for name in GIVEN.measured[test]:
            row = rows[row_name(f"test {test}, {body}", at, name)]
            cell = apart(row, 3) if row.known else value(row.value)
            lines.append([test, body, at or NOWHERE, TABLES["chung_ooi"][name], value(row.reference.value), cell])
    return table(["test", "body", "given", "quantity", "exact", "LAMMPS"], lines)


def unit_tests(record: Record) -> Iterator[str]:
    """docs/grains.yaml: a document for each row of LAMMPS, with keys as in its `unittest/granular`."""
    yield "# docs/grains.md as data, written by `python -m validation pages`; decks are in validation/grains/decks.\n"
    for answer in record.answers:
        for row in answer.rows:
            if not any(row.runs):
                continue
            deck, *given = shlex.split(row.runs[0])
            exact, solved = row.reference.value, row.reference.evidence == "independent solver"
            entries = {
                "name": json.dumps(row.name, ensure_ascii=False),
                "lammps_version": version(record.versions["lammps"]).removeprefix("LAMMPS "),
                "date_generated": answer.date,
                "tags": f"granular, {answer.name}, generated",
                "input_file": deck,
                "variables": "".join(["|", *(f"\n  {one.replace('=', ' ', 1)}" for one in given)]) if given else '""',
                "lammps_value": f"{row.value:.9g}",
                "analytic_value": f"{exact:.12g}",
                "analytic_uncertainty": f"{(SOLVED if solved else ROUND_OFF) * max(1.0, abs(exact)):.1e}",
                "analytic_model": json.dumps(row.reference.source, ensure_ascii=False),
            }
            yield "\n".join(["---", *(f"{key}: {text}" for key, text in entries.items()), "...\n"])


def _wall(rows: Rows) -> str:
    shown = {"`hertz/material E …`": "wall hertz/material", "`hertz/material 2E …`": "nearest wall hertz/material"}
    found = {words: rows[row_name(name, "", "E*")] for words, name in shown.items()}
    lines = [[words, value(row.value), value(row.reference.value), deviation(row)] for words, row in found.items()]
    return table(["`fix wall/gran granular`", "E*/E in LAMMPS", "E*/E of a rigid wall", "deviation"], lines)


def drawings(record: Record) -> Mapping[str, Drawing]:
    """The figures of docs/grains.md, by the file's name."""
    rows = Rows(record)
    return {
        "grains_damped.png": _damped_drawing(rows),
        "grains_adhesive.png": _adhesive_drawing(rows),
        "grains_oblique.png": _oblique_drawing(rows),
    }


def _points(rows: Rows, label: str, x: Sequence[float], names: Sequence[str]) -> Series:
    """What was found; nothing where there is no such row."""
    return Series(label, x, [rows[name].value if name in rows else math.nan for name in names])


def _restitutions(rows: Rows, labels: Mapping[str, str], x: Sequence[float], places: Iterable[str]) -> list[Series]:
    """What was found of models at the same places."""
    at = list(places)
    names = {label: [row_name(name, one, "restitution") for one in at] for name, label in labels.items()}
    return [_points(rows, label, x, those) for label, those in names.items()]


def _damped_drawing(rows: Rows) -> Drawing:
    numbers = np.geomspace(GIVEN.numbers[0], GIVEN.numbers[-1], DENSE).tolist()
    exact = Series("exact, Kelvin-Voigt", numbers, [kelvin_voigt(A).restitution for A in numbers])
    shown = {"viscoelastic": "viscoelastic", "viscoelastic limit_damping": "with limit_damping", OURS: OURS}
    points = _restitutions(rows, shown, GIVEN.numbers, map(at_number, GIVEN.numbers))
    decade = np.geomspace(cases.DECADE[0], cases.DECADE[-1], DENSE).tolist()
    lines = [(v, kelvin_voigt(A * v**0.2).restitution if v else math.nan) for A in GIVEN.timed for v in [*decade, 0.0]]
    curves = Series("exact, A = 0.1, 0.3, 1 at v = 1", *np.transpose(lines))
    places = [(A, v) for A in GIVEN.timed for v in cases.DECADE]
    near = [
        _points(rows, model.name, [v for _, v in places], [near_name(model, A, v) for A, v in places])
        for model in cases.FITTED
    ]
    panels = (
        Panel("A = τ/T", "restitution", points, [exact], log="x", title="η = 2 E* τ/m"),
        Panel("velocity", "restitution", near, [curves], title="the nearest coefficients", view=(0.0, 1.0)),
    )
    return Drawing("Restitution of a Kelvin-Voigt body", panels)


def _oblique_drawing(rows: Rows) -> Drawing:
    """v_s'/v_s times psi over psi, as Maw and others draw it."""
    along = np.linspace(0.02, GIVEN.psi[-1], 4 * DENSE).tolist()
    exact = Series("exact", along, [psi * of_power(psi, CHI) for psi in along])
    found = [
        Series(model, GIVEN.psi, [psi * rows[row_name(model, at_psi(psi), "slip")].value for psi in GIVEN.psi])
        for model in GIVEN.tangential
    ]
    panel = Panel("ψ = (κ/µ) v_s/v before the impact", "(κ/µ) v_s′/v after it", found, [exact], title="solid spheres")
    return Drawing("Velocity of the contact point after an oblique impact over that before", [panel])


def _adhesive_drawing(rows: Rows) -> Drawing:
    beyond = np.linspace(0.0, math.sqrt(GIVEN.drawn[0] - LATE[0]), 4 * DENSE) ** 2  # finer where the curve is steep
    overlaps = [LATE[0], *(LATE[0] + 1e-9 + beyond).tolist()]
    forces = [0.0, *(SPHERES.force_at(overlap * LENGTH) / TENSION for overlap in overlaps[1:])]
    loop = Series("exact, JKR", overlaps, forces)
    pulled = _points(rows, "jkr", GIVEN.drawn, [row_name("jkr", f"overlap {d:g}", "force") for d in GIVEN.drawn])
    velocities = 1.0 + np.geomspace(1e-5, 9.0, 3 * DENSE)
    exact = Series("exact, JKR", velocities, np.sqrt(1.0 - velocities**-2))
    labels = {"jkr": "jkr", "nearest jkr": f"jkr, {cases.STRONGER:g} γ", "dmt": "dmt", OURS: OURS}
    points = _restitutions(rows, labels, GIVEN.over, map(at_velocity, GIVEN.over))
    panels = (
        Panel("overlap / (π²W²R/E*²)^(1/3)", "force / pull-off force", [pulled], [loop], title="drawn apart"),
        Panel("v / v_s", "restitution", points, [exact], log="x", title="impact"),
    )
    return Drawing("Adhesive spheres that are drawn apart, and that meet", panels)
