"""A fit finds the parameters that a force curve was made with; data that tell nothing are refused, with the remedy."""

import csv
import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from contact1d import Contact1dError, SceneError, fit, fit_many
from tests.command import contact1d
from tests.scenes import read_json
from validation.gallery import PROBLEMS
from validation.references.force_curves import Sphere, measured, noise

MODULUS, WORK, RADIUS = 2e6, 0.05, 5e-6
SPHERE = Sphere(MODULUS, WORK, RADIUS)
STIFFNESS = 2.0 * MODULUS * SPHERE.zero_load_radius
DEPTH = SPHERE.zero_load_radius**2 / RADIUS
TABOR = (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0)
"""Range of Maugis's contact with µ = 1 [m]."""
SPREAD = 0.01 * 1.5 * math.pi * WORK * RADIUS
"""Of the noise of a curve [N], where nothing else is said."""
ASSUMED = 0.3e-9
"""Range of attraction where none is given [m]."""
BASE = {
    "bodies": {"profile": {"kind": "parabola", "radius": f"{RADIUS} m"}},
    "material": {"contact_modulus": "1 MPa"},
    "adhesion": {"work_of_adhesion": "20 mJ/m²"},
}
E, W = PARAMETERS = ["material.contact_modulus", "adhesion.work_of_adhesion"]
Array = np.ndarray[Any, np.dtype[np.float64]]


def plan(data: Path, **changes: Any) -> dict[str, Any]:
    instrument = {"stiffness": f"{STIFFNESS} N/m"}
    return {"data": str(data), "parameters": PARAMETERS, "instrument": instrument, "base": BASE} | changes


def curve(
    kind: str = "JKR",
    stiffness: float = STIFFNESS,
    sphere: Sphere = SPHERE,
    share: float = 0.01,
    memory: float = 5.0,
    points: int = 200,
) -> Array:
    """Columns z [nm] and F [nN] of an approach and a retraction, with noise that is a share of the pull-off force."""
    z = np.linspace(-2.5, 3.0, points) * DEPTH
    draw = np.random.default_rng(1)
    both = noise(draw, 2 * z.size, memory)
    F = measured(sphere, kind, stiffness, z) + share * 1.5 * math.pi * WORK * RADIUS * both
    return np.column_stack([1e9 * np.concatenate([z, z[::-1]]), 1e9 * F])


def written(path: Path, rows: Array, names: str = "z [nm],F [nN]") -> Path:
    lines = [",".join(f"{x:.5f}" for x in row) for row in rows]
    path.write_text("\n".join([names, *lines, ""]), encoding="utf-8")
    return path


