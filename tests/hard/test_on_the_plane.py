"""Claim: odd scenes on the rigid plane end in a right number or in words whose remedy works, not in a wrong remedy."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from contact1d import RunError, SceneError, read_scene, run
from contact1d.analysis.theory.indenters import PowerLaw
from contact1d.workflow.continuation import contact
from validation.references.indenters import jkr
from validation.references.mdr import ReducedContact

RADIUS, ENERGY = 1000.0, 0.005


DIGITS = 1e-11
"""Relative, of a force: steps of a search end where the curve is straight."""


def scene(**more: Any) -> dict[str, Any]:
    """A sphere on springs of E* = 1; `more` are its other tables."""
    bodies = {
        "particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "profile": {"kind": "parabola", "radius": RADIUS},
        "bulk_stiffness": 1.0,
    }  # fmt: skip
    return {"title": "odd", "bodies": bodies} | more


def steel(**more: Any) -> dict[str, Any]:
    """A sphere of 10 mm in SI, its spacing left open, 1 LU = 1 m."""
    elastic = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
    bodies = {
        "particles": "auto", "spacing": "auto", "lower": "rigid_plane",
        "profile": {"kind": "parabola", "radius": "10 mm"},
    }  # fmt: skip
    return {"title": "odd", "bodies": bodies, "material": {"upper": elastic, "lower": elastic}} | more


def along(force: float, friction: float, *places: float) -> dict[str, Any]:
    experiment = {"kind": "tangential", "normal_force": force, "displacements": list(places)}
    return scene(friction={"coefficient": friction}, experiment=experiment)


def test_nothing_is_pulled_off_that_nothing_holds() -> None:
    tables = scene(adhesion={"surface_energy": 0.0}, experiment={"kind": "pull_off", "preload": 1.0})
    with pytest.raises(SceneError, match=r"adhesion\.surface_energy = 0\.0: must be greater than 0"):
        read_scene(tables)


@pytest.mark.parametrize("more", [{}, {"range": 0.1}])
def test_adhesion_without_an_energy_is_none(more: dict[str, float], tmp_path: Path) -> None:
    load = scene(experiment={"kind": "load", "force": 1.0})
    found = run(load | {"adhesion": {"work_of_adhesion": 0.0} | more}, tmp_path / "none", figures=False)
    assert found.results == run(load, tmp_path / "without", figures=False).results


@pytest.mark.parametrize("load", [0.1, 3.0, 77.7])
def test_a_load_has_its_digits_however_few_particles_carry_it(load: float, tmp_path: Path) -> None:
    tables = scene(experiment={"kind": "load", "force": load})
    tables["bodies"] |= {"particles": 41, "profile": {"kind": "parabola", "radius": 100.0}}
    found = run(tables, tmp_path / "run", figures=False).outcome.results["force"].value
    assert found == pytest.approx(load, rel=DIGITS)


def test_load_steps_that_are_read_in_parts_are_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = scene(experiment={"kind": "history", "displacement": [[0.0, 0.0], [1.0, 0.2], [2.0, -0.1]]})
    whole = run(tables, tmp_path / "whole", figures=False)
    monkeypatch.setattr(contact, "MOST_NUMBERS", 7 * whole.outcome.states[0].profile.x.size)
    parts = run(tables, tmp_path / "parts", figures=False)
    assert (parts.curve.force == whole.curve.force).all()


@pytest.mark.parametrize("work", [1e-300, 1e-30])
def test_a_hold_below_the_last_digit_is_no_number(work: float, tmp_path: Path) -> None:
    tables = scene(adhesion={"work_of_adhesion": work}, experiment={"kind": "pull_off", "preload": 1.0})
    with pytest.raises(RunError, match=r"too small compared with .* round-off error .*: use a larger adhesion"):
        run(tables, tmp_path / "run", figures=False)


def test_a_load_below_the_last_digit_is_not_told_to_be_smaller(tmp_path: Path) -> None:
    with pytest.raises(RunError, match=r"too small to resolve .*: use a larger load") as caught:
        run(scene(experiment={"kind": "load", "force": 1e-30}), tmp_path / "run", figures=False)
    assert "smaller load" not in str(caught.value)
    assert "Tried" not in str(caught.value)


def test_a_tension_that_is_not_held_is_told_what_is(tmp_path: Path) -> None:
    tables = scene(adhesion={"work_of_adhesion": ENERGY}, experiment={"kind": "load", "force": -100.0})
    with pytest.raises(RunError) as caught:
        run(tables, tmp_path / "run", figures=False)
    held = PowerLaw.sphere(RADIUS, 1.0, ENERGY).pull_off_force()
    assert f"the pull-off force is about {held:.4g} FU. Tried: --set experiment.force=" in str(caught.value)
    assert "gives a result" in str(caught.value)


def test_a_way_of_nothing_is_not_doubted(tmp_path: Path) -> None:
    found = run(along(40.0, 0.3, 1e-12), tmp_path / "run", figures=False)
    assert "dissipated_energy" not in found.warnings.get("tolerance", "")


def test_the_energy_of_many_cycles_is_as_uncertain_as_that_of_one(tmp_path: Path) -> None:
    """Relative to itself, which the warning compares with the tolerance."""
    one, many = (
        run(along(40.0, 0.3, *([0.2, -0.2] * count)), tmp_path / str(count), figures=False) for count in (1, 100)
    )
    shares = [
        found.results.dissipated_energy.uncertainty / found.results.dissipated_energy.value for found in (one, many)
    ]
    assert shares[1] == pytest.approx(shares[0], rel=0.5)
    assert all("dissipated_energy" in found.warnings["lattice"] for found in (one, many))


@pytest.mark.parametrize(
    "experiment",
    [{"kind": "load", "force": 0.0}, {"kind": "path", "displacements": [0.0]}, {"kind": "pull_off", "preload": "1 mN"}],
)
def test_an_adhesive_contact_in_metres_finds_its_own_spacing(experiment: dict[str, Any], tmp_path: Path) -> None:
    found = run(steel(adhesion={"surface_energy": "50 mJ/m²"}, experiment=experiment), tmp_path / "run", figures=False)
    modulus = 210e9 / 2.0 / (1.0 - 0.3**2)
    radius = PowerLaw.sphere(0.01, modulus, 0.1).zero_load_radius()
    assert 20.0 < radius / found.scene.bodies.spacing < 100.0
    if experiment["kind"] == "pull_off":
        force = found.results.adhesion_force
        assert abs(force.value - 1.5 * math.pi * 0.1 * 0.01) <= force.uncertainty


def test_a_path_down_and_up_again_has_the_tension_of_its_way_apart(tmp_path: Path) -> None:
    """On the way together the bodies jump into contact at 8/9 of JKR's largest tension."""
    span = {"from": "10 nm", "to": "-10 nm", "steps": 200}
    tables = steel(adhesion={"surface_energy": "50 mJ/m²"}, experiment={"kind": "path", "displacements": span})
    force = run(tables, tmp_path / "run", figures=False).results.adhesion_force
    assert abs(force.value - 1.5 * math.pi * 0.1 * 0.01) <= force.uncertainty


