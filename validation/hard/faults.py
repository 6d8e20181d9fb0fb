"""Faults from outside: a run that is killed and made again, files that cannot grow, two runs in one folder."""

import json
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from validation.doors import shipped
from validation.row import so
from validation.study import Bench, Lines, Study

COMMAND = (sys.executable, "-m", "contact1d", "run")
MOST = 1800.0
"""Wall time of one command [s]."""
RESULTS, TORN = "results.json", "torn"


def measure(bench: Bench) -> Lines:
    """All three kinds; the reference is the same run undisturbed, whose phases and files are those of the others."""
    scene, whole = shipped("scenes/pull_off.toml"), bench.folder / "undisturbed"
    phases = _start(scene, whole).communicate(timeout=MOST)[1].splitlines()
    undisturbed = _force(whole)
    sizes = {path.name: path.stat().st_size for path in sorted(whole.iterdir()) if path.is_file()}
    moments = [(phases.index(line) + 1, "", f'at "{line.split(":")[0]}"') for line in dict.fromkeys(phases)]
    moments += [(0, name, f"when {name} appears") for name in (sizes if bench.full else [RESULTS])]
    same = "the same scene undisturbed, to the last digit"
    for index, name, words in moments:
        what = f"killed {words}: a torn results.json, or another F_A when it is run again in that folder"
        yield so(what, _killed(scene, bench.folder / f"killed_{index}_{name}", index, name, undisturbed), same)
    for name, size in sizes.items():
        run = bench.folder / f"full_{max(0, size - 1)}"
        code, words = _end(_start(scene, run, max(0, size - 1)))
        bad = code not in (0, 2, 3) or "Traceback" in words or (code == 0 and _force(run) != undisturbed)
        what = f"disk full at the last byte of {name}: a traceback, another exit code than 0, 2, 3, another F_A"
        yield so(what, bad, f"exit 0, 2 or 3 and no traceback; it is {code}")
    refused = "second run in a folder at work that is not refused with exit 2"
    yield so(refused, _second(scene, bench.folder / "two"), "one run for each folder")


def _killed(scene: Path, run: Path, lines: int, file: str, undisturbed: Any) -> bool:
    """Whether a run that is killed at a line of its progress, or when a file appears, leaves what spoils the next."""
    process = _start(scene, run)
    assert process.stderr is not None
    for _ in range(lines):
        process.stderr.readline()
    if file:
        _wait_for(f"{file}*", run, process)
    process.kill()
    process.communicate()
    torn = _force(run) == TORN
    code, _ = _end(_start(scene, run))
    return torn or code != 0 or _force(run) != undisturbed


def _wait_for(file: str, run: Path, process: subprocess.Popen[str]) -> None:
    end = time.monotonic() + MOST
    while not any(run.glob(file)) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.001)


def _start(scene: Path, run: Path, size: int | None = None) -> subprocess.Popen[str]:
    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # so that writing fails as on a full disk
        if size is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return subprocess.Popen(
        [*COMMAND, str(scene), "--out", str(run), "--no-figures"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=limit,
    )


def _end(process: subprocess.Popen[str]) -> tuple[int, str]:
    """Exit code and what was said; one that does not end is killed and has code -9."""
    try:
        said, complained = process.communicate(timeout=MOST)
    except subprocess.TimeoutExpired:
        process.kill()
        said, complained = process.communicate()
    return process.returncode, said + complained


def _force(run: Path) -> Any:
    """F_A in results.json: None where there is none, "torn" where the file is no JSON."""
    try:
        document = json.loads((run / RESULTS).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except ValueError:
        return TORN
    return document.get("adhesion_force", {}).get("value")


def _second(scene: Path, run: Path) -> bool:
    first = _start(scene, run)
    _wait_for("in.lammps", run, first)
    first.send_signal(signal.SIGSTOP)  # at work for as long as it takes
    code, words = _end(_start(scene, run))
    first.send_signal(signal.SIGCONT)
    _end(first)
    return code != 2 or "Traceback" in words or _force(run) is None


FAULTS = Study(
    "faults",
    "Runs that are killed, a full disk, two runs in one folder",
    "Does an interrupted run leave no result, and no folder that affects the next run?",
    measure,
)