SOFT = 0.1 * STIFFNESS
NO_CONTACT = curve() * [1.0, 0.0] + np.random.default_rng(0).standard_normal((400, 2))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a fit by the command, in out/, beside its data and its file."""
    folder = tmp_path_factory.mktemp("fit")
    written(folder / "curve.csv", curve())
    (folder / "fit.toml").write_text(
        f'data = "curve.csv"\nparameters = {json.dumps(PARAMETERS)}\n[instrument]\nstiffness = "{STIFFNESS} N/m"\n'
        f'[base.bodies]\nprofile = {{ kind = "parabola", radius = "{RADIUS} m" }}\n'
        '[base.material]\ncontact_modulus = "1 MPa"\n[base.adhesion]\nwork_of_adhesion = "20 mJ/m²"\n',
        encoding="utf-8",
    )
    done = contact1d("fit", folder / "fit.toml", "--out", folder / "out")
    assert done.exit_code == 0, done.output
    return folder


@pytest.fixture(scope="module")
def found(folder: Path) -> dict[str, Any]:
    document = read_json(folder / "out" / "fit.json")
    return document


def test_the_command_leaves_the_parameters_with_intervals_that_hold_them(folder: Path, found: dict[str, Any]) -> None:
    """The noise is what was drawn, µ has the assumed range, and LAMMPS agrees."""
    assert found["status"] == "done"
    for name, exact in zip(PARAMETERS, (MODULUS, WORK), strict=True):
        low, high = found["parameters"][name]["interval"]
        assert low < exact < high
    assert found["contact_modulus"]["interval"] == pytest.approx(found["parameters"][E]["interval"])
    assert found["noise"]["value"] == pytest.approx(SPREAD, rel=0.3)
    assert found["reduced_chi_squared"] == pytest.approx(1.0, abs=0.5)
    assert found["tabor_parameter"]["value"] == pytest.approx(TABOR / ASSUMED, rel=0.2)
    assert found["tabor_parameter"]["assumed"]
    matrix = np.array(found["correlation"]["matrix"])
    assert np.diag(matrix) == pytest.approx(1.0)
    assert matrix == pytest.approx(matrix.T)
    assert np.abs(matrix).max() <= 1.0
    low, high = found["snap_out"]["bracket"]
    assert low < found["snap_out"]["position"] < high
    criteria = {name: model["criterion_above_least"] for name, model in found["models"].items()}
    assert set(criteria) == {"JKR", "DMT", "Hertz"}
    assert criteria["JKR"] == 0.0 < min(criteria["DMT"], criteria["Hertz"])
    assert found["run"]["difference"] <= found["run"]["allowed"]
    assert {"curve.csv", "scene.toml", "fit.png"} <= {path.name for path in (folder / "out").iterdir()}
    again = contact1d("fit", folder / "fit.toml", "--out", folder)
    assert again.exit_code == 2


def test_the_table_of_a_fit_is_the_measured_curve_in_si_beside_the_fitted_one(
    folder: Path, found: dict[str, Any]
) -> None:
    rows = curve()
    with (folder / "out" / "curve.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert [int(row["line"]) for row in table] == list(range(2, 2 + len(rows)))
    assert [row["segment"] for row in table] == ["approach"] * 200 + ["retract"] * 200
    position, force, predicted = (
        np.array([float(row[name]) for row in table]) for name in ("position [m]", "force [N]", "predicted force [N]")
    )
    assert np.column_stack([position, force]) == pytest.approx(1e-9 * rows, rel=1e-6, abs=1e-14)
    used = np.array([row["compared"] == "yes" for row in table])
    assert found["points"] == {"in_file": len(rows), "compared": used.sum()}
    assert float(np.std((force - predicted)[used])) == pytest.approx(SPREAD, rel=0.4)
    # Mean variance of a prediction by four unknowns under white noise; one with a memory averages out less.
    least = 1.96 * found["noise"]["value"] * math.sqrt(4.0 / used.sum())
    assert least <= found["run"]["allowed"] < 10.0 * least


def test_what_is_known_is_left_when_a_fit_is_broken_off(found: dict[str, Any], tmp_path: Path) -> None:
    """Of another form, indentation d = z − F/k with opposite signs; a known contact point narrows the modulus."""
    rows = curve()
    d = np.column_stack([rows[:, 0] - rows[:, 1] / STIFFNESS, rows[:, 1]]) + np.array([500.0, 0.0])
    form = written(tmp_path / "d.csv", -d, "d [nm];F [nN]")
    form.write_text(form.read_text(encoding="utf-8").replace(",", ";").replace(".", ","), encoding="utf-8")

    def phase(name: str, *_: object) -> None:
        if name.startswith("run"):
            raise KeyboardInterrupt

    asked = plan(form, reverse=["d", "F"], contact_point="500 nm")
    with pytest.raises(KeyboardInterrupt):
        fit(asked, folder=tmp_path / "out", progress=Mock(phase=phase))
    left = read_json(tmp_path / "out" / "fit.json")
    assert (left["status"], left["run"]) == ("interrupted", None)
    low, high = left["parameters"][E]["interval"]
    free = found["parameters"][E]["interval"]
    assert low < MODULUS < high < low + free[1] - free[0]


def test_what_is_known_of_a_parameter_counts_as_a_measurement(found: dict[str, Any], tmp_path: Path) -> None:
    """Known as well as measured, and two half-widths of the interval off: the mean of both."""
    entry = found["parameters"][E]
    half_width = 0.5 * (entry["interval"][1] - entry["interval"][0])
    known = f"{entry['value'] + 2.0 * half_width} ± {half_width} Pa"
    base = BASE | {"material": {"contact_modulus": known}}
    result = fit(plan(written(tmp_path / "curve.csv", curve()), base=base))
    assert "counts as a measurement" in result.warnings["prior"]
    assert result.fit.values[E] == pytest.approx(entry["value"] + half_width, abs=0.2 * half_width)


def test_a_jump_that_is_small_beside_the_force_in_contact(tmp_path: Path) -> None:
    rows = curve(sphere=Sphere(MODULUS, 0.1 * WORK, RADIUS))
    result = fit(plan(written(tmp_path / "curve.csv", rows)))
    low, high = result.bracket
    assert low < result.fit.subject.jumps_at(result.fit.solution.values)[1] < high


def test_adhesion_that_may_be_none(tmp_path: Path) -> None:
    """Hertz's contact, with noise that looks like a little adhesion."""
    d = np.linspace(0.0, 400e-9, 20_000)
    F = 4.0 / 3.0 * 26.66e6 * math.sqrt(10e-6) * d**1.5
    z = np.linspace(-300e-9, 400e-9, 700)
    both = np.concatenate([z, z[::-1]])
    noisy = np.interp(both, d + F / 40.0, F) + np.random.default_rng(40).normal(0.0, 15e-9, both.size)
    rows = np.round(1e9 * np.column_stack([both, noisy]), 2)
    base = BASE | {"bodies": {"profile": {"kind": "parabola", "radius": "10 ± 0.2 µm"}}}
    known = {"instrument": {"stiffness": "40 ± 2 N/m"}, "base": base}
    result = fit(plan(written(tmp_path / "curve.csv", rows), **known))
    assert "W may be 0" in result.warnings["adhesion"]


