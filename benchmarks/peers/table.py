"""From peers.json to the table in benchmarks/README.md and the figure."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

BEGIN, END = "<!-- peers: begin -->", "<!-- peers: end -->"
ENOUGH = 0.01
"""Error at which solvers are compared."""
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
        found += [(what, name, ours, quickest((r for r in records if r["solver"] == name), key)) for name in ELEMENTS]
    adhesive = [r for r in document["records"] if r["contact"] == "jkr" and error_of(r) <= ENOUGH]
    ours = quickest(r for r in adhesive if r["solver"] == OURS)
    for solver in ELEMENTS:
        theirs = [r for r in adhesive if r["solver"] == solver]
        best = min(theirs, key=lambda r: float(r["errors"]["theory_force"]), default=None)
        off = f"{best['errors']['theory_force']:.1%}" if best else "-"
        found.append((f"adhesive, the same and as near to JKR's F(d) as it comes ({off})", solver, ours, best))
    return found


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
        ("worst of it", "limit_worst_relative"), ("a: rms over a_0", "limit_radius"),
    ),
    "jkr": (
        ("own limit: F", "limit_force"), ("F_A", "limit_pull_off"), ("a", "limit_radius"),
        ("JKR: F", "theory_force"), ("F_A", "theory_pull_off"), ("a", "theory_radius"),
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
    inside = record["parts"].get("lammps")
    taken = _time(record["seconds"]) + (f" ({_time(inside)} in LAMMPS)" if inside else "")
    start = f"{_time(record['import_s'])} + {_time(record['start_up_s'])}"
    values = [(record["errors"].get(name), name.endswith("place")) for _, name in columns]
    shown = ["" if value is None else f"{value:.3f}" if place else f"{100.0 * value:.2g} %" for value, place in values]
    return [record["solver"], record["setting"], taken, start, *shown]


def write_section(document: dict[str, Any], page: Path) -> None:
    """Put the section between the markers of a page.

    Raises:
        ValueError: the page has no markers.
    """
    before, begin, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"{page} has no markers {BEGIN} and {END}")
    page.write_text(f"{before}{BEGIN}\n{section(document)}\n{END}{after}", encoding="utf-8")


def write_figure(document: dict[str, Any], path: Path) -> None:
    """Draw error over time, one panel for each contact."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 2, figsize=(12, 5.2), layout="constrained")
    for axis, contact, title in zip(axes, ("hertz", "jkr"), ("Hertz", "JKR"), strict=True):
        for solver, color in COLORS.items():
            records = [r for r in document["records"] if r["solver"] == solver and r["contact"] == contact]
            times, near, far = (
                [r["seconds"] for r in records],
                [error_of(r) for r in records],
                [error_of(r, "theory") for r in records],
            )
            axis.loglog(times, [max(e, 1e-6) for e in near], "o", color=color, label=f"{solver}")
            if contact == "jkr":
                axis.loglog(times, [max(e, 1e-6) for e in far], "x", color=color, alpha=0.6)
            for record, x, y in zip(records, times, near, strict=True):
                axis.annotate(record["setting"].split(",")[0], (x, max(y, 1e-6)), fontsize=7, xytext=(4, 3),
                              textcoords="offset points")  # fmt: skip
        axis.axhline(ENOUGH, color="grey", lw=0.7, ls="--")
        axis.set(xlabel="time of a curve of 50 points [s]", title=title)
    axes[0].set_ylabel("rms of F/F(Hertz) − 1")
    axes[1].set_ylabel("rms error of F over F_A, or of the pull-off\n● own continuum limit   × JKR, by displacement")
    axes[0].legend(fontsize=8)
    figure.savefig(path, dpi=130)
    pyplot.close(figure)
