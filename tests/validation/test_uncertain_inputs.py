"""Numbers with ±: what they change of each result is that of the closed forms, and draws from them are inside."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import contact1d
from contact1d import SceneError

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
RADIUS, MODULUS, WORK = 2e-3, 2e6 / 0.75, 80e-3
SHARES = {"radius": 0.01, "modulus": 0.03, "work": 0.02}
EXPONENTS = {
    "adhesion_force": {"radius": 1, "work": 1},
    "zero_load_radius": {"radius": 2 / 3, "work": 1 / 3, "modulus": -1 / 3},
    "adhesion_energy": {"radius": 4 / 3, "work": 5 / 3, "modulus": -2 / 3},
    "central_pressure": {"radius": -1 / 3, "work": 1 / 3, "modulus": 2 / 3},
}
"""JKR: F_A = 1.5πWR, a₀³ = 9πWR²/2E*, E = πa₀²W, p(0) ∝ E*a₀/R at F = 0."""
NONLINEAR = 0.03
"""Of a change, what the larger one of both ways is beyond the linear one: exponents of 2/3 at 3 %."""
DRAWS, INSIDE = 200, (180, 198)


def jkr(radius: object, modulus: object, work: object) -> contact1d.Run:
    return contact1d.sphere(radius=radius, contact_modulus=modulus, work_of_adhesion=work).pull_off()


@pytest.fixture(scope="module")
def run() -> contact1d.Run:
    return jkr("2 ± 0.02 mm", "2.6666666666666667 MPa ± 3 %", "80 mJ/m² ± 1.6 mJ/m²")


@pytest.fixture(scope="module")
def known() -> contact1d.Run:
    return jkr("2 mm", "2.6666666666666667 MPa", "80 mJ/m²")


def test_each_result_has_the_exponents_of_jkr(run: contact1d.Run) -> None:
    for name, exponents in EXPONENTS.items():
        expected = math.hypot(*(power * SHARES[key] for key, power in exponents.items()))
        given = run.document[name]["errors"]["input"] / run.document[name]["value"]
        assert given == pytest.approx(expected, rel=NONLINEAR)
    force = run.document["adhesion_force"]
    assert force["errors"]["input"] / force["value"] == pytest.approx(math.hypot(0.01, 0.02), rel=0.02)


def test_a_result_adds_what_inputs_change_to_its_own_uncertainty(run: contact1d.Run, known: contact1d.Run) -> None:
    for name in EXPONENTS:
        own, exact = run.document[name], known.document[name]
        assert own["value"] == exact["value"]
        assert own["uncertainty"] - own["errors"]["input"] == pytest.approx(exact["uncertainty"], rel=1e-6)
    assert "errors" not in known.document["adhesion_force"]
    assert "inputs" not in known.document
    assert run.warnings == known.warnings


def test_the_deck_is_that_of_the_numbers_alone(run: contact1d.Run, known: contact1d.Run) -> None:
    for name in ("in.lammps", "system.data", "adhesion.cells"):
        assert (run.folder / name).read_text() == (known.folder / name).read_text()


def test_draws_from_the_inputs_are_inside_at_95_percent(run: contact1d.Run) -> None:
    draw = np.random.default_rng(20261125).normal
    sigma = {key: share / 1.959964 for key, share in SHARES.items()}
    radius, work, modulus = (
        value * (1.0 + sigma[key] * draw(size=DRAWS))
        for key, value in (("radius", RADIUS), ("work", WORK), ("modulus", MODULUS))
    )
    truth = {
        "adhesion_force": 1.5 * math.pi * work * radius,
        "zero_load_radius": np.cbrt(4.5 * math.pi * work * radius**2 / modulus),
    }
    for name, values in truth.items():
        one = run.results[name]
        inside = int(np.sum(np.abs(values - one.value) <= one.uncertainty))
        assert INSIDE[0] <= inside <= INSIDE[1], (name, inside)


def test_a_table_says_which_input_matters(run: contact1d.Run) -> None:
    table = run.tables["inputs"]
    rows = dict(
        zip(table["input"].tolist(), zip(table["half_width"], table["adhesion_force"], strict=True), strict=True)
    )
    assert rows["bodies.profile.radius"] == pytest.approx((0.01, 0.01), rel=0.02)
    assert rows["adhesion.work_of_adhesion"] == pytest.approx((0.02, 0.02), rel=0.02)
    assert rows["material.contact_modulus"] == pytest.approx((0.03, 0.0), rel=0.02, abs=1e-5)
    assert table.units == {}
    again = contact1d.load_run(run.folder)
    assert again.scene.shares == run.scene.shares
    assert again.tables["inputs"]["adhesion_force"] == pytest.approx(table["adhesion_force"], rel=1e-9, abs=1e-12)
    assert contact1d.read_scene(run.folder / "scene.toml").shares == run.scene.shares
    run.plot("inputs")


def test_a_number_with_an_uncertainty_hides_no_error_of_the_run() -> None:
    """Of a force in the curve, and of the largest one: the tolerance is asked of what the program adds."""
    scene = contact1d.read_scene(SCENES / "hertz_plane.toml")
    for tolerance, named in ((1e-4, "force in curve.csv"), (2e-5, "largest_force")):
        exact = scene.with_({"accuracy.tolerance": tolerance})
        known, run = (contact1d.run(one) for one in (exact, exact.with_({"bodies.profile.radius": "1000.0 ± 100.0"})))
        assert named in known.warnings["lattice"]
        assert run.warnings == known.warnings


def test_a_load_may_be_uncertain() -> None:
    """Hertz: d ∝ F^(2/3) R^(−1/3) E*^(−2/3), dF/dd = 2E*a ∝ E*^(2/3) (FR)^(1/3)."""
    ball = contact1d.sphere(radius=("10 mm", "1 %"), contact_modulus=("50 GPa", "1 GPa"))
    run = ball.load("10 N ± 0.1 N")
    for name, powers in {
        "displacement": (2 / 3, -1 / 3, -2 / 3),
        "contact_radius": (1 / 3, 1 / 3, -1 / 3),
        "contact_stiffness": (1 / 3, 1 / 3, 2 / 3),
        "peak_pressure": (1 / 3, -2 / 3, 2 / 3),
        "mean_pressure": (1 / 3, -2 / 3, 2 / 3),
    }.items():
        expected = math.hypot(*(power * share for power, share in zip(powers, (0.01, 0.01, 0.02), strict=True)))
        given = run.document[name]["errors"]["input"] / run.document[name]["value"]
        assert given == pytest.approx(expected, rel=NONLINEAR), name


def test_a_punch_of_uncertain_radius() -> None:
    run = contact1d.punch(radius="1 ± 0.01 mm", contact_modulus="1 MPa").load("1 N")
    one = run.document["displacement"]
    assert one["errors"]["input"] / one["value"] == pytest.approx(0.01, rel=NONLINEAR)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("10 mm ± 0.1", "unit or % behind ±"),
        ("10 mm ± 6 mm", "less than half of its value"),
        ("10 mm ± 1 N", "1 N is a force"),
        ("10 ± 0 mm", "greater than 0"),
        ("10 mm ± x", "must have a number behind ±"),
        ("± 1 mm", "must be a length"),
    ],
)
def test_what_is_no_uncertainty_is_refused_in_a_sentence(text: str, said: str) -> None:
    with pytest.raises(SceneError, match=said) as error:
        contact1d.sphere(radius=text, contact_modulus="1 MPa")
    assert len(str(error.value).splitlines()) == 1


def test_numbers_that_are_no_property_of_the_contact_have_none() -> None:
    scene = contact1d.sphere(radius="1 mm", contact_modulus="1 MPa").scene("load", force="1 N")
    for key, text in {"bodies.spacing": "1 ± 0.1 µm", "accuracy.tolerance": "1e-3 ± 1e-4"}.items():
        with pytest.raises(SceneError, match="has no uncertainty"):
            scene.with_({key: text})


def test_a_scene_keeps_its_uncertainties_when_it_is_written_and_changed() -> None:
    scene = contact1d.sphere(radius="10 ± 0.1 mm", contact_modulus="1 MPa ± 2 %").scene("load", force="1 N")
    assert contact1d.read_scene(str(scene)).shares == scene.shares
    assert scene.with_({"bodies.profile.radius": "20 mm"}).shares == {"material.contact_modulus": 0.02}
    assert scene.with_({"experiment.force": "2 N"}).shares == scene.shares


SOFT, HARD = (
    {"youngs_modulus": "5 ± 0.5 MPa", "poisson_ratio": "0.45 ± 0.02"},
    {"youngs_modulus": "9 ± 0.9 MPa", "poisson_ratio": 0.4},
)
"""± 10 % of E, and 0.02 of ν."""


def compliance(modulus: float, ratio: float) -> float:
    return (1.0 - ratio**2) / modulus


def ends(of: Callable[..., float], *numbers: tuple[float, float]) -> float:
    """What independent numbers, value and ±, change of a result, over that; of each the larger way."""
    own = of(*(value for value, _ in numbers))
    changes = []
    for i, (value, off) in enumerate(numbers):
        both = (
            [one for one, _ in numbers[:i]] + [value + way * off] + [one for one, _ in numbers[i + 1 :]]
            for way in (-1, 1)
        )
        changes.append(max(abs(of(*moved) / own - 1.0) for moved in both))
    return math.hypot(*changes)


def test_a_rigid_body_leaves_the_other_one_its_uncertainty() -> None:
    """a₀ ∝ E*^(−1/3) of JKR."""
    given = {"radius": "1 mm", "work_of_adhesion": "50 mJ/m²"}
    soft = (5e6, 0.5e6), (0.45, 0.02)
    alone = ends(lambda e, nu: compliance(e, nu) ** (1 / 3), *soft)
    both = ends(lambda e, nu, f: (compliance(e, nu) + compliance(f, 0.4)) ** (1 / 3), *soft, (9e6, 0.9e6))
    for bodies, share in (
        ({"upper": SOFT, "lower": "rigid"}, alone),
        ({"upper": "rigid", "lower": SOFT}, alone),
        ({"upper": SOFT, "lower": HARD}, both),
    ):
        found = contact1d.sphere(**given, **bodies).pull_off()
        radius = found.results.zero_load_radius
        modulus = 1.0 / (compliance(5e6, 0.45) + (compliance(9e6, 0.4) if HARD in bodies.values() else 0.0))
        assert radius.value == pytest.approx((9.0 * math.pi * 0.05 * 1e-6 / (2.0 * modulus)) ** (1 / 3), rel=1e-3)
        assert radius.uncertainty / radius.value == pytest.approx(share, rel=NONLINEAR)


def test_units_that_follow_from_a_material_have_its_uncertainty() -> None:
    """LU ∝ γ/E* and FU ∝ γ²/E* of JKR's units, of a given length FU ∝ E*: in pressures γ is not."""
    bodies = {
        "particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "bulk_stiffness": 0.9, "reduction": "mdr",
        "profile": {"kind": "parabola", "radius": 800.0},
    }  # fmt: skip
    tables = {
        "title": "units",
        "bodies": bodies,
        "adhesion": {"work_of_adhesion": 0.01},
        "experiment": {"kind": "pull_off", "preload": 1.0},
    }
    elastic = {"upper": {"youngs_modulus": "5 ± 0.5 MPa", "poisson_ratio": 0.45}, "lower": "rigid"}
    energy, modulus = (1.0, 0.05), (1.0, 0.1)
    jkr_units = {
        "adhesion_force": ends(lambda w, e: w**2 / e, energy, modulus),
        "zero_load_radius": ends(lambda w, e: w / e, energy, modulus),
        "central_pressure": 0.1,
    }
    of_length = {"adhesion_force": 0.1, "zero_load_radius": 0.0, "central_pressure": 0.1}
    for unit, shares in (({"surface_energy": "20 ± 1 mJ/m²"}, jkr_units), ({"length_unit": 1e-6}, of_length)):
        results = contact1d.run(tables | {"material": elastic | unit}).results
        found = {name: results[name].uncertainty / results[name].value for name in shares}
        assert found == pytest.approx(shares, rel=NONLINEAR, abs=1e-3)