def energies(contact: ReducedContact) -> tuple[float, float, float]:
    """What snap-in at touch and separation under fixed grips lose, and the work from F = 0 to separation."""
    snapped, parted, rested = (
        contact.energy(a) - math.pi * a**2 * contact.work_of_adhesion
        for a in (contact.snap_in_radius(), contact.fixed_grips_radius(), contact.zero_load_radius())
    )
    return -snapped, parted, parted - rested


@pytest.mark.parametrize("steps", [40, 400])
@pytest.mark.parametrize(
    ("slope", "ends", "returns"),
    [
        (lambda r: r / RADIUS, (-1.0, 1.0), False),
        (lambda _: 0.02, (1.0, -1.0), False),
        (lambda r: r / RADIUS, (-0.05, 1.0), True),
        (lambda _: 0.02, (-1.0, 1.0), True),
    ],
)
def test_a_path_with_adhesion_has_the_energy_of_its_instabilities(
    slope: Callable[[float], float], ends: tuple[float, float], returns: bool, steps: int, tmp_path: Path
) -> None:
    """Dissipated by a closed path, lost by an open one; and the work from F = 0 to separation."""
    contact = ReducedContact(slope, 1.0, ENERGY)
    snap_in, separation, work = energies(contact)
    profile = {"kind": "cone", "slope": 0.02} if slope(1.0) == slope(2.0) else {"kind": "parabola", "radius": RADIUS}
    limit, rested = (contact.displacement(a) for a in (contact.fixed_grips_radius(), contact.zero_load_radius()))
    start, end = (-1.5 * limit * end if end < 0.0 else 1.5 * max(rested, -limit) * end for end in ends)
    span = {"from": start, "to": end, "steps": steps, "return": returns}
    tables = scene(adhesion={"work_of_adhesion": ENERGY}, experiment={"kind": "path", "displacements": span})
    tables["bodies"] |= {"profile": profile}
    found = run(tables, tmp_path / "run", figures=False)
    parts = ends == (1.0, -1.0) or (returns and ends[0] == -1.0)
    touches = ends[0] < 0.0
    exact = {"dissipated_energy" if returns and parts else "instability_energy": touches * snap_in + parts * separation}
    exact |= {"work_of_separation": work} if parts else {}
    named = {"dissipated_energy", "instability_energy", "work_of_separation"} & found.document.keys()
    assert named == set(exact)
    for name, value in exact.items():
        if name in found.results:
            assert abs(found.results[name].value - value) <= found.results[name].uncertainty
    assert steps == 40 or set(exact) <= found.results.keys()


