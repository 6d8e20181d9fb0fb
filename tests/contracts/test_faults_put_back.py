"""Claim: a new profile, effect or experiment keeps all contracts by being registered, and old faults break one.

`changes.toml` has them, each as changes of a copy of this checkout in which the contracts of some scenes are tried.
"""

import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from validation.tools.copies import copy_of_this

CHANGES: dict[str, list[dict[str, Any]]] = tomllib.loads(
    Path(__file__).with_name("changes.toml").read_text(encoding="utf-8")
)
EXTENSIONS = {one["name"]: one for one in CHANGES["extension"]}
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def copy() -> Iterator[Path]:
    with copy_of_this() as folder:
        yield folder


def tried(folder: Path, edits: Sequence[dict[str, str]], chosen: str) -> tuple[int, str]:
    """Pytest's exit code and last lines for the contracts of chosen scenes with these changes, which are undone."""
    before: dict[Path, str | None] = {}
    try:
        for edit in edits:
            path = folder / edit["file"]
            text = path.read_text(encoding="utf-8") if path.exists() else None
            before.setdefault(path, text)
            assert "old" not in edit or (text or "").count(edit["old"]) == 1, f"renew changes.toml: {edit['old']!r}"
            new = (text or "").replace(edit["old"], edit["new"]) if "old" in edit else edit["new"].lstrip()
            path.write_text(new, encoding="utf-8")
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", "-p", "no:cacheprovider", "--tb=line"]
        command += ["--rootdir", str(folder), "-m", "slow or not slow", "-k", f"({chosen}) or every_member"]
        own = {"PYTHONPATH": f"{folder}/src", "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
        place = "tests/contracts/test_contracts.py"
        done = subprocess.run([*command, place], cwd=folder, env=os.environ | own, capture_output=True, text=True)
        return done.returncode, done.stdout[-3000:] + done.stderr[-1000:]
    finally:
        for path, text in before.items():
            path.unlink() if text is None else path.write_text(text, encoding="utf-8")


@pytest.mark.parametrize("name", EXTENSIONS)
def test_an_extension_enters_by_being_registered(copy: Path, name: str) -> None:
    code, said = tried(copy, EXTENSIONS[name]["edits"], EXTENSIONS[name]["chosen"])
    assert code == pytest.ExitCode.OK, said


@pytest.mark.parametrize("fault", CHANGES["fault"], ids=lambda fault: fault["name"])
def test_a_fault_is_noticed(copy: Path, fault: dict[str, Any]) -> None:
    edits = [*EXTENSIONS.get(fault.get("beside", ""), {"edits": []})["edits"], *fault["edits"]]
    code, said = tried(copy, edits, fault["chosen"])
    print(said)  # -s shows which contract it is
    assert code == pytest.ExitCode.TESTS_FAILED, said
