"""The doctor: a whole installation passes, and each defect is found by its own check."""

from __future__ import annotations

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


def test_dependencies_that_are_old_or_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Versions are compared with what the distribution asks for."""
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: ["numpy>=9999", "no-such-distribution"])
    assert {"numpy", "no-such-distribution"} <= set(failed(doctor.checks()))


def test_a_missing_package_or_style(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both are named."""
    monkeypatch.setattr(doctor, "PACKAGES", ("RIGID", "NO-SUCH-PACKAGE"))
    monkeypatch.setattr(doctor, "STYLES", (("fix", "rigid"), ("fix", "no/such/style")))
    check = next(check for check in doctor.checks() if check.name == "LAMMPS packages")
    assert not check.ok
    assert check.detail == "missing: NO-SUCH-PACKAGE, fix no/such/style"


def test_a_lammps_that_does_not_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """The doctor reports it rather than failing."""

    def broken(*_: object, **__: object) -> None:
        raise EngineError("no LAMMPS here", "start", 0, Path(), "")

    monkeypatch.setattr(Engine, "session", broken)
    check = doctor.checks()[-1]
    assert (check.name, check.ok, check.detail) == ("LAMMPS runs", False, "no LAMMPS here")


def test_lammps_does_not_listen_and_would_without_the_setting(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The worker of a session that ran accepts no connections; with MPI's own defaults it does (mpich with UCX)."""
    monkeypatch.delenv("UCX_TLS", raising=False)
    stop_idle()
    with Engine.session(tmp_path) as session:
        session.execute(doctor.TWO_ATOMS)
        assert doctor.listening_sockets(session.pid) == []
    stop_idle()
    monkeypatch.setenv("UCX_TLS", "all")
    with Engine.session(tmp_path) as session:
        session.execute(doctor.TWO_ATOMS)
        listeners = doctor.listening_sockets(session.pid)
    check = next(check for check in doctor.checks() if check.name == "no network listener")
    stop_idle()
    assert listeners, "this MPI does not listen by itself: the setting is not needed here"
    assert not check.ok
