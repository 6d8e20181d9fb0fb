"""Faults from outside: a run that is killed and made again, files that cannot grow, two runs in one folder."""

from __future__ import annotations

import json
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from contact1d.workflow.judging.figures import Series
from contact1d.workflow.scene import scene_from_dict, scene_to_toml
from contact1d.workflow.stability.case import Bench, Class, Findings, at_most
from contact1d.workflow.stability.figures import points_figure
from contact1d.workflow.stability.opened import LAW

NAME = "faults"
COMMAND = (sys.executable, "-m", "contact1d.workflow.cli.app", "run")
KILLS, FULL_KILLS = (0.3, 0.8, 1.3, 2.0), tuple(float(t) for t in np.arange(0.1, 4.0, 0.1))
"""Seconds after which a run is killed: while it starts, loads, pulls, writes."""
SIZES, FULL_SIZES = (
    (0, 200, 3_000, 12_000, 60_000),
    (0, 50, 200, 800, 3_000, 6_000, 12_000, 25_000, 60_000, 120_000, 400_000),
)
"""Bytes beyond which no file may grow: one file after the other is the first that does not fit."""
MOST = 120.0
"""Wall time of one command [s]."""
CODES = (0, 2, 3)
SCENE = {
    "title": "pull-off that is disturbed",
    "bodies": {
        "particles": 200,
        "spacing": 1.0,
        "profile": {"kind": "parabola", "radius": 1000.0},
        "bulk_stiffness": 0.83,
    },
    "interaction": LAW,
    "neighbours": {"stiffness": 0.3},
    "horizontal": {},
    "experiment": {"kind": "pull_off", "method": "quasistatic", "preload": 1.0},
}


def measure(bench: Bench, folder: Path) -> Findings:
    """All three kinds; the reference is the same run undisturbed."""
    scene = bench.folder / "scene.toml"
    scene.write_text(scene_to_toml(scene_from_dict(SCENE)), encoding="utf-8")
    _end(_start(scene, bench.folder / "undisturbed"))
    undisturbed = _force(bench.folder / "undisturbed")
    kills = FULL_KILLS if bench.full else KILLS
    torn, other = 0, 0
    for seconds in kills:
        run = bench.folder / "killed"
        process = _start(scene, run)
        time.sleep(seconds)
        process.kill()
        process.communicate()
        torn += _torn(run)
        code, words = _end(_start(scene, run))
        other += code != 0 or _force(run) != undisturbed
    checks = [
        at_most(
            NAME,
            f"of {len(kills)} runs killed, those that leave a results.json that cannot be read",
            torn,
            0.0,
            "whole or not at all",
            "–",
            "set bound",
        ),
        at_most(
            NAME,
            f"of {len(kills)} runs killed and made again in the same folder, those with another F_A",
            other,
            0.0,
            "the same scene undisturbed, to the last digit",
            "–",
            "set bound",
        ),
    ]
    sizes = FULL_SIZES if bench.full else SIZES
    codes = []
    for size in sizes:
        code, words = _end(_start(scene, bench.folder / f"full_{size}", size))
        bad = (
            code not in CODES
            or "Traceback" in words
            or (code == 0 and _force(bench.folder / f"full_{size}") != undisturbed)
        )
        codes.append(code)
        checks.append(
            at_most(
                NAME,
                f"a file may not grow beyond {size} bytes: a traceback, or another exit code than 0, 2, 3",
                float(bad),
                0.0,
                f"exit 0, 2 or 3 and no traceback; it is {code}",
                "–",
                "set bound",
            )
        )
    checks.append(
        at_most(
            NAME,
            "second run in a folder at work that is not refused with exit 2",
            _second(scene, bench),
            0.0,
            "one run for each folder",
            "–",
            "set bound",
        )
    )
    points_figure(
        folder / f"{NAME}.png",
        [Series("disk full", np.array(sizes, float) + 1.0, np.array(codes, float))],
        ("bytes that a file may have", "exit code"),
        log="x",
    )
    return Findings(checks, f"{NAME}.png", "Exit code where no file may grow beyond so many bytes")


def _start(scene: Path, run: Path, size: int | None = None) -> subprocess.Popen[str]:
    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # so that writing fails as on a full disk
        if size is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return subprocess.Popen(
        [*COMMAND, str(scene), "--out", str(run), "--no-figures", "-q"],
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


def _force(run: Path) -> float | None:
    try:
        return float(json.loads((run / "results.json").read_text(encoding="utf-8"))["adhesion_force"]["value"])
    except (OSError, ValueError, KeyError):
        return None


def _torn(run: Path) -> bool:
    try:
        json.loads((run / "results.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        return False
    except ValueError:
        return True
    return False


def _second(scene: Path, bench: Bench) -> float:
    run = bench.folder / "two"
    first = _start(scene, run)
    end = time.monotonic() + MOST
    while not (run / "in.lammps").exists() and first.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    first.send_signal(signal.SIGSTOP)  # at work for as long as it takes
    code, words = _end(_start(scene, run))
    first.send_signal(signal.SIGCONT)
    _end(first)
    return float(code != 2 or "Traceback" in words or _force(run) is None)


FAULTS = Class(
    NAME,
    "Killed, disk full, two runs in one folder",
    "A run that was cut off must not leave a number, or a folder in which the next run ends otherwise.",
    measure,
)
