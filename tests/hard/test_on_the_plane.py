"""Claim: odd scenes on the rigid plane end in a right number or in words whose remedy works, not in a wrong remedy."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from contact1d import RunError, run
from tests.scenes import chains, in_si
from validation.references.mdr import ReducedContact, with_zero_load_radius

RADIUS, ENERGY = 1000.0, 0.005
WORK, MODULUS = 0.1, 210e9 / 2.0 / (1.0 - 0.3**2)
"""Of `STEEL` that adheres [J/m², Pa]."""
ADHERES = {"adhesion": {"surface_energy": "50 mJ/m²"}}


def scene(**more: Any) -> dict[str, Any]:
    """A sphere on springs of E* = 1; `more` are its other tables."""
    return chains(RADIUS, 1.0, title="odd", interaction=None, bodies={"lower": "rigid_plane"}, **more)


def steel(**more: Any) -> dict[str, Any]:
    """A sphere of 10 mm in SI, its spacing left open, 1 LU = 1 m."""
    elastic = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
    sphere = {"kind": "parabola", "radius": "10 mm"}
    return in_si(sphere, title="odd", material={"upper": elastic, "lower": elastic}, **more)


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (
            {"adhesion": {"work_of_adhesion": 1e-30}, "experiment": {"kind": "pull_off", "preload": 1.0}},
            r"too small compared with .* round-off error .*: use a larger adhesion",
        ),
        ({"experiment": {"kind": "load", "force": 1e-30}}, r"too small to resolve .*: use a larger load(?!.*Tried)"),
        (
            {"adhesion": {"work_of_adhesion": ENERGY}, "experiment": {"kind": "load", "force": -100.0}},
            f"the pull-off force is about {1.5 * math.pi * ENERGY * RADIUS:.4g} FU. "
            r"Tried: --set experiment.force=.*gives a result",
        ),
    ],
)
def test_what_cannot_be_resolved_or_held_has_the_remedy_that_helps(
    tables: dict[str, Any], words: str, tmp_path: Path
) -> None:
    with pytest.raises(RunError, match=words):
        run(scene(**tables), tmp_path / "run", figures=False)


def test_a_path_down_and_up_again_has_the_tension_of_its_way_apart() -> None:
    """On the way together the bodies jump into contact at 8/9 of JKR's largest tension."""
    span = {"from": "10 nm", "to": "-10 nm", "steps": 100}
    found = run(steel(**ADHERES, experiment={"kind": "path", "displacements": span}))
    force = found.results.adhesion_force
    assert abs(force.value - 1.5 * math.pi * WORK * 0.01) <= force.uncertainty


def energies(contact: ReducedContact) -> tuple[float, float, float]:
    """What snap-in at touch and separation under fixed grips lose, and the work from F = 0 to separation."""
    snapped, parted, rested = (
        contact.energy(a) for a in (contact.snap_in_radius(), contact.fixed_grips_radius(), contact.zero_load_radius())
    )
    return -snapped, parted, parted - rested


@pytest.mark.parametrize(
    ("slope", "ends", "returns", "steps"),
    [
        (lambda r: r / RADIUS, (-1.0, 1.0), False, 150),
        (lambda _: 0.02, (1.0, -1.0), False, 400),
        (lambda r: r / RADIUS, (-0.05, 1.0), True, 40),
        (lambda _: 0.02, (-1.0, 1.0), True, 150),
    ],
)
def test_a_path_with_adhesion_has_the_energy_of_its_instabilities(
    slope: Callable[[float], float], ends: tuple[float, float], returns: bool, steps: int
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
    found = run(tables)
    parts = ends == (1.0, -1.0) or (returns and ends[0] == -1.0)
    touches = ends[0] < 0.0
    exact = {"dissipated_energy" if returns and parts else "instability_energy": touches * snap_in + parts * separation}
    exact |= {"work_of_separation": work} if parts else {}
    assert {"dissipated_energy", "instability_energy", "work_of_separation"} & found.document.keys() == set(exact)
    for name in exact.keys() & found.results.keys():
        assert abs(found.results[name].value - exact[name]) <= found.results[name].uncertainty
    assert steps == 40 or set(exact) <= found.results.keys()


def test_a_path_that_only_loads_says_that_nothing_was_pulled() -> None:
    path = {"kind": "path", "displacements": {"from": -1.0, "to": 1.0, "steps": 20, "return": False}}
    found = run(scene(adhesion={"work_of_adhesion": ENERGY}, experiment=path))
    assert "adhesion_force" not in found.results
    assert "never unloads the contact" in found.warnings["no_peak"]


def test_the_finest_tolerance_claims_what_its_particles_leave() -> None:
    tables = steel(accuracy={"tolerance": 1e-7}, experiment={"kind": "load", "force": "10 N"})
    found = run(tables)
    exact = (0.75 * 10.0 / MODULUS / math.sqrt(0.01)) ** (2.0 / 3.0)
    place = found.results.displacement
    assert abs(place.value - exact) <= place.uncertainty <= 1e-7 * exact
    assert "tolerance" not in found.warnings


FLATTEST = 1.58e-3
"""a₀/R of a sphere with W = 2.8e-10 E*R, whose a/R stays below 0.1 after these preloads; a₀ = 1 here."""
BLUNT: dict[str, tuple[dict[str, Any], Callable[[float], float]]] = {
    "parabola": ({"radius": 1.0 / FLATTEST}, lambda r: FLATTEST * r),
    "circle": ({"radius": 1.0 / FLATTEST}, lambda r: r / math.sqrt(FLATTEST**-2 - r * r)),
    "cone": ({"slope": FLATTEST}, lambda _: FLATTEST),
    "power": ({"exponent": 3.0, "radius": 1.0, "height": FLATTEST / 3.0}, lambda r: FLATTEST * r * r),
}
PRELOADS, TOLERANCES = (1.0, 1e3, 1e6), (1e-2, 1e-3, 1e-4, 1e-5)


@pytest.mark.parametrize("kind", BLUNT)
@pytest.mark.parametrize("times", PRELOADS)
def test_a_large_preload_does_not_lose_the_pull_off(kind: str, times: float) -> None:
    """The attraction is then less than a millionth of the way back."""
    numbers, slope = BLUNT[kind]
    exact = with_zero_load_radius(slope, 1.0, 1.0)
    tables = scene(adhesion={"work_of_adhesion": exact.work})
    tables["bodies"] |= {"spacing": 0.05, "bulk_stiffness": 0.05, "profile": {"kind": kind} | numbers}
    tables["experiment"] = {"kind": "pull_off", "preload": times * exact.pull_off_force()}
    tolerance = TOLERANCES[([*BLUNT].index(kind) + 2 * PRELOADS.index(times)) % len(TOLERANCES)]
    found = run(tables | {"accuracy": {"tolerance": tolerance}})
    for name, value in (("adhesion_force", exact.pull_off_force()), ("zero_load_radius", 1.0)):
        one = found.results[name]
        assert abs(one.value - value) <= one.uncertainty
        assert one.uncertainty <= tolerance * value or any(name in words for words in found.warnings.values())
