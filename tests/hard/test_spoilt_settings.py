"""Claim: settings that no scene can ask for, as a fault of the program would choose them, give no number unnoticed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contact1d import RunError, Scene, run
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.runs import campaign
from tests.scenes import chains, read_json

TIMED = chains(
    100.0, bodies={"particles": 60}, plate={}, damping={"coefficient": "auto"},
    experiment={"kind": "load", "force": 0.3, "method": "dynamic"},
)  # fmt: skip


def path(*displacements: float) -> dict[str, Any]:
    experiment = {"kind": "path", "displacements": list(displacements)}
    return chains(100.0, bodies={"particles": 60}, experiment=experiment)


def spoil(monkeypatch: pytest.MonkeyPatch, record: str, **numbers: float) -> None:
    choose: Callable[..., Any] = campaign.settings_for

    def spoilt(scene: Scene) -> Settings:
        chosen = choose(scene)
        return replace(chosen, **{record: replace(getattr(chosen, record), **numbers)})

    monkeypatch.setattr(campaign, "settings_for", spoilt)


def failure(scene: dict[str, Any], folder: Path) -> str:
    with pytest.raises(RunError) as caught:
        run(scene, folder, figures=False)
    assert read_json(folder / "results.json")["status"] == "failed"
    return str(caught.value)


@pytest.mark.parametrize("numbers", [{"time_step": 50.0}, {"damping": 1e4}])
def test_a_motion_that_explodes_is_no_result(
    numbers: dict[str, float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A drag that takes away many times the momentum that there is in a time step does, too."""
    spoil(monkeypatch, "motion", **numbers)
    said = failure(TIMED, tmp_path / "run")
    assert any(words in said for words in ("finite", "left the box", "went through", "missing"))


def test_a_minimisation_that_is_cut_short_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("contact1d.workflow.deck.parts.MINIMISER_ITERATIONS", 1)
    assert "not converged" in failure(path(0.3), tmp_path / "run")


def test_particles_closer_than_the_table_was_chosen_for_get_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(monkeypatch, "forces", table_from=0.1)
    assert "table_core" in run(path(0.0, 1.7)).warnings  # one leap: the rows between are the program's