def relaxing(share: object, time: str, points: list[list[str]]) -> dict[str, Any]:
    bodies = {
        "particles": "auto",
        "spacing": "auto",
        "lower": "rigid_plane",
        "profile": {"kind": "parabola", "radius": "2 mm"},
    }
    return {
        "title": "relaxes", "bodies": bodies, "material": {"contact_modulus": "3 MPa"},
        "viscoelasticity": {"terms": [{"share": share, "time": time}, {"share": 0.1, "time": "20 s"}]},
        "experiment": {"kind": "history", "displacement": points},
    }  # fmt: skip


def lee_and_radok(share: float, time: float, depth: float, end: float = 3.0) -> float:
    """F/E*√R of a paraboloid pressed evenly to a depth in 0.5 s and held: (4/3) ∫ E(t − s) d(δ^(3/2))."""
    s = np.linspace(0.0, 1.0, 20001)
    age = end - 0.5 * 0.5 * (s[1:] + s[:-1])
    left = 1.0 - share * (1.0 - np.exp(-age / time)) - 0.1 * (1.0 - np.exp(-age / 20.0))
    return 4.0 / 3.0 * depth**1.5 * float(left @ np.diff(s**1.5))


def test_terms_and_points_of_a_list_have_uncertainties() -> None:
    points = [["0 s", "0 µm"], ["0.5 s", "8 ± 0.4 µm"], ["3 s", "8 µm"]]
    known = [[t, d.replace(" ± 0.4", "")] for t, d in points]
    exact = contact1d.run(relaxing(0.5, "1.5 s", known))
    terms = contact1d.run(relaxing("0.5 ± 0.05", "1.5 ± 0.3 s", known))
    share = ends(lambda share, time: lee_and_radok(share, time, 1.0), (0.5, 0.05), (1.5, 0.3))
    assert exact.results.force.value == pytest.approx(3e6 * math.sqrt(2e-3) * lee_and_radok(0.5, 1.5, 8e-6), rel=1e-3)
    assert terms.results.force.value == exact.results.force.value
    own = exact.results.force.uncertainty / exact.results.force.value
    assert terms.results.force.uncertainty / terms.results.force.value - own == pytest.approx(share, rel=NONLINEAR)
    assert [one["input"] for one in terms.document["inputs"]] == [
        "viscoelasticity.terms[0].share",
        "viscoelasticity.terms[0].time",
    ]
    assert contact1d.read_scene(str(terms.scene)).shares == pytest.approx(dict(terms.scene.shares))
    deeper = contact1d.run(relaxing(0.5, "1.5 s", points)).results
    peak = deeper.peak_force.uncertainty / deeper.peak_force.value
    assert peak == pytest.approx(1.05**1.5 - 1.0, rel=NONLINEAR)
    assert deeper.peak_displacement.uncertainty == pytest.approx(0.4e-6)


