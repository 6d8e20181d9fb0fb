"""The listed faults (`faults.toml`) put back, one at a time: which test notices. Exit code 1 where one passes.

python -m validation.tools.faults [NAME ...]
"""

import json
import sys
from pathlib import Path

from validation.row import tables_beside
from validation.tools.copies import copy_of_this, first_failure, load

RESULTS = Path(__file__).parents[1] / "results" / "faults.json"
PATIENCE = 1800.0
"""[s]"""


def listed() -> list[dict[str, str]]:
    """The faults: name, file, old, new, tests."""
    return list(tables_beside(__file__)["fault"])


def killed_by(fault: dict[str, str], folder: Path) -> str:
    """The first test that fails with the fault in the copy; empty where none does. Raises ValueError: a stale fault."""
    path = folder / fault["file"]
    whole = path.read_text(encoding="utf-8")
    if whole.count(fault["old"]) != 1:
        raise ValueError(f"{fault['name']}: {fault['file']} has {whole.count(fault['old'])} times {fault['old']!r}")
    try:
        path.write_text(whole.replace(fault["old"], fault["new"]), encoding="utf-8")
        return first_failure(folder, fault["tests"].split(), PATIENCE)
    finally:
        path.write_text(whole, encoding="utf-8")


def main() -> int:
    """Put every fault back in turn."""
    chosen = [fault for fault in listed() if fault["name"] in sys.argv[1:] or not sys.argv[1:]]
    found: dict[str, str] = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    load()
    with copy_of_this() as folder:
        for fault in chosen:
            by = found[fault["name"]] = killed_by(fault, folder)
            print(f"{'killed  ' if by else 'SURVIVES'} {fault['name']}: {by}", flush=True)
    kept = {fault["name"]: found[fault["name"]] for fault in listed() if fault["name"] in found}
    RESULTS.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return int(not all(kept.values()))


if __name__ == "__main__":
    sys.exit(main())
