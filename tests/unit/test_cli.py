"""The command line as a person uses it: what it prints, completes and leaves, and how it ends, whatever goes wrong."""

import errno
import json
import os
import re
import resource
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from contact1d.__main__ import app
from tests.command import contact1d
from tests.scenes import ROOT, read_json

SCENES = ROOT / "lammps_inputs" / "scenes"
PROGRAM = [sys.executable, "-m", "contact1d"]
SCENE = """
title = "plane"
[bodies]
particles = 21
spacing = 1.0
reduction = "mdr"
profile = { kind = "parabola", radius = 50.0 }
bulk_stiffness = 0.5
lower = "rigid_plane"
[neighbours]
stiffness = 0.1
[experiment]
kind = "load"
force = 0.5
"""
IN_SI = ("material={contact_modulus=1e6, length_unit=1e-6, force_unit=1e-6}", "bodies.bulk_stiffness=auto")
FEW = 2_000
"""Bytes that a file may have: fewer than a deck and the scene file that `new` writes."""


@pytest.fixture(autouse=True)
def _with_a_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plane.toml").write_text(SCENE)


def process(*arguments: str | Path, limit: int = resource.RLIM_INFINITY) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, whose files may have `limit` bytes."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    command = [*PROGRAM, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, preexec_fn=limited)


def test_run_prints_numbers_in_si_closed_forms_and_a_picture() -> None:
    """Hertz: a = √(Rd), d = (9F²/16RE*²)^(1/3); compression above the axis, ± a marked below."""
    changes = [word for change in (*IN_SI, "experiment.force=4.0") for word in ("--set", change)]
    done = contact1d("run", "plane.toml", "--format", "svg", "--without", "neighbours", *changes)
    assert done.exit_code == 0, done.stderr
    first, *rest = done.stdout.splitlines()
    assert first.split()[:2] == ["reduction", "mdr:"]
    (radius,) = (line for line in rest if "contact radius a" in line)
    hertz = (0.75 * 4e-6 * 50e-6 / 1e6) ** (1.0 / 3.0) * 1e6
    assert re.search(rf"± .* µm +Hertz {hertz:.5g} µm \([+-].*%\)$", radius)
    top = rest[next(i for i, line in enumerate(rest) if line.startswith("line load")) + 1]
    assert "█" in top  # as high as the picture
    axis = next(i for i, line in enumerate(rest) if "─" in line)
    assert [any("█" in line for line in part) for part in (rest[:axis], rest[axis + 1 :])] == [True, False]
    assert next(line for line in rest if "^" in line).count("^") == 2
    assert any("N/m" in line and "µm" in line for line in rest)
    assert "loading" in done.stderr  # plain progress lines where there is no terminal
    folder = Path("runs/plane")
    assert {path.suffix for path in folder.glob("pressure*.*")} == {".svg", ".csv"}
    document = read_json(folder / "results.json")
    assert (document["scene"]["experiment"]["force"], document["effects"]) == (4.0, [])


def test_a_run_that_fails_exits_with_3_and_says_why_in_words() -> None:
    done = contact1d("run", "plane.toml", "--set", "experiment.force=30")
    assert done.exit_code == 3
    assert "end of the chain" in done.stderr
    assert "files kept in " in done.stderr
    assert "±" not in done.stdout