@pytest.mark.parametrize("given", ["displacement", "force"])
@pytest.mark.parametrize(("key", "value", "share"), [("share", 0.5, 0.05), ("time", 1.0, 0.1)])
def test_a_pressure_goes_with_the_terms_of_a_body_that_relaxes(
    given: str, key: str, value: float, share: float
) -> None:
    points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.8]] if given == "displacement" else [[0.0, 0.0], [1.0, 20.0]]

    def run(number: object) -> list[tuple[float, float]]:
        """p(0) and ± of each state."""
        terms = [{"share": 0.5, "time": 1.0} | {key: number}]
        bodies = {
            "particles": "auto",
            "spacing": 1.0,
            "reduction": "mdr",
            "lower": "rigid_plane",
            "bulk_stiffness": 1.0,
        }
        tables = {"bodies": bodies | {"profile": {"kind": "parabola", "radius": 1000.0}}}
        experiment = {"kind": "history", given: points}
        scene = {"title": "a term", **tables, "viscoelasticity": {"terms": terms}, "experiment": experiment}
        table = contact1d.run(scene).tables["pressure_3d"]
        rows = zip(table["r"], table["pressure"], table["pressure_uncertainty"], strict=True)
        return [(p, uncertainty) for r, p, uncertainty in rows if r == 0.0]

    ends = [run(value * (1.0 + way * share)) for way in (-1.0, 1.0)]
    for low, high, own, known in zip(*ends, run([value, value * share]), run(value), strict=True):
        assert own[1] - known[1] == pytest.approx(0.5 * abs(high[0] - low[0]), rel=0.15)


@pytest.mark.parametrize(
    ("share", "time", "said"),
    [
        ("0.8 ± 0.2", "0.5 s", "viscoelasticity.terms[0].share: at an end of its ±: the shares"),
        (0.5, "0.5 ± 0.3 s", 'viscoelasticity.terms[0].time = "0.5 ± 0.3 s": must have an uncertainty'),
    ],
)
def test_a_number_of_a_list_that_is_none_at_an_end_of_its_uncertainty_is_refused(
    share: object, time: str, said: str
) -> None:
    with pytest.raises(SceneError) as caught:
        contact1d.read_scene(relaxing(share, time, [["0 s", "0 µm"], ["1 s", "8 µm"]]))
    assert str(caught.value).startswith(said)
    with pytest.raises(SceneError, match="at an end of its ±: times must rise"):
        contact1d.read_scene(relaxing(0.5, "1 s", [["0 s", "0 µm"], ["1 ± 0.3 s", "8 µm"], ["1.2 s", "7 µm"]]))
