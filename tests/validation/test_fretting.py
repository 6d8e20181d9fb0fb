"""Claim: `cycles` is another way of writing displacements, and a cycle dissipates Mindlin and Deresiewicz's energy.

Reference: quadrature of Cattaneo and Mindlin's T(u) along the branches of Masing's rules.

What limits the tolerances: a load step is exact, so that only the lattice is left, and the run states how much it is.
"""

import os
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import run
from contact1d.analysis.theory.mindlin import mindlin_cycle_energy
from tests.command import contact1d
from tests.pages import require_shown
from tests.scenes import ROOT
from validation.references.mindlin import mindlin_loop_area

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


def fretting(**cycles: Any) -> dict[str, Any]:
    """The page's scene with other cycles."""
    return FRETTING | {"experiment": FRETTING["experiment"] | {"cycles": FRETTING["experiment"]["cycles"] | cycles}}


@pytest.mark.parametrize("amplitude", [1e-6, 0.4, 1.5])
def test_the_energy_of_a_cycle_is_the_area_of_the_loop(amplitude: float) -> None:
    """Which `test_mindlin` has by quadrature; of small ones no digit is lost: 0.5 u_m³ (1 + u_m/4 …)."""
    energy = mindlin_cycle_energy(amplitude, 1.0, 1.0, 1.0)
    area = (
        float(mindlin_loop_area(amplitude, 1.0, 1.0, 1.0))
        if amplitude > 1e-3
        else 0.5 * amplitude**3 * (1.0 + 0.25 * amplitude)
    )
    assert energy == pytest.approx(area, rel=QUADRATURE)


def test_the_first_cycle_is_the_steady_state_and_cycles_are_their_displacements() -> None:
    """Every cycle dissipates the same, the area of the loop; the initial loading belongs to none."""
    amplitude = 0.4 * SLIDING
    one, three = (run(fretting(amplitude=f"{amplitude!r} m", number=number)) for number in (1, 3))
    cycle, results = one.results.dissipated_energy_per_cycle.value, three.results
    assert results.dissipated_energy_per_cycle.value == pytest.approx(cycle, rel=STEADY)
    assert results.dissipated_energy.value - one.results.dissipated_energy.value == pytest.approx(
        2.0 * cycle, rel=STEADY
    )
    energy = three.friction["dissipated_energy"]
    assert energy[-1] - energy[-41] == results.dissipated_energy_per_cycle.value
    force, u = three.friction["tangential_force"], three.friction["tangential_displacement"]
    assert np.trapezoid(force[-41:], u[-41:]) == pytest.approx(cycle, rel=2e-2)  # straight lines between load steps

    quarter = np.arange(10) / 10.0
    turn = np.concatenate([1.0 - quarter, -quarter, quarter - 1.0, quarter])
    places = amplitude * np.concatenate([quarter, *[turn] * 3, [1.0]])
    experiment = {key: value for key, value in FRETTING["experiment"].items() if key != "cycles"}
    experiment["displacements"] = [f"{place!r} m" for place in places.tolist()]
    listed = run(FRETTING | {"experiment": experiment})
    assert u == pytest.approx(places, rel=SAME, abs=SAME * amplitude)
    for name in three.curve.units:
        column = three.curve[name]
        assert listed.curve[name] == pytest.approx(column, abs=STEADY * np.abs(column).max(), nan_ok=True)
    assert three.curve.branch.tolist() == listed.curve.branch.tolist()
    assert set(results) - set(listed.results) == {"dissipated_energy_per_cycle"}
    for name, found in listed.results.items():
        assert results[name].value == pytest.approx(found.value, rel=STEADY)


def test_the_page_shows_what_its_scene_prints_and_a_loop(tmp_path: Path) -> None:
    (tmp_path / "fretting.toml").write_text(TEXT, encoding="utf-8")
    done = contact1d("run", tmp_path / "fretting.toml", "--out", tmp_path / "run", "-q")
    assert done.exit_code == 0, done.output
    names = ("  tangential force", "  contact radius", "  stick radius", "  dissipated energy")
    lines = [line for line in done.stdout.splitlines() if line.startswith(names)]
    require_shown("docs/how_to/shear.md", "fretting", "\n".join(["```text", *lines, "```", ""]))
    drawn = tmp_path / "run" / "tangential.png"
    assert drawn.stat().st_size > 10_000
    if os.environ.get("WRITE_DOCS"):
        (PAGE.parent.parent / "shear.png").write_bytes(drawn.read_bytes())
    assert (PAGE.parent.parent / "shear.png").is_file()
