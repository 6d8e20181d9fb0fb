"""`contact1d doctor`: a whole installation passes, and each defect is found by its own check."""

import importlib.metadata
from pathlib import Path

import pytest

from contact1d import EngineError
from contact1d.workflow.cli import doctor
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.session import Engine


def failed(checks: list[doctor.Check]) -> list[str]:
    """Return the names of the checks that failed, each of which must have advice."""
    assert all(check.advice for check in checks if not check.ok)
    return [check.name for check in checks if not check.ok]


def test_this_installation_is_whole(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """All checks pass, and LAMMPS was really run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: ["numpy>=1", 'absent; extra == "test"'])
    found = doctor.checks()
    assert failed(found) == []
    names = [check.name for check in found]
    assert names == [
        *("Python", "numpy", "current folder", "temporary folder", "processor cores", "LAMMPS starts", "MPI library"),
        *("LAMMPS packages", "two-atom run", "no network listener"),
    ]


def test_what_is_old_or_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Versions are compared with what the distribution asks for, packages and styles with what LAMMPS has."""
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: ["numpy>=9999", "no-such-distribution"])
    monkeypatch.setattr(doctor, "PACKAGES", ("RIGID", "NO-SUCH-PACKAGE"))
    monkeypatch.setattr(doctor, "STYLES", (("fix", "rigid"), ("fix", "no/such/style")))
    found = doctor.checks()
    assert failed(found) == ["numpy", "no-such-distribution", "LAMMPS packages"]
    assert "missing: NO-SUCH-PACKAGE, fix no/such/style" in [check.detail for check in found]


def test_a_lammps_that_does_not_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """The doctor reports it rather than failing."""

    def broken(*_: object, **__: object) -> None:
        raise EngineError("no LAMMPS here", "start", 0, Path(), "")

    monkeypatch.setattr(Engine, "session", broken)
    check = doctor.checks()[-1]
    assert (check.name, check.ok, check.detail) == ("LAMMPS runs", False, "no LAMMPS here")


def test_without_the_setting_lammps_would_listen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A whole installation accepts no connections; with MPI's own defaults it does (mpich with UCX)."""
    stop_idle()
    monkeypatch.setenv("UCX_TLS", "all")
    check = next(check for check in doctor.checks() if check.name == "no network listener")
    stop_idle()
    assert not check.ok, check.detail