def test_a_path_that_only_loads_says_that_nothing_was_pulled(tmp_path: Path) -> None:
    path = {"kind": "path", "displacements": {"from": -1.0, "to": 1.0, "steps": 20, "return": False}}
    found = run(scene(adhesion={"work_of_adhesion": ENERGY}, experiment=path), tmp_path / "run", figures=False)
    assert "adhesion_force" not in found.results
    assert "never unloads the contact" in found.warnings["no_peak"]


def test_the_finest_tolerance_claims_what_its_particles_leave(tmp_path: Path) -> None:
    tables = steel(accuracy={"tolerance": 1e-7}, experiment={"kind": "load", "force": "10 N"})
    found = run(tables, tmp_path / "run", figures=False)
    modulus = 210e9 / 2.0 / (1.0 - 0.3**2)
    exact = (0.75 * 10.0 / modulus / math.sqrt(0.01)) ** (2.0 / 3.0)
    place = found.results.displacement
    assert abs(place.value - exact) <= place.uncertainty <= 1e-7 * exact
    assert "tolerance" not in found.warnings


def test_an_adhesive_load_keeps_its_tolerance_in_its_mean_pressure_too(tmp_path: Path) -> None:
    tables = steel(adhesion={"surface_energy": "50 mJ/m²"}, experiment={"kind": "load", "force": "1 N"})
    assert "tolerance" not in run(tables, tmp_path / "run", figures=False).warnings


@pytest.mark.parametrize("times", [300.0, 1e4])
@pytest.mark.parametrize("kind", ["parabola", "circle"])
def test_a_large_preload_does_not_lose_the_pull_off(kind: str, times: float, tmp_path: Path) -> None:
    """The attraction is then less than a thousandth of the way back."""
    exact = jkr(1.0, 1.0, 2.8e-10)
    spacing = exact.zero_load_radius() / 30.0
    bodies = {
        "particles": "auto", "spacing": spacing, "reduction": "mdr", "lower": "rigid_plane",
        "profile": {"kind": kind, "radius": 1.0}, "bulk_stiffness": spacing,
    }  # fmt: skip
    preload = {"kind": "pull_off", "preload": times * exact.pull_off_force()}
    tables = {"title": "pressed hard", "bodies": bodies, "adhesion": {"work_of_adhesion": 2.8e-10}}
    found = run(tables | {"experiment": preload}, tmp_path / "run", figures=False).results
    for name, value in (("adhesion_force", exact.pull_off_force()), ("zero_load_radius", exact.zero_load_radius())):
        assert found[name].value == pytest.approx(value, rel=1e-3)
        assert abs(found[name].value - value) <= found[name].uncertainty


def test_dashpots_on_a_table_are_those_of_the_paraboloid_that_it_samples(tmp_path: Path) -> None:
    table = {"kind": "table", "r": [float(r) for r in range(61)], "z": [0.5 * r * r / RADIUS for r in range(61)]}
    more = {
        "viscoelasticity": {"retardation_time": 0.3},
        "experiment": {"kind": "history", "displacement": [[0.0, 0.0], [1.0, 1.0], [2.0, 0.2]]},
    }
    peaks = []
    for name, profile in {"table": table, "formula": {"kind": "parabola", "radius": RADIUS}}.items():
        tables = scene(**more)
        tables["bodies"] |= {"profile": profile}
        peaks.append(run(read_scene(tables), tmp_path / name, figures=False).results["peak_force"])
    assert abs(peaks[0].value - peaks[1].value) <= peaks[0].uncertainty