@pytest.mark.parametrize(("work", "edge", "share", "width"), [("0.5e-3", 40.0, 3e-6, 1.1), ("0.25e-3", 2.0, 0.01, 1.5)])
def test_a_blunt_cone_covers(work: str, edge: float, share: float, width: float, tmp_path: Path) -> None:
    """A contact on both sides of the kink, by the closed form of the gallery.

    With the noise of the second one a larger W, with a lower E, is another minimum, of more squares.
    """
    tip = next(one for one in PROBLEMS if one.name == "Cone with a parabolic cap: pull-off force")
    exact = replace(tip, closed=tip.closed.replace("0.5e-3", work)).exact
    states = [exact[name](np.linspace(1e-9, 2e-5, 40_000)) for name in "dF"]
    z = np.linspace(-1.0, 1.0, 200) * exact["d"](edge * exact["b"])
    F = measured(Mock(range=0.0, branch=lambda _: states), "JKR", math.inf, z)
    F += share * F.max() * np.random.default_rng(13).standard_normal(F.size)
    data = written(tmp_path / "curve.csv", 1e9 * np.column_stack([np.append(z, z[::-1]), F]), "d [nm],F [nN]")
    base = BASE | {"bodies": tomllib.loads(tip.scene)["bodies"]}
    found = fit({"data": str(data), "parameters": PARAMETERS, "base": base}).fit
    for name, symbol in zip(PARAMETERS, "EW", strict=True):
        low, high = found.intervals[name]
        assert low < exact[symbol] < high < width * low


def test_a_range_makes_it_the_contact_of_maugis(tmp_path: Path) -> None:
    """µ = 1: the range is in its interval, LAMMPS agrees, and no other contact model has a parameter."""
    rows = curve("Maugis", sphere=Sphere(MODULUS, WORK, RADIUS, TABOR))
    base = BASE | {
        "material": {"contact_modulus": f"{MODULUS} Pa"},
        "adhesion": {"work_of_adhesion": f"{WORK} J/m²", "range": f"{2.0 * TABOR} m"},
    }
    result = fit(plan(written(tmp_path / "curve.csv", rows), base=base, parameters=["adhesion.range"]))
    low, high = result.fit.intervals["adhesion.range"]
    assert low < TABOR < high < 2.0 * low
    assert set(result.models) == {"Maugis"}
    assert result.difference <= result.allowed
    assert np.all(result.fit.spread() <= result.allowed)


def test_a_cone_has_no_radius_for_dmt(tmp_path: Path) -> None:
    """F = (2/π) E* d² / slope, in nanometres and nanonewtons, without an instrument."""
    slope, d = 0.3, np.linspace(-0.5, 1.5, 200) * 1e-6
    F = MODULUS * np.maximum(d, 0.0) ** 2 / slope * 2.0 / math.pi
    drawn = 1e-3 * float(F.max()) * np.random.default_rng(3).standard_normal(400)
    rows = 1e9 * np.column_stack([np.append(d, d[::-1]), np.append(F, F[::-1]) + drawn])
    base = {"bodies": {"profile": {"kind": "cone", "slope": slope}}, "material": BASE["material"]}
    base |= {"adhesion": {"work_of_adhesion": "1 nJ/m²"}}
    path = written(tmp_path / "curve.csv", rows, "d [nm],F [nN]")
    result = fit({"data": str(path), "parameters": [E], "base": base})
    assert set(result.models) == {"JKR", "Hertz"}
    low, high = result.fit.intervals[E]
    assert low < MODULUS < high < 1.02 * low


