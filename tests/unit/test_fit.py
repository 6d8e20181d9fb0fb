"""A fit refuses files and plans that are none, with the remedy, and curves that do not tell what was asked for."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from contact1d import Contact1dError, SceneError, fit, fit_many
from contact1d.__main__ import app
from contact1d.workflow.body.cases import ASSUMED_RANGE
from validation.references.force_curves import Sphere, measured, noise

MODULUS, WORK, RADIUS = 2e6, 0.05, 5e-6
SPHERE = Sphere(MODULUS, WORK, RADIUS)
STIFFNESS = 2.0 * MODULUS * SPHERE.zero_load_radius
DEPTH = SPHERE.zero_load_radius**2 / RADIUS
BASE = {
    "bodies": {"profile": {"kind": "parabola", "radius": f"{RADIUS} m"}},
    "material": {"contact_modulus": "1 MPa"},
    "adhesion": {"work_of_adhesion": "20 mJ/m²"},
}
PARAMETERS = ["material.contact_modulus", "adhesion.work_of_adhesion"]


def plan(data: Path, **changes: Any) -> dict[str, Any]:
    instrument = {"stiffness": f"{STIFFNESS} N/m"}
    return {"data": str(data), "parameters": PARAMETERS, "instrument": instrument, "base": BASE} | changes


def curve(
    kind: str = "JKR", stiffness: float = STIFFNESS, sphere: Sphere = SPHERE, share: float = 0.01, memory: float = 5.0
) -> np.ndarray[Any, Any]:
    """Columns z [nm] and F [nN], with noise that is a share of the pull-off force."""
    z = np.linspace(-2.5, 3.0, 200) * DEPTH
    draw = np.random.default_rng(1)
    both = noise(draw, 2 * z.size, memory)
    F = measured(sphere, kind, stiffness, z) + share * 1.5 * math.pi * WORK * RADIUS * both
    return np.column_stack([1e9 * np.concatenate([z, z[::-1]]), 1e9 * F])


def written(path: Path, rows: np.ndarray[Any, Any], names: str = "z [nm],F [nN]") -> Path:
    path.write_text(
        names + "\n" + "\n".join(",".join(f"{x:.5f}" for x in row) for row in rows) + "\n", encoding="utf-8"
    )
    return path


@pytest.fixture(scope="module")
def good() -> np.ndarray[Any, Any]:
    return curve()


def reversed_z(rows: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return rows * [-1.0, 1.0]


def with_gap(rows: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return np.delete(rows, slice(130, 170), axis=0)


def saturated(rows: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return np.column_stack([rows[:, 0], np.minimum(rows[:, 1], 0.7 * rows[:, 1].max())])


@pytest.mark.parametrize("share", [0.05, 0.3])
def test_a_noisy_curve_whose_jumps_are_hardly_seen(tmp_path: Path, share: float) -> None:
    found = fit(plan(written(tmp_path / "curve.csv", curve(share=share, memory=0.0))))
    low, high = found.fit.intervals["adhesion.work_of_adhesion"]
    assert low < WORK < high < 2.0 * low
    assert next(iter(found.models)) == "JKR"


def test_a_jump_that_is_small_beside_the_force_in_contact(tmp_path: Path) -> None:
    rows = curve(sphere=Sphere(MODULUS, 0.1 * WORK, RADIUS))
    found = fit(plan(written(tmp_path / "curve.csv", rows)))
    low, high = found.bracket
    assert low < found.fit.jumps_at(found.fit.solution.values)[1] < high


def test_adhesion_that_may_be_none(tmp_path: Path) -> None:
    """Hertz's contact, with noise that looks like a little adhesion."""
    d = np.linspace(0.0, 400e-9, 20_000)
    F = 4.0 / 3.0 * 26.66e6 * math.sqrt(10e-6) * d**1.5
    z = np.linspace(-300e-9, 400e-9, 700)
    both = np.concatenate([z, z[::-1]])
    noisy = np.interp(both, d + F / 40.0, F) + np.random.default_rng(52).normal(0.0, 15e-9, both.size)
    rows = np.round(1e9 * np.column_stack([both, noisy]), 2)
    base = BASE | {"bodies": {"profile": {"kind": "parabola", "radius": "10 ± 0.2 µm"}}}
    known = {"instrument": {"stiffness": "40 ± 2 N/m"}, "base": base}
    found = fit(plan(written(tmp_path / "curve.csv", rows), **known))
    assert "W may be 0" in found.warnings["adhesion"]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (reversed_z, 'reverse = ["z"]'),
        (lambda rows: rows * [1.0, -1.0], 'reverse = ["F"]'),
        (lambda rows: rows[:200], "one segment only"),
        (with_gap, "gap in z"),
        (saturated, "saturated"),
        (lambda rows: rows[:20], "at least 40"),
        (lambda rows: rows * [1.0, 0.0] + np.random.default_rng(0).standard_normal(rows.shape), "no contact"),
    ],
)
def test_a_curve_that_is_none(good: np.ndarray[Any, Any], tmp_path: Path, changed: Any, words: str) -> None:
    with pytest.raises(Contact1dError) as error:
        fit(plan(written(tmp_path / "curve.csv", changed(good))))
    assert words in str(error.value)
    assert error.value.exit_code == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("a,b\n1,2\n", "name the columns"),
        ("z,F\n" + "1,2\n" * 60, "z and F without a unit"),
        ("z [nm],F [nN]\n", "not as many cells"),
        ("z [nm],F [nN]\n" + "-250,0,19,1383\n" * 60, "line 2: has 4 numbers under 2 names"),
        ("z [nm],F [V]\n" + "1,2\n" * 60, "volts"),
        ("z [nm],F [kg]\n" + "1,2\n" * 60, "must be a force"),
        ("z [nm],F [nN]\n" + "1,2\n" * 30 + "1,\n" + "1,2\n" * 30, "line 32: F is empty"),
    ],
)
def test_a_file_that_is_none(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "curve.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(Contact1dError) as error:
        fit(plan(path))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "curve.csv"
    with path.open("wb") as file:
        file.truncate(10**9)  # no line in it is one of a curve
    with pytest.raises(Contact1dError, match="average neighbouring points"):
        fit(plan(path))


def test_mistakes_of_a_fit_file_are_named_together(tmp_path: Path) -> None:
    wrong = plan(tmp_path / "curve.csv", parameters=["adhesion.work"], instrument={"stiffnes": "1 N/m"})
    with pytest.raises(SceneError) as error:
        fit(wrong)
    assert {one.path for one in error.value.problems} >= {"instrument.stiffnes"}
    with pytest.raises(SceneError, match="is no number of the base scene"):
        fit(plan(tmp_path / "curve.csv", parameters=["adhesion.work"]))
    with pytest.raises(SceneError, match="base"):
        fit({"data": "curve.csv", "parameters": PARAMETERS})
    neighbours = {name: table for name, table in BASE.items() if name != "adhesion"}
    neighbours |= {"neighbours": {"stiffness": "1 N/m"}, "bodies": BASE["bodies"] | {"spacing": "50 nm"}}
    with pytest.raises(SceneError, match="contact models are of linear springs"):
        fit(plan(tmp_path / "curve.csv", parameters=["material.contact_modulus"], base=neighbours))


@pytest.mark.parametrize(
    ("data", "changes", "words"),
    [
        (lambda: curve(stiffness=0.1 * STIFFNESS), {"instrument": {"stiffness": f"{0.1 * STIFFNESS} N/m"}}, "softer"),
        (curve, {"parameters": [*PARAMETERS, "bodies.profile.radius"]}, "trade off"),
        (lambda: curve("Hertz"), {}, "no adhesion"),
    ],
)
def test_what_a_curve_does_not_tell_is_refused(tmp_path: Path, data: Any, changes: dict[str, Any], words: str) -> None:
    with pytest.raises(Contact1dError) as error:
        fit(plan(written(tmp_path / "curve.csv", data()), **changes))
    assert words in str(error.value)
    assert error.value.exit_code == 3


def test_other_forms_of_one_curve_are_the_same(good: np.ndarray[Any, Any], tmp_path: Path) -> None:
    """Units, decimal comma, segments, reversed signs, indentation: each gives the same modulus."""
    expected = fit(plan(written(tmp_path / "plain.csv", good))).fit.values[PARAMETERS[0]]
    micro = written(tmp_path / "micro.csv", -1e-3 * good, "z [µm];F [µN]")
    micro.write_text(micro.read_text(encoding="utf-8").replace(",", ";").replace(".", ","), encoding="utf-8")
    d = np.column_stack([good[:, 0] - good[:, 1] / STIFFNESS, good[:, 1]])
    indentation = written(tmp_path / "d.csv", d, "d [nm],F [nN]")
    for path, changes in ((micro, {"reverse": ["z", "F"]}), (indentation, {})):
        found = fit(plan(path, **changes)).fit.values[PARAMETERS[0]]
        assert found == pytest.approx(expected, rel=2e-3)


def test_a_range_makes_it_the_contact_of_maugis(tmp_path: Path) -> None:
    """µ = 1: the intervals hold, LAMMPS agrees, and neither limit is as likely."""
    reach = (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0)
    rows = curve("Maugis", sphere=Sphere(MODULUS, WORK, RADIUS, reach))
    base = BASE | {"adhesion": {"work_of_adhesion": "20 mJ/m²", "range": f"{reach} m"}}
    found = fit(plan(written(tmp_path / "curve.csv", rows), base=base))
    for name, exact in zip(PARAMETERS, (MODULUS, WORK), strict=True):
        low, high = found.fit.intervals[name]
        assert low < exact < high < 1.1 * low
    assert next(iter(found.models)) == "Maugis"
    assert found.difference <= found.allowed
    assert np.all(found.fit.spread() <= found.allowed)


def test_a_range_alone_may_be_asked_for(tmp_path: Path) -> None:
    """Neither of Maugis's limits, nor Hertz, has a parameter then: none of them is compared."""
    reach = (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0)
    rows = curve("Maugis", sphere=Sphere(MODULUS, WORK, RADIUS, reach))
    base = BASE | {
        "material": {"contact_modulus": f"{MODULUS} Pa"},
        "adhesion": {"work_of_adhesion": f"{WORK} J/m²", "range": f"{2.0 * reach} m"},
    }
    found = fit(plan(written(tmp_path / "curve.csv", rows), base=base, parameters=["adhesion.range"]))
    low, high = found.fit.intervals["adhesion.range"]
    assert low < reach < high < 2.0 * low
    assert set(found.models) == {"Maugis"}


def test_a_contact_point_may_be_given(good: np.ndarray[Any, Any], tmp_path: Path) -> None:
    """Where it is known the modulus is known better; with its ± as well as that allows."""
    path = written(tmp_path / "curve.csv", good + np.array([500.0, 0.0]))
    widths = []
    for point in ("500 nm", "500 ± 20 nm", "free"):
        found = fit(plan(path, contact_point=point)).fit
        low, high = found.intervals[PARAMETERS[0]]
        assert low < MODULUS < high
        widths.append(high - low)
    assert widths[0] < widths[1] <= 1.05 * widths[2]


def test_a_map_has_a_line_for_each_curve(good: np.ndarray[Any, Any], tmp_path: Path) -> None:
    rows = [
        np.column_stack([np.full(len(good), i), np.full(len(good), i), np.zeros(len(good)), good]) for i in range(3)
    ]
    rows[1] = rows[1][:200]
    path = written(tmp_path / "map.csv", np.vstack(rows), "curve,x [µm],y [µm],z [nm],F [nN]")
    done = fit_many(plan(path), tmp_path / "fits", workers=1)
    assert done.counts == {"done": 2, "refused": 1}
    with (done.folder / "fits.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert [row["status"] for row in table] == ["done", "refused", "done"]
    assert "one segment" in table[1]["reason"]
    assert (
        float(table[0]["material.contact_modulus_low [Pa]"])
        < MODULUS
        < float(table[0]["material.contact_modulus_high [Pa]"])
    )
    assert (done.folder / "contact_modulus.png").is_file()


def test_what_is_known_is_left_when_a_fit_is_broken_off(
    good: np.ndarray[Any, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken_off(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("contact1d.workflow.fit.fit.compared", broken_off)
    with pytest.raises(KeyboardInterrupt):
        fit(plan(written(tmp_path / "curve.csv", good)), folder=tmp_path / "out")
    found = json.loads((tmp_path / "out" / "fit.json").read_text(encoding="utf-8"))
    assert found["status"] == "interrupted"
    low, high = found["parameters"][PARAMETERS[0]]["interval"]
    assert low < MODULUS < high


def test_the_command_leaves_a_folder(good: np.ndarray[Any, Any], tmp_path: Path) -> None:
    written(tmp_path / "curve.csv", good)
    file = tmp_path / "fit.toml"
    file.write_text(
        f'data = "curve.csv"\nparameters = {json.dumps(PARAMETERS)}\n[instrument]\nstiffness = "{STIFFNESS} N/m"\n'
        f'[base.bodies]\nprofile = {{ kind = "parabola", radius = "{RADIUS} m" }}\n'
        '[base.material]\ncontact_modulus = "1 MPa"\n[base.adhesion]\nwork_of_adhesion = "20 mJ/m²"\n',
        encoding="utf-8",
    )
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["fit", str(file), "--out", str(out)])
    assert done.exit_code == 0, done.output
    found = json.loads((out / "fit.json").read_text(encoding="utf-8"))
    assert found["status"] == "done"
    for name, exact in zip(PARAMETERS, (MODULUS, WORK), strict=True):
        low, high = found["parameters"][name]["interval"]
        assert low < exact < high
    assert found["run"]["difference"] <= found["run"]["allowed"]
    assert {"curve.csv", "scene.toml", "fit.png"} <= {path.name for path in out.iterdir()}
    _require_complete(found, out, good)
    again = CliRunner().invoke(app, ["fit", str(file), "--out", str(tmp_path)])
    assert again.exit_code == 2


def _require_complete(found: dict[str, Any], out: Path, rows: np.ndarray[Any, Any]) -> None:
    """What fit.json says of the curve, and curve.csv, are what was measured, in SI."""
    spread, tabor = 0.01 * 1.5 * math.pi * WORK * RADIUS, (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0) / ASSUMED_RANGE
    assert found["noise"]["value"] == pytest.approx(spread, rel=0.3)
    assert found["reduced_chi_squared"] == pytest.approx(1.0, abs=0.5)
    assert found["tabor_parameter"]["value"] == pytest.approx(tabor, rel=0.2)
    assert found["tabor_parameter"]["assumed"]
    low, high = found["contact_modulus"]["interval"]
    assert [low, high] == pytest.approx(found["parameters"][PARAMETERS[0]]["interval"])
    matrix = np.array(found["correlation"]["matrix"])
    assert np.diag(matrix) == pytest.approx(1.0)
    assert matrix == pytest.approx(matrix.T)
    assert np.abs(matrix).max() <= 1.0
    low, high = found["snap_out"]["bracket"]
    assert low < found["snap_out"]["position"] < high
    assert set(found["models"]) == {"JKR", "DMT", "Hertz"}
    assert min(one["criterion_above_least"] for one in found["models"].values()) == 0.0
    assert found["points"]["in_file"] == len(rows)
    with (out / "curve.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert [int(row["line"]) for row in table] == list(range(2, 2 + len(rows)))
    assert [row["segment"] for row in table] == ["approach"] * 200 + ["retract"] * 200
    position, force, predicted = (
        np.array([float(row[name]) for row in table]) for name in ("position [m]", "force [N]", "predicted force [N]")
    )
    assert position == pytest.approx(1e-9 * rows[:, 0], rel=1e-6, abs=1e-14)
    assert force == pytest.approx(1e-9 * rows[:, 1], rel=1e-6, abs=1e-14)
    used = np.array([row["compared"] == "yes" for row in table])
    assert used.sum() == found["points"]["compared"]
    assert float(np.std((force - predicted)[used])) == pytest.approx(spread, rel=0.4)
    # Mean variance of a prediction by four unknowns under white noise; one with a memory averages out less.
    least = 1.96 * found["noise"]["value"] * math.sqrt(4.0 / used.sum())
    assert least <= found["run"]["allowed"] < 10.0 * least
    assert found["fitted_range"]["position"] == pytest.approx([position[used].min(), position[used].max()], rel=1e-6)


@pytest.mark.parametrize("adheres", [False, True])
def test_a_contact_model_is_compared_where_its_numbers_are_in_the_base(tmp_path: Path, adheres: bool) -> None:
    """DMT's needs a radius, JKR's a work of adhesion, Hertz's a parameter of the material, Maugis's a range."""
    slope, d = 0.3, np.linspace(-0.5, 1.5, 200) * 1e-6
    F = MODULUS * np.maximum(d, 0.0) ** 2 / slope * 2.0 / math.pi
    noise_ = 1e-3 * float(F.max()) * np.random.default_rng(3).standard_normal(400)
    rows = 1e9 * np.column_stack([np.append(d, d[::-1]), np.append(F, F[::-1]) + noise_])
    base: dict[str, Any] = {"bodies": {"profile": {"kind": "cone", "slope": slope}}, "material": BASE["material"]}
    base |= {"adhesion": {"work_of_adhesion": "1 nJ/m²"}} if adheres else {}
    path = written(tmp_path / "curve.csv", rows, "d [nm],F [nN]")
    found = fit({"data": str(path), "parameters": PARAMETERS[:1], "base": base})
    assert set(found.models) == ({"JKR", "Hertz"} if adheres else {"Hertz"})
    low, high = found.fit.intervals[PARAMETERS[0]]
    assert low < MODULUS < high < 1.02 * low
