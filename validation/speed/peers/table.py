"""From peers.json to the table in validation/speed/README.md and the figure."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contact1d.analysis.plots import new_figure, save_figure
from validation.speed.pages import write_between

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ENOUGH = 0.01
"""Error at which solvers are compared."""
BESIDE_JKR = 0.0125
"""The same beside JKR itself: no range that boundary elements follow within minutes is short enough for ENOUGH."""
OURS, ELEMENTS = "contact1d", ("tamaas", "ContactMechanics")
COLORS = {
    "contact1d": "C3", "scipy solver (1D)": "C1", "tamaas": "C0", "ContactMechanics": "C2", "granular (pair law)": "C4",
}  # fmt: skip


def error_of(record: dict[str, Any], against: str = "limit") -> float:
    """Return what a record is judged by: Hertz, the rms of F/F_ref - 1; JKR, the rms of F - F_ref over F_A or the error
    of the pull-off, the larger one. `against`: "limit", the solver's own, or "theory"."""
    found = record["errors"]
    if record["contact"] == "hertz":
        return float(found[f"{against}_relative"])
    return max(float(found[f"{against}_force"]), abs(float(found[f"{against}_pull_off"])))


def quickest(records: Iterable[dict[str, Any]], key: str | None = None) -> dict[str, Any] | None:
    """Return the quickest record with an error of at most ENOUGH, by `error_of` or by the error `key`; None: none."""
    good = [r for r in records if (error_of(r) if key is None else abs(r["errors"][key])) <= ENOUGH]
    return min(good, key=lambda record: float(record["seconds"])) if good else None


ROWS = "rows in LAMMPS alone"
"""What is left of a run without the program around the solver."""
WHOLE = "LAMMPS with reading and setting up"
"""The same with what a peer does before its curve."""
Comparison = tuple[str, str, dict[str, Any] | None, dict[str, Any] | None]
"""What is compared, the other solver, our record and theirs; None where no setting reaches it."""


def comparisons(document: dict[str, Any]) -> list[Comparison]:
    """Return each boundary-element code beside this program, at equal error."""
    found: list[Comparison] = []
    for contact, key, what in (
        ("hertz", "limit_force", "Hertz, 1 % of the largest force (rms)"),
        ("hertz", None, "Hertz, 1 % of each force (rms)"),
        ("hertz", "limit_worst_relative", "Hertz, 1 % of each force (worst point)"),
        ("jkr", None, "adhesive, 1 % of the solver's own limit, any range"),
    ):
        records = [r for r in document["records"] if r["contact"] == contact]
        ours = quickest((r for r in records if r["solver"] == OURS), key)
        theirs = {name: quickest((r for r in records if r["solver"] == name), key) for name in ELEMENTS}
        found += [(what, name, ours, record) for name, record in theirs.items()]
        if key == "limit_force" and ours is not None and "rows" in ours["parts"]:
            inside = what.replace("Hertz", f"Hertz, {ROWS}")
            found += [(inside, name, rows_of(ours), record) for name, record in theirs.items()]
            whole = what.replace("Hertz", f"Hertz, {WHOLE}")
            found += [(whole, name, rows_of(ours, "lammps"), record) for name, record in theirs.items()]
    return found + beside_jkr([r for r in document["records"] if r["contact"] == "jkr"])


def rows_of(record: dict[str, Any], part: str = "rows") -> dict[str, Any]:
    """Our record with the time of its rows in LAMMPS: what reads the bodies is left out, as a peer's start-up is."""
    return record | {"seconds": record["parts"][part]}


def beside_jkr(records: list[dict[str, Any]]) -> list[Comparison]:
    """Beside JKR's own F(d), at equal error: of each boundary-element code the quickest within BESIDE_JKR, or the least
    error where none is, and our quickest with no more.

    Nothing is compared before this program has such a record.
    """
    found: list[Comparison] = []
    for name in ELEMENTS:
        peers = [r for r in records if r["solver"] == name]
        good = [r for r in peers if _beside(r) <= BESIDE_JKR]
        theirs = min(good, key=_seconds) if good else min(peers, key=_beside, default=None)
        allowed = ENOUGH if theirs is None else _beside(theirs)
        mine = [r for r in records if r["solver"] == OURS and _beside(r) <= allowed]
        if mine:
            what = "JKR itself" + ("" if theirs is None else f" (rms {allowed:.1%} of F_A, {name})")
            found.append((what, name, min(mine, key=_seconds), theirs))
    return found


def _beside(record: dict[str, Any]) -> float:
    return float(record["errors"]["theory_force"])


def _seconds(record: dict[str, Any]) -> float:
    return float(record["seconds"])


def ratios(document: dict[str, Any]) -> list[str]:
    """Return one sentence for each comparison."""
    return [f"- {what}: {_ratio(ours, theirs, solver)}" for what, solver, ours, theirs in comparisons(document)]


def _ratio(ours: dict[str, Any] | None, theirs: dict[str, Any] | None, solver: str) -> str:
    if ours is None or theirs is None:
        return f"{OURS if ours is None else solver} has no setting that reaches it"
    share = theirs["seconds"] / ours["seconds"]
    return (
        f"**{share:.2g}** ({solver} {theirs['setting']} {_time(theirs['seconds'])}, "
        f"{OURS} {ours['setting']} {_time(ours['seconds'])})"
    )


def _time(seconds: float) -> str:
    if seconds < 5e-5:
        return "< 0.1 ms"
    return f"{seconds:.3g} s" if seconds >= 1.0 else f"{1e3 * seconds:.3g} ms"


