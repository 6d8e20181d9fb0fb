"""Claim: `cycles` is another way of writing displacements, and a cycle dissipates Mindlin and Deresiewicz's energy.

Reference: quadrature of Cattaneo and Mindlin's T(u) along the branches of Masing's rules.

What limits the tolerances: a load step is exact, so that only the lattice is left, and the run states how much it is.
"""

from __future__ import annotations

import math
import os
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from typer.testing import CliRunner

from contact1d import Run, SceneError, read_scene, run
from contact1d.__main__ import app
from contact1d.analysis.theory.mindlin import mindlin_cycle_energy
from tests.pages import ROOT, require_shown
from validation.references.mindlin import mindlin_force

PAGE = ROOT / "docs" / "how_to" / "shear.md"
TEXT = PAGE.read_text(encoding="utf-8").partition("```toml\n")[2].partition("```")[0]
FRETTING = tomllib.loads(TEXT)
FRICTION, LOAD, RADIUS = 0.3, 10.0, 0.01
"""μ, N [N] and R [m] of the page's scene."""
MODULUS, SHEAR = 210e9 / (2.0 * 0.91), 210e9 / 2.6
"""E* and G [Pa] of two bodies of steel."""
EDGE = (0.75 * LOAD * RADIUS / MODULUS) ** (1.0 / 3.0)
SLIDING = 3.0 * FRICTION * LOAD / (16.0 * EDGE) * 2.0 * 1.7 / SHEAR
"""a and u* [m] by Johnson, sections 4.2 and 7.2."""
QUADRATURE = 1e-9
"""Relative: scipy's quad of a function with a root at its end."""
SAME = 1e-13
"""Relative: round-off of places, and of what their differences dissipate."""
STEADY = 1e-11
"""Relative: the same of one cycle beside another, which begins at a force with other round-off."""
CYCLES = ((0.4, 1), (0.4, 3), (1.5, 1), (1.5, 3))
"""u_m/u* and number of cycles: partial slip and sliding."""


def fretting(**cycles: Any) -> dict[str, Any]:
    """The page's scene with other cycles."""
    return FRETTING | {"experiment": FRETTING["experiment"] | {"cycles": FRETTING["experiment"]["cycles"] | cycles}}


def as_displacements(places: list[float]) -> dict[str, Any]:
    experiment = {key: value for key, value in FRETTING["experiment"].items() if key != "cycles"}
    return FRETTING | {"experiment": experiment | {"displacements": [f"{place!r} m" for place in places]}}


def around(amplitude: float) -> float:
    """∮ F_x du of N = μ = u* = 1 by quadrature of the loop's width, F_x there less F_x back (Masing's rules)."""

    def first(u: float) -> float:
        return float(mindlin_force(u, 1.0, 1.0, 1.0))

    def width(u: float) -> float:
        return 2.0 * (first(0.5 * (amplitude + u)) + first(0.5 * (amplitude - u)) - first(amplitude))

    kinks = [u for u in (2.0 - amplitude, amplitude - 2.0) if 0.0 < u < amplitude]
    half, _ = quad(width, 0.0, amplitude, points=kinks or None, epsabs=0.0, epsrel=0.1 * QUADRATURE, limit=200)
    return float(2.0 * half)


@pytest.mark.parametrize("amplitude", [0.05, 0.4, 0.99, 1.0, 1.5, 7.0])
def test_the_closed_form_is_the_integral_around_the_loop(amplitude: float) -> None:
    assert mindlin_cycle_energy(amplitude, 1.0, 1.0, 1.0) == pytest.approx(around(amplitude), rel=QUADRATURE)


def test_of_small_cycles_no_digit_is_lost() -> None:
    """W = μN u_m³/2u*² (1 + u_m/4u* …): third power of the amplitude, as long as most sticks."""
    for amplitude in (1e-3, 1e-6):
        series = 0.5 * amplitude**3 * (1.0 + 0.25 * amplitude)
        assert mindlin_cycle_energy(amplitude, 1.0, 1.0, 1.0) == pytest.approx(series, rel=amplitude**2 + 1e-9)
    assert mindlin_cycle_energy(0.0, 1.0, 1.0, 1.0) == 0.0


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[float, int], Run]:
    """By u_m/u* and number."""
    return {
        (share, number): run(
            fretting(amplitude=f"{share * SLIDING!r} m", number=number), tmp_path_factory.mktemp("run"), figures=False
        )
        for share, number in CYCLES
    }


@pytest.mark.parametrize("share", [0.4, 1.5])
def test_the_first_cycle_is_the_steady_state(runs: dict[tuple[float, int], Run], share: float) -> None:
    """Every cycle dissipates the same, which is the area of the loop; the initial loading belongs to none."""
    one, three = (runs[share, number].results for number in (1, 3))
    cycle = one.dissipated_energy_per_cycle.value
    assert three.dissipated_energy_per_cycle.value == pytest.approx(cycle, rel=STEADY)
    assert three.dissipated_energy.value - one.dissipated_energy.value == pytest.approx(2.0 * cycle, rel=STEADY)
    columns = runs[share, 3].friction
    energy = columns["dissipated_energy"]
    assert energy[-1] - energy[-41] == three.dissipated_energy_per_cycle.value
    force, u = columns["tangential_force"], columns["tangential_displacement"]
    assert np.trapezoid(force[-41:], u[-41:]) == pytest.approx(cycle, rel=2e-2)  # straight lines between load steps


