"""Numbers with ±: what they change of each result is that of the closed forms."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from contact1d import Quantity, Run, SceneError, load_run, read_scene, run, sphere
from tests.scenes import SCENES, in_si

HERTZ = SCENES / "hertz_plane.toml"
SHARES = {"bodies.profile.radius": 0.01, "material.contact_modulus": 0.03, "adhesion.work_of_adhesion": 0.02}
EXPONENTS = {
    "adhesion_force": (1, 0, 1),
    "zero_load_radius": (2 / 3, -1 / 3, 1 / 3),
    "adhesion_energy": (4 / 3, -2 / 3, 5 / 3),
    "central_pressure": (-1 / 3, 2 / 3, 1 / 3),
}
"""JKR: F_A = 1.5πWR, a₀³ = 9πWR²/2E*, E = πa₀²W, p(0) ∝ E*a₀/R at F = 0, of R, E* and W."""
NONLINEAR = 0.03
"""Of a change, what the larger one of both ways is beyond the linear one: exponents of 2/3 at 3 %."""


def given(found: Run, name: str) -> float:
    """What the inputs change of a result, over it."""
    one = found.document[name]
    return float(one["errors"]["input"] / one["value"])


def share(one: Quantity) -> float:
    return one.uncertainty / one.value


def combined(powers: tuple[float, ...], shares: tuple[float, ...]) -> float:
    return math.hypot(*(power * own for power, own in zip(powers, shares, strict=True)))


def test_each_result_has_the_exponents_of_jkr_beside_its_own_uncertainty() -> None:
    """A table says which input matters; the deck is that of the numbers alone."""
    found, known = (
        sphere(radius=radius, contact_modulus=modulus, work_of_adhesion=work).pull_off()
        for radius, modulus, work in (
            ("2 ± 0.02 mm", "2.6666666666666667 MPa ± 3 %", "80 mJ/m² ± 1.6 mJ/m²"),
            ("2 mm", "2.6666666666666667 MPa", "80 mJ/m²"),
        )
    )
    for name, powers in EXPONENTS.items():
        own, exact = found.document[name], known.document[name]
        assert given(found, name) == pytest.approx(combined(powers, tuple(SHARES.values())), rel=NONLINEAR)
        assert own["value"] == exact["value"]
        assert own["uncertainty"] - own["errors"]["input"] == pytest.approx(exact["uncertainty"], rel=1e-6)
    assert "errors" not in known.document["adhesion_force"]
    assert "inputs" not in known.document
    assert found.warnings == known.warnings
    for file in ("in.lammps", "system.data", "adhesion.cells"):
        assert (found.folder / file).read_text() == (known.folder / file).read_text()
    table = found.tables["inputs"]
    rows = zip(*(table[name].tolist() for name in ("input", "half_width", "adhesion_force")), strict=True)
    told = {name: own for name, *own in rows}
    assert told == {
        name: pytest.approx([own, own * power], rel=0.02, abs=1e-5)
        for (name, own), power in zip(SHARES.items(), EXPONENTS["adhesion_force"], strict=True)
    }
    again = load_run(found.folder)
    assert again.scene.shares == found.scene.shares
    assert again.tables["inputs"]["adhesion_force"] == pytest.approx(table["adhesion_force"], rel=1e-9, abs=1e-12)


def test_a_number_with_an_uncertainty_hides_no_error_of_the_run() -> None:
    """Of the largest force: the tolerance is asked of what the program adds."""
    exact = read_scene(HERTZ).with_({"accuracy.tolerance": 2e-5})
    known, found = (run(one) for one in (exact, exact.with_({"bodies.profile.radius": "1000 ± 100"})))
    assert "largest_force" in known.warnings["lattice"]
    assert found.warnings == known.warnings


def test_a_load_may_be_uncertain() -> None:
    """Hertz: d ∝ F^(2/3) R^(−1/3) E*^(−2/3), dF/dd = 2E*a ∝ E*^(2/3) (FR)^(1/3)."""
    found = sphere(radius=("10 mm", "1 %"), contact_modulus=("50 GPa", "1 GPa")).load("10 N ± 0.1 N")
    for name, powers in {
        "displacement": (2 / 3, -1 / 3, -2 / 3),
        "contact_radius": (1 / 3, 1 / 3, -1 / 3),
        "contact_stiffness": (1 / 3, 1 / 3, 2 / 3),
        "peak_pressure": (1 / 3, -2 / 3, 2 / 3),
        "mean_pressure": (1 / 3, -2 / 3, 2 / 3),
    }.items():
        assert given(found, name) == pytest.approx(combined(powers, (0.01, 0.01, 0.02)), rel=NONLINEAR), name


def test_what_has_no_uncertainty_or_a_wrong_one_is_refused_in_a_sentence() -> None:
    scene = sphere(radius="1 mm", contact_modulus="1 MPa").scene("load", force="1 N")
    radius = "bodies.profile.radius"
    for key, text, said in (
        (radius, "10 mm ± 0.1", "unit or % behind ±"),
        (radius, "10 mm ± 6 mm", "less than half of its value"),
        (radius, "10 mm ± 1 N", "1 N is a force"),
        ("bodies.spacing", "1 ± 0.1 µm", "has no uncertainty"),
    ):
        with pytest.raises(SceneError, match=said) as error:
            scene.with_({key: text})
        assert len(str(error.value).splitlines()) == 1
    start = ["0 s", "0 µm"]
    for term, time, places, said in (
        ("0.8 ± 0.2", "0.5 s", [start, ["1 s", "8 µm"]], r"terms\[0\]\.share: at an end of its ±: the shares"),
        (0.5, "1 s", [start, ["1 ± 0.3 s", "8 µm"], ["1.2 s", "7 µm"]], "at an end of its ±: times must rise"),
    ):
        with pytest.raises(SceneError, match=said):
            read_scene(relaxing(term, time, displacement=places))


def test_a_scene_keeps_its_uncertainties_when_it_is_written_and_changed() -> None:
    scene = sphere(radius="10 ± 0.1 mm", contact_modulus="1 MPa ± 2 %").scene("load", force="1 N")
    assert read_scene(str(scene)).shares == scene.shares
    assert scene.with_({"bodies.profile.radius": "20 mm"}).shares == {"material.contact_modulus": 0.02}


def ends(of: Callable[..., float], *numbers: tuple[float, float]) -> float:
    """What independent numbers, value and ±, change of a result, over that; of each the larger way."""
    values = [value for value, _ in numbers]
    changes = []
    for i, (value, off) in enumerate(numbers):
        both = ([*values[:i], value + way * off, *values[i + 1 :]] for way in (-1, 1))
        changes.append(max(abs(of(*moved) / of(*values) - 1.0) for moved in both))
    return math.hypot(*changes)


def compliance(modulus: float, ratio: float) -> float:
    return (1.0 - ratio**2) / modulus


def test_bodies_of_uncertain_moduli_and_ratios() -> None:
    """a₀ ∝ E*^(−1/3) of JKR; a rigid body leaves the other one its uncertainty."""
    soft = {"youngs_modulus": "5 ± 0.5 MPa", "poisson_ratio": "0.45 ± 0.02"}
    hard = {"youngs_modulus": "9 ± 0.9 MPa", "poisson_ratio": 0.4}
    numbers = (5e6, 0.5e6), (0.45, 0.02)
    alone = ends(lambda e, nu: compliance(e, nu) ** (1 / 3), *numbers)
    both = ends(lambda e, nu, f: (compliance(e, nu) + compliance(f, 0.4)) ** (1 / 3), *numbers, (9e6, 0.9e6))
    for upper, exact in (("rigid", alone), (hard, both)):
        found = sphere(radius="1 mm", work_of_adhesion="50 mJ/m²", upper=upper, lower=soft).pull_off()
        assert share(found.results.zero_load_radius) == pytest.approx(exact, rel=NONLINEAR)


def test_units_that_follow_from_a_material_have_its_uncertainty() -> None:
    """LU ∝ γ/E* and FU ∝ γ²/E* of JKR's units, of a given length FU ∝ E*: in pressures γ is not."""
    plane = {"particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "bulk_stiffness": 0.9, "reduction": "mdr"}
    tables = {
        "title": "units", "bodies": plane | {"profile": {"kind": "parabola", "radius": 800.0}},
        "adhesion": {"work_of_adhesion": 0.01}, "experiment": {"kind": "pull_off", "preload": 1.0},
    }  # fmt: skip
    elastic = {"upper": {"youngs_modulus": "5 ± 0.5 MPa", "poisson_ratio": 0.45}, "lower": "rigid"}
    energy, modulus = (1.0, 0.05), (1.0, 0.1)
    jkr_units = (ends(lambda w, e: w**2 / e, energy, modulus), ends(lambda w, e: w / e, energy, modulus), 0.1)
    for unit, exact in (({"surface_energy": "20 ± 1 mJ/m²"}, jkr_units), ({"length_unit": 1e-6}, (0.1, 0.0, 0.1))):
        results = run(tables | {"material": elastic | unit}).results
        own = [share(results[name]) for name in ("adhesion_force", "zero_load_radius", "central_pressure")]
        assert own == pytest.approx(exact, rel=NONLINEAR, abs=1e-3)


def relaxing(term: object, time: object, **points: Any) -> dict[str, Any]:
    terms = [{"share": term, "time": time}, {"share": 0.1, "time": "20 s"}]
    return in_si(
        {"kind": "parabola", "radius": "2 mm"}, "3 MPa", title="relaxes", viscoelasticity={"terms": terms},
        experiment={"kind": "history"} | points,
    )  # fmt: skip


def lee_and_radok(term: float, time: float, depth: float, end: float = 3.0) -> float:
    """F/E*√R of a paraboloid pressed evenly to a depth in 0.5 s and held: (4/3) ∫ E(t − s) d(δ^(3/2))."""
    s = np.linspace(0.0, 1.0, 20001)
    age = end - 0.5 * 0.5 * (s[1:] + s[:-1])
    left = 1.0 - term * (1.0 - np.exp(-age / time)) - 0.1 * (1.0 - np.exp(-age / 20.0))
    return 4.0 / 3.0 * depth**1.5 * float(left @ np.diff(s**1.5))


def test_terms_and_points_of_a_list_have_uncertainties() -> None:
    points, deeper = ([["0 s", "0 µm"], ["0.5 s", d], ["3 s", "8 µm"]] for d in ("8 µm", "8 ± 0.4 µm"))
    exact = run(relaxing(0.5, "1.5 s", displacement=points)).results.force
    assert exact.value == pytest.approx(3e6 * math.sqrt(2e-3) * lee_and_radok(0.5, 1.5, 8e-6), rel=1e-3)
    terms = run(relaxing("0.5 ± 0.05", "1.5 ± 0.3 s", displacement=points))
    found = terms.results.force
    assert found.value == exact.value
    change = ends(lambda term, time: lee_and_radok(term, time, 1.0), (0.5, 0.05), (1.5, 0.3))
    assert share(found) - share(exact) == pytest.approx(change, rel=NONLINEAR)
    assert read_scene(str(terms.scene)).shares == pytest.approx(dict(terms.scene.shares))
    pressed = run(relaxing(0.5, "1.5 s", displacement=deeper)).results
    assert share(pressed.peak_force) == pytest.approx(1.05**1.5 - 1.0, rel=NONLINEAR)
    assert pressed.peak_displacement.uncertainty == pytest.approx(0.4e-6)


def test_a_pressure_goes_with_the_terms_of_a_body_that_relaxes() -> None:
    def pressures(time: str) -> list[tuple[float, float]]:
        """p(0) and ± of each state."""
        scene = relaxing(0.5, time, force=[["0 s", "0 N"], ["1 s", "20 mN"]])
        table = run(scene).tables["pressure_3d"]
        rows = zip(table["r"], table["pressure"], table["pressure_uncertainty"], strict=True)
        return [(p, uncertainty) for r, p, uncertainty in rows if r == 0.0]

    states = (pressures(f"{time} s") for time in ("0.9", "1.1", "1 ± 0.1", "1"))
    for low, high, own, known in zip(*states, strict=True):
        assert own[1] - known[1] == pytest.approx(0.5 * abs(high[0] - low[0]), rel=0.15)