COLUMNS = {
    "hertz": (
        ("F: rms over F_max", "limit_force"), ("rms of F/F_H − 1", "limit_relative"),
        ("worst of it", "limit_worst_relative"), ("d: rms over a_0²/R", "limit_displacement"),
        ("a: rms over a_0", "limit_radius"),
    ),
    "jkr": (
        ("own limit: F", "limit_force"), ("F_A", "limit_pull_off"), ("d", "limit_displacement"),
        ("a", "limit_radius"), ("JKR: F", "theory_force"), ("F_A", "theory_pull_off"), ("d", "theory_displacement"),
        ("a", "theory_radius"),
        ("F/F_A over a/a_0", "reduced"), ("d at F_A", "pull_off_place"), ("d at F = 0", "zero_load_place"),
    ),
}  # fmt: skip
"""Heading and error of the columns after the times; places are in a_0²/R, the rest in percent."""


def section(document: dict[str, Any]) -> str:
    """Return the Markdown between the markers."""
    about = document["machine"]
    versions = ", ".join(f"{name} {number}" for name, number in about["versions"].items())
    lines = [f"{about['processor']}, {about['cores']} cores, one thread each; Python {about['python']}, {versions}."]
    for contact, columns in COLUMNS.items():
        headings = ["solver", "setting", "time of the curve", "import + start-up", *(name for name, _ in columns)]
        lines += ["", f"**{contact.upper() if contact == 'jkr' else 'Hertz'}**", "", _row(headings)]
        lines.append(_row(["---"] * len(headings)))
        lines += [_row(_cells(r, columns)) for r in document["records"] if r["contact"] == contact]
        if contact in document["closed_form_s"]:
            seconds = _time(document["closed_form_s"][contact])
            lines.append(_row(["closed form", "numpy", seconds] + [""] * (len(headings) - 3)))
    lines += ["", "Time of a peer over this program's, each with its quickest setting of at most 1 % error:", ""]
    return "\n".join([*lines, *ratios(document)])


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _cells(record: dict[str, Any], columns: tuple[tuple[str, str], ...]) -> list[str]:
    parts = record["parts"]
    inside = parts.get("lammps")
    taken = _time(record["seconds"]) + (f" ({_time(inside)} in LAMMPS, rows {_time(parts['rows'])})" if inside else "")
    start = f"{_time(record['import_s'])} + {_time(record['start_up_s'])}"
    values = [(record["errors"].get(name), name.endswith("place")) for _, name in columns]
    shown = ["" if value is None else f"{value:.3f}" if place else f"{100.0 * value:.2g} %" for value, place in values]
    return [record["solver"], record["setting"], taken, start, *shown]


def write_section(document: dict[str, Any], page: Path) -> None:
    """Put the section between the markers of a page.

    Raises:
        ValueError: the page has no markers.
    """
    write_between(page, "peers", section(document) + "\n")


PANELS: tuple[tuple[str, Callable[[dict[str, Any], str], float | None]], ...] = (
    ("F", error_of),
    ("d", lambda record, against: record["errors"].get(f"{against}_displacement")),
    ("a", lambda record, against: record["errors"].get(f"{against}_radius")),
)
"""What is in error in the columns of the figure."""
LEAST = 1e-6
"""Errors below that are drawn there."""
ERRORS = {
    ("hertz", "F"): "rms of F/F(Hertz) − 1", ("hertz", "d"): "rms error of d at the same F, over a₀²/R",
    ("hertz", "a"): "rms error of a over a₀", ("jkr", "F"): "rms error of F over F_A, or of F_A",
    ("jkr", "d"): "rms error of d at the same F, over a₀²/R", ("jkr", "a"): "rms error of a over a₀",
}  # fmt: skip


def write_figure(document: dict[str, Any], path: Path) -> None:
    """Draw errors of F, d and a over time: a row for each contact."""
    figure = new_figure((13.0, 8.6))
    axes = figure.subplots(2, len(PANELS), sharex="row")
    for row, (contact, title) in zip(axes, (("hertz", "Hertz"), ("jkr", "JKR")), strict=True):
        records = [r for r in document["records"] if r["contact"] == contact]
        for axis, (name, error) in zip(row, PANELS, strict=True):
            for record in records:
                if record["solver"] in COLORS:
                    _point(axis, record, error(record, "limit"), error(record, "theory") if contact == "jkr" else None)
            axis.axhline(ENOUGH, color="grey", lw=0.7, ls="--")
            axis.set_xscale("log")
            axis.set_yscale("log")
            axis.set_ylim(0.5 * LEAST, 2.0)
            axis.set(xlabel="time of a curve of 50 points (s)", ylabel=ERRORS[contact, name])
        row[0].set_title(f"{title}, each beside its own continuum limit" + (" (× beside JKR)" * (contact == "jkr")),
                         loc="left")  # fmt: skip
    for solver, color in COLORS.items():
        axes[0, 0].plot([], [], "o", color=color, label=solver)
    figure.legend(loc="outside lower center", ncols=len(COLORS), frameon=False)
    save_figure(figure, path)


def _point(axis: Axes, record: dict[str, Any], near: float | None, far: float | None) -> None:
    """A solver with one setting; where the panel's quantity is not known, nothing."""
    color, x = COLORS[record["solver"]], record["seconds"]
    if far is not None:
        axis.plot(x, max(far, LEAST), "x", color=color, alpha=0.6)
    if near is not None:
        y = max(near, LEAST)
        axis.plot(x, y, "o", color=color, markersize=5)
        if axis.get_subplotspec().is_first_col():
            axis.annotate(record["setting"].split(",")[0], (x, y), (4, 3), fontsize=6, textcoords="offset points")