def test_cycles_are_the_same_run_as_their_displacements(runs: dict[tuple[float, int], Run], tmp_path: Path) -> None:
    """Curve, forces and energies; only what belongs to a cycle is missing."""
    cycles = runs[0.4, 3]
    amplitude, quarter = 0.4 * SLIDING, np.arange(10) / 10.0
    cycle = np.concatenate([1.0 - quarter, -quarter, quarter - 1.0, quarter])
    places = amplitude * np.concatenate([quarter, *[cycle] * 3, [1.0]])
    listed = run(as_displacements(places.tolist()), tmp_path / "run", figures=False)
    experiment: Any = cycles.scene.experiment
    assert experiment.along() == pytest.approx(places, rel=SAME, abs=SAME * amplitude)
    assert max(experiment.along()) == -min(experiment.along()) == experiment.excursion
    for name in cycles.curve.units:
        column = cycles.curve[name]
        assert listed.curve[name] == pytest.approx(column, abs=STEADY * np.abs(column).max(), nan_ok=True)
    assert cycles.curve.branch.tolist() == listed.curve.branch.tolist()
    assert set(cycles.results) - set(listed.results) == {"dissipated_energy_per_cycle"}
    for name, one in listed.results.items():
        assert cycles.results[name].value == pytest.approx(one.value, rel=STEADY)


def test_a_load_that_goes_with_the_cycle_has_its_energy_and_no_theory(tmp_path: Path) -> None:
    """One normal force for each load step: 2 + 2·8 + 1."""
    loads = [f"{10.0 + math.sin(0.25 * math.pi * i)!r} N" for i in range(19)]
    tables = fretting(amplitude="0.2 um", number=2, points=8)
    tables["experiment"] = tables["experiment"] | {"normal_force": loads}
    found = run(tables, tmp_path / "run", figures=False)
    energy = found.friction["dissipated_energy"]
    assert found.results.dissipated_energy_per_cycle.value == pytest.approx(energy[-1] - energy[-9], rel=1e-12)
    assert found.document["theory"] == []


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("cycles.points=42", ("cycles.points = 42: must be a multiple of 4", "the nearest are 40 and 44")),
        ("cycles.points=3", ("cycles.points = 3: must be a multiple of 4", "the nearest are 4 and 8")),
        ("cycles.points=999", ("the nearest are 996 and 1000",)),
        ("cycles.points=4000", ("cycles.points = 4000: must be a whole number from 1 to 1000",)),
        ("cycles.number=0", ("cycles.number = 0: must be a whole number from 1 to 1000",)),
        ("cycles.number=1.5", ("cycles.number = 1.5: must be a whole number",)),
        ("cycles.amplitude=0", ("cycles.amplitude = 0: must be greater than 0 (m)",)),
        ("cycles.amplitude='3 N'", ("cycles.amplitude = \"3 N\": must be a length",)),
        ("cycles.turns=3", ("cycles.turns: unknown key", "allowed here: amplitude, number, points")),
        ("displacements=['1 um']", ("cycles: not together with displacements", "or cycles = { amplitude, number,")),
        ("normal_force=['1 N', '2 N']", ("as many as there are displacements, 131; these are 2",)),
    ],
)  # fmt: skip
def test_wrong_cycles_are_one_sentence(given: str, words: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(FRETTING, [f"experiment.{given}"])
    (problem,) = str(caught.value).splitlines()
    assert problem.startswith("experiment.")
    assert all(word in problem for word in words)


def test_without_displacements_the_message_names_both_ways() -> None:
    tables = as_displacements([])
    del tables["experiment"]["displacements"]
    with pytest.raises(SceneError, match=r"missing; give displacements .m., or cycles = { amplitude, number,"):
        read_scene(tables)


def test_the_page_shows_what_its_scene_prints_and_a_loop(tmp_path: Path) -> None:
    (tmp_path / "fretting.toml").write_text(TEXT, encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "fretting.toml"), "--out", str(tmp_path / "run"), "-q"])
    assert done.exit_code == 0, done.output
    names = ("  tangential force", "  contact radius", "  stick radius", "  dissipated energy")
    lines = [line for line in done.stdout.splitlines() if line.startswith(names)]
    require_shown("docs/how_to/shear.md", "fretting", "\n".join(["```text", *lines, "```", ""]))
    drawn = tmp_path / "run" / "tangential.png"
    assert drawn.stat().st_size > 10_000
    if os.environ.get("WRITE_DOCS"):
        (PAGE.parent.parent / "shear.png").write_bytes(drawn.read_bytes())
    assert (PAGE.parent.parent / "shear.png").is_file()
    columns = run(TEXT, figures=False).friction
    force = columns["tangential_force"][columns["tangential_displacement"] == 0.0][-2:]  # backward, then forward
    assert force[0] == pytest.approx(-force[1], rel=1e-3)
    assert force[1] > 0.1 * columns["tangential_force"].max()  # open: a straight line would go through 0