def test_a_map_has_a_line_for_each_curve(tmp_path: Path) -> None:
    """One without contact, one of an approach alone, and one whose jumps are hardly seen beside the noise."""
    parts = [NO_CONTACT[:100], curve()[:200], curve(share=0.3, memory=0.0)]
    rows = [np.column_stack([np.full((len(part), 3), [i, 10.0 * i, 5.0]), part]) for i, part in enumerate(parts)]
    path = written(tmp_path / "map.csv", np.vstack(rows), "curve,x [µm],y [µm],z [nm],F [nN]")
    done = fit_many(plan(path), tmp_path / "fits", workers=1)
    assert done.counts == {"done": 2, "refused": 1}
    with (done.folder / "fits.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert [row["status"] for row in table] == ["refused", "done", "done"]
    assert [(float(row["x"]), float(row["y"])) for row in table] == [(0.0, 5.0), (10.0, 5.0), (20.0, 5.0)]
    assert "no contact" in table[0]["reason"]
    assert float(table[1][f"{E}_low [Pa]"]) < MODULUS < float(table[1][f"{E}_high [Pa]"])
    low, high = (float(table[2][f"{W}_{end} [J/m²]"]) for end in ("low", "high"))
    assert low < WORK < high < 2.0 * low
    assert (done.folder / "material.contact_modulus.png").is_file()


@pytest.mark.parametrize(
    ("data", "changes", "words", "code"),
    [
        (curve(stiffness=SOFT, points=100), {"instrument": {"stiffness": f"{SOFT} N/m"}}, "softer", 3),
        (curve(points=100), {"parameters": [*PARAMETERS, "bodies.profile.radius"]}, "trade off", 3),
        (curve("Hertz", points=100), {}, "no adhesion", 3),
        (NO_CONTACT, {}, "no contact", 2),
        (curve(), {"instrument": None}, "z is the position of the piezo", 2),
    ],
)
def test_what_a_curve_does_not_tell_is_refused(
    data: Array, changes: dict[str, Any], words: str, code: int, tmp_path: Path
) -> None:
    with pytest.raises(Contact1dError) as error:
        fit(plan(written(tmp_path / "curve.csv", data), **changes))
    assert words in str(error.value)
    assert error.value.exit_code == code


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("z,F\n" + "1,2\n" * 60, "without a unit"),
        ("z [nm],F [nN]\n" + "-250,0,19,1383\n" * 60, "line 2: has 4 numbers under 2 names"),
        ("z [nm],F [mV]\n" + "1,2\n" * 60, "column F is in volts"),
        ("z [nm],F [nN]\n" + "1,2\n" * 5 + "1,\n" + "1,2\n" * 9 + "1,x\n", "line 7: F is empty or no number; leave"),
    ],
)
def test_a_file_that_is_none(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "curve.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(Contact1dError) as error:
        fit(plan(path))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_mistakes_of_a_fit_file_are_named_together() -> None:
    wrong = plan(Path("curve.csv"), parameters=["adhesion.work"], instrument={"stiffnes": "1 N/m"})
    with pytest.raises(SceneError) as error:
        fit(wrong)
    assert {problem.path for problem in error.value.problems} >= {"instrument.stiffnes"}
    neighbours = {name: table for name, table in BASE.items() if name != "adhesion"}
    neighbours |= {"neighbours": {"stiffness": "1 N/m"}, "bodies": BASE["bodies"] | {"spacing": "50 nm"}}
    for changes, words in (
        ({"parameters": ["adhesion.work"]}, "is no number of the base scene"),
        ({"base": None}, "base"),
        ({"parameters": [E], "base": neighbours}, "contact models are of linear springs"),
    ):
        with pytest.raises(SceneError, match=words):
            fit({name: value for name, value in plan(Path("curve.csv"), **changes).items() if value is not None})