def test_what_to_cite_is_said_as_in_the_repository() -> None:
    done, kept = contact1d("--cite"), (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert done.exit_code == 0, done.stderr
    cited = re.findall(r"doi *= \{(.*)\}", done.stdout)
    assert cited == re.findall(r"doi: (.*)", kept)
    assert f"version = {{{version('contact1d')}}}" in done.stdout
    assert f"version: {version('contact1d')}\n" in kept


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys, typer.testing, contact1d.__main__ as cli;"
        "result = typer.testing.CliRunner().invoke(cli.app, ['--help']);"
        "assert result.exit_code == 0, result.output;"
        "heavy = {'numpy', 'scipy', 'matplotlib', 'ase', 'lammps', 'pydantic', 'pint'} & set(sys.modules);"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("contact1d ", {command.callback.__name__ for command in app.registered_commands if command.callback}),
        ("contact1d run ", {"plane.toml", "scenes/"}),
        ("contact1d cost sc", {"scenes/cone.toml", "scenes/more/"}),
        ("contact1d deck plane.toml", {"plane.toml"}),
        ("contact1d run nowhere/b", set()),
        ("contact1d run ball.toml --without n", {"neighbours", "noise"}),
        ("contact1d new ball --kind p", {"pull_off", "path"}),
    ],
)
def test_bash_is_offered_what_fits(words: str, offered: set[str]) -> None:
    Path("scenes/more").mkdir(parents=True)
    for name in ("notes.md", "scenes/cone.toml", "scenes/.hidden.toml"):
        Path(name).touch()
    asked = {"_CONTACT1D_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    done = CliRunner().invoke(app, env=asked, prog_name="contact1d")
    assert done.exit_code == 0, done.stderr
    assert set(done.stdout.split()) == offered


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), 3, "failed: the disk is full; "),
        (OSError(errno.ENOSPC, "No space left on device", "big.png"), 3, "failed: the disk is full (big.png); "),
        (OSError(errno.EMFILE, "Too many open files"), 3, "failed: Too many open files; "),
        (MemoryError(), 3, "failed: the machine is out of memory; "),
        (KeyboardInterrupt(), 130, "interrupted; "),
        (PermissionError(errno.EACCES, "Permission denied", "out"), 2, "out cannot be written: Permission denied\n"),
    ],
)
def test_an_error_of_the_system_becomes_a_sentence_and_an_exit_code(
    error: BaseException, code: int, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As it makes its folder; the study says that it begins anew."""

    def fails(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(Path, "mkdir", fails)
    done = contact1d("cost", "plane.toml", "--out", "out")
    assert (done.exit_code, done.stdout) == (code, "")
    assert words in done.stderr
    assert done.stderr.endswith("; run it again from the start\n") == (code != 2)


@pytest.mark.parametrize("arguments", [("deck", SCENES / "load.toml", "--out", "out"), ("new", "out")])
def test_a_file_that_finds_no_place_is_told_with_exit_code_3(arguments: tuple[str | Path, ...]) -> None:
    done = process(*arguments, limit=FEW)
    assert (done.returncode, done.stdout) == (3, "")
    assert "failed: a file would be larger than is allowed" in done.stderr
    assert ("files are kept in out" in done.stderr) == (arguments[0] == "deck")
    assert not Path("out.toml").exists()
    assert "Traceback" not in done.stderr
    assert process(*arguments).returncode == 0, "once there is room the same command works"


def test_a_run_whose_output_nobody_reads_any_more_draws_its_figures() -> None:
    with subprocess.Popen([*PROGRAM, "run", "plane.toml"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as begun:
        assert begun.stdout is not None
        begun.stdout.close()  # as `| head` does
    assert begun.returncode == 0
    assert Path("runs/plane/pressure.png").exists()


def test_numbers_are_printed_though_no_figure_can_be_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "pressure.png")

    monkeypatch.setattr(Figure, "savefig", full)
    done = contact1d("run", "plane.toml")
    assert done.exit_code == 3
    assert "±" in done.stdout
    assert done.stderr.endswith("the run failed: the disk is full (pressure.png); files are kept in runs/plane\n")


def test_a_full_disk_behind_the_standard_output_is_told() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*PROGRAM, "schema"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (3, "contact1d failed: the disk is full\n")


@pytest.mark.parametrize("arguments", [["run", "plane.toml"], ["doctor"]], ids=lambda words: words[0])
def test_a_package_that_is_missing_is_told_with_exit_code_1(arguments: list[str]) -> None:
    code = "import sys; sys.modules['numpy'] = None; from contact1d.__main__ import app; app()"
    command = [sys.executable, "-c", code, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert "numpy" in (done.stderr if arguments[0] == "run" else done.stdout)
    assert "Traceback" not in done.stderr


def test_an_interrupted_run_says_what_is_left() -> None:
    command = [*PROGRAM, "run", str(SCENES / "pull_off_dynamic.toml"), "--out", "out"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as begun:
        assert begun.stderr is not None
        while "loading" not in begun.stderr.readline():
            assert begun.poll() is None
        os.killpg(begun.pid, signal.SIGINT)  # as a terminal does
        last = begun.stderr.read().splitlines()[-1]
    assert (begun.returncode, last) == (130, "interrupted; no numbers were written; files are kept in out")


@pytest.mark.parametrize("command", ["run", "deck", "cost"])
def test_every_command_reads_a_scene_in_the_same_way(command: str) -> None:
    scene, before = str(SCENES / "load.toml"), {Path("plane.toml")}
    done = contact1d(command, scene, "--out", "out", "--set", "experiment.forc=1", "--without", "nois")
    assert (done.exit_code, done.stdout) == (2, "")
    first, *problems = done.stderr.splitlines()
    assert first == f"{scene}: 2 problems"
    assert "did you mean" in problems[0]
    missing = contact1d(command, "nope.toml", "--out", "out")
    assert (missing.exit_code, missing.stderr) == (2, "nope.toml: 1 problem\n  nope.toml: no such file\n")
    assert {*Path().iterdir()} == before
    Path("taken").write_text("mine")
    for out, words in (("taken", "taken is a file"), ("taken/in", "cannot be written"), ("n" * 300, "name too long")):
        done = contact1d(command, scene, "--out", out)
        assert done.exit_code == 2, done.stderr
        assert words in done.stderr
    assert Path("taken").read_text() == "mine"


ROUGH = 2e-2
"""Of the loose runs here, and of the two printed digits of the paper's units."""
RIGID = ("identify", "--contact-modulus", "200e9")


def test_a_finished_run_gets_the_units_of_table_1() -> None:
    done = contact1d("run", SCENES / "pull_off.toml", "--out", "run", "--no-figures", "-q")
    assert done.exit_code == 0, done.stderr
    found = contact1d(*RIGID, "--surface-energy", "1", "--run", "run")
    assert found.exit_code == 0, found.stderr
    units = dict(line.split(maxsplit=2)[1:] for line in found.stdout.splitlines() if line.startswith("  1 "))
    assert float(units["LU"].split()[0]) == pytest.approx(6.1, rel=ROUGH)  # nm
    assert float(units["FU"].split()[0]) == pytest.approx(39.0, rel=0.03)  # µN; F_A is 1 % above


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--surface-energy", "1"], "or either --run"),
        (["--radius", "1e-6", "--adhesion-force", "1e-6"], "go together"),
        (["--radius", "nan", "--surface-energy", "1"], "--radius must be greater than 0, not nan"),
        (["--run", "nowhere", "--surface-energy", "1", "--length-unit", "1e-9"], "the run has all other values"),
        (["--radius", "1e-6", "--surface-energy", "1", "--length-unit", "1e-6"], "at most 6.5"),
        (
            ["--radius", "6.1e-6", "--adhesion-force", "1e-4", "--zero-load-radius", "170e-9"],
            "Nearest: the same force with a radius of at least",
        ),
    ],
)
def test_what_cannot_be_identified_is_told_with_exit_code_2(options: list[str], words: str) -> None:
    done = contact1d(*RIGID, *options)
    assert done.exit_code == 2, done.stdout
    assert words in done.stderr
    assert {*Path().iterdir()} == {Path("plane.toml")}


def test_a_run_without_adhesion_or_without_its_scene_is_no_material() -> None:
    assert contact1d("run", "plane.toml", "--out", "run", "--no-figures", "-q").exit_code == 0
    asked = [*RIGID, "--surface-energy", "1", "--run", "run"]
    done = contact1d(*asked)
    assert done.exit_code == 2
    assert "no adhesion_force and no zero_load_radius" in done.stderr
    results = Path("run/results.json")
    document = read_json(results)
    results.write_text(json.dumps({key: entry for key, entry in document.items() if key != "scene"}))
    done = contact1d(*asked)
    assert (done.exit_code, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert done.stderr.startswith("run/results.json is not the results.json of a run; ")
