"""Claim: a measured curve gets in from any words, encoding and layout, or is refused with the reason and a fix."""

import itertools
import re
import subprocess
import sys
import tarfile
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d import fit
from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.data import DataError, curves
from contact1d.workflow.fit.plan import read_fit
from tests.command import contact1d

Array = np.ndarray[Any, np.dtype[np.float64]]
HALF = 50
"""Points of a segment."""
DIGITS = 1e-4
"""Last digit of a number in a file, over its range."""
BASE = {"bodies": {"profile": {"kind": "parabola", "radius": "5 µm"}}, "material": {"contact_modulus": "1 MPa"}}
PLAN = {"parameters": ["material.contact_modulus"], "base": BASE, "instrument": {"stiffness": "0.5 N/m"}}
RIGID = {"instrument": None}


def read(path: Path, content: bytes | str, **changes: Any) -> list[ForceCurve | DataError]:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    given = {key: value for key, value in (PLAN | {"data": str(path)} | changes).items() if value is not None}
    return [curve for _, _, curve in curves(path, read_fit(given))]


def read_one(path: Path, content: bytes | str, **changes: Any) -> ForceCurve:
    (curve,) = read(path, content, **changes)
    if isinstance(curve, DataError):
        raise curve
    return curve


def contact(half: int = HALF, noise: float = 0.02) -> Array:
    """z [nm] up and down again, and F [nN], which is lower on the retraction, (2 half, 2)."""
    z = np.linspace(-100.0, 100.0, half)
    z = np.append(z, z[::-1])
    F = np.maximum(z, 0.0) ** 1.5 / 10.0 - 20.0 * (np.abs(z + 15.0) < 15.0) * (np.arange(2 * half) >= half)
    return np.column_stack([z, F + noise * np.random.default_rng(1).standard_normal(2 * half)])


ROWS = contact()
UP, DOWN = ROWS[:HALF], ROWS[HALF:]
BESIDE, BACKWARDS = np.hstack([UP, DOWN]), np.hstack([UP, DOWN[::-1]])


def text(numbers: Array, names: str, separator: str = ",") -> str:
    lines = (separator.join("" if np.isnan(x) else f"{x:.7g}" for x in row) for row in numbers)
    return "\n".join([names, *lines, ""])


def told(first: str, last: str, hold: str = "", held: int = 4) -> str:
    """A table with a column `segment`; of `held` points around the turn the word is `hold`, if it is given."""
    words = [first] * HALF + [last] * HALF
    words[HALF - held // 2 : HALF + held // 2] = [hold] * held if hold else words[HALF - held // 2 : HALF + held // 2]
    return "z [nm];F [nN];segment\n" + "".join(f"{z:.7g};{F:.7g};{w}\n" for (z, F), w in zip(ROWS, words, strict=True))


MEMS = np.column_stack([np.arange(100.0), ROWS[:, 0], 1e-3 * ROWS[:, 1], ROWS / 7.0, 3.0 * ROWS[:, 0]])
JPK = "# segment: extend\n# columns: height measuredHeight vDeflection time\n" + (
    '# fancyNames: "Height" "Height (measured)" "Vertical Deflection" "Series Time"\n# units: m m N s\n#\n'
)
IN = {
    "UTF-8 with its mark": b"\xef\xbb\xbf" + text(ROWS, "z [nm],F [nN]").encode(),
    "UTF-16 LE": b"\xff\xfe" + text(ROWS, "z [nm]\tF [nN]", "\t").encode("utf-16-le"),
    "UTF-16 BE": b"\xfe\xff" + text(ROWS, "z [nm],F [nN]").encode("utf-16-be"),
    "latin-1": text(1e-3 * ROWS, "20 °C\nz (µm);F (µN)", ";").encode("latin-1"),
    "remark of savetxt": text(ROWS, "# z [nm], F [nN]", " "),
    "remarks with units": text(ROWS, "% z F\n% nm nN", "\t"),
    "units below, one empty": told("0", "1").replace("z [nm];F [nN];segment", "z;F;segment\n[nm];[nN];"),
    "F_avg(N)": text(ROWS * [1.0, 1e-9], "z_nm,F_avg(N)"),
    "microns": text(ROWS * [1e-3, 1.0], "Z_(microns),F_(nN)"),
    "in": text(1e-3 * ROWS, "z in µm, F in µN"),
    "decimal commas": text(ROWS, "z [nm];F [nN]", ";").replace(".", ","),
    "remarks": ("\ufeff# an instrument\n\n" + text(ROWS, "z [nm],F [nN]")).replace("nN]\n", "nN]\n# a remark\n\n", 1),
    "slash": text(ROWS, "Höhe / nm  Kraft / nN", "  "),
    "MEMS": text(MEMS, "Points: 100\nTime_s\tPiezoDisp_nm\tForce_uN\tDisp_V\tForce_V\tPiezo_LowV", "\t"),
    "JPK text": text(np.column_stack([-2e-9 * ROWS[:, 0], ROWS * [-1e-9, 1e-9], np.arange(100)]), JPK, " "),
    "deflection": text(ROWS * [1.0, 2.0], "Ramp (nm),Defl (nm)"),
    "True, False": told("False", "True"),
    "1, 0": told("1", "0"),
    "trace": told("Trace", "Retrace"),
    "of a nanoindenter": told("Load To Max", "Unload From Peak"),
    "side by side": text(BESIDE, "Extend Z-Sense(nm),Extend Force(nN),Retract Z-Sense(nm),Retract Force(nN)"),
    "z rises": text(BACKWARDS[:, [0, 2, 1, 3]], "Calc_Ramp_Ex_nm Calc_Ramp_Rt_nm Defl_nN_Ex Defl_nN_Rt", " "),
    "common z": text(BACKWARDS[:, [0, 1, 3]], "z [nm],F trace [nN],F retrace [nN]"),
}  # fmt: skip
"""Files of the curve `ROWS`."""


@pytest.mark.parametrize("name", IN)
def test_a_file_of_any_form_has_the_numbers_of_its_curve(name: str, tmp_path: Path) -> None:
    changes = {"reverse": ["z"]} if name == "JPK text" else {}
    curve = read_one(tmp_path / "curve.csv", IN[name], **changes)
    assert curve.positions == pytest.approx(1e-9 * ROWS[:, 0], rel=DIGITS, abs=100e-9 * DIGITS)
    assert curve.forces == pytest.approx(1e-9 * ROWS[:, 1], rel=DIGITS, abs=100e-9 * DIGITS)
    assert curve.kinds.tolist() == [0] * HALF + [2] * HALF
    first = {"remarks": 6, "JPK text": 7, "common z": 2}.get(name, curve.lines[0])
    assert curve.lines[:HALF].tolist() == list(range(first, first + HALF))
    assert (curve.times is not None) == (name in ("MEMS", "JPK text"))


def test_segments_of_different_lengths_and_holds_that_are_told(tmp_path: Path) -> None:
    file, shorter = tmp_path / "curve.csv", BESIDE.copy()
    shorter[-20:, 2:] = np.nan
    curve = read_one(file, text(shorter, "approach z [nm];approach F [nN];retract z [nm];retract F [nN]", ";"))
    assert np.bincount(curve.kinds).tolist() == [HALF, 0, HALF - 20]
    for words in (("approach", "retract", "Pause"), ("0", "2", "1"), ("extend", "withdraw", "dwell 2 s")):
        assert np.bincount(read_one(file, told(*words)).kinds).tolist() == [HALF - 2, 4, HALF - 2]
    held_first = told("approach", "retract").replace("approach", "hold", 10)
    assert np.bincount(read_one(file, held_first).kinds).tolist() == [HALF - 10, 0, HALF]


def test_with_both_positions_the_instrument_decides(tmp_path: Path) -> None:
    both = text(
        np.column_stack([ROWS[:, 0], ROWS[:, 0] / 2.0, ROWS[:, 1]]), "Piezo (nm)\tIndentation (nm)\tLoad (nN)", "\t"
    )
    for changes, size in ((RIGID, 50e-9), ({}, 100e-9)):
        assert read_one(tmp_path / "x.txt", both, **changes).positions.max() == pytest.approx(size)


OUT = {
    "words": (text(ROWS, "Foo [nm],F [nN]"), "known words are z: z, piezo", text(ROWS, "piezo [nm],F [nN]"), {}),
    "no force": (text(ROWS, "z [nm],Bar [nN]"), "known words are F: f, fn", text(ROWS, "z [nm],load [nN]"), {}),
    "no names": (text(ROWS, "")[1:], "name the columns", text(ROWS, "z [nm],F [nN]"), {}),
    "no units": (text(ROWS, "z,F"), "without a unit", text(ROWS, "z [nm],F [nN]"), {}),
    "unknown unit": (text(ROWS, "z [foo],F [nN]"), "without a unit that is known", text(ROWS, "z [nm],F [nN]"), {}),
    "one column": (text(ROWS[:, 1:], "F [nN]"), "no lines with two numbers", text(ROWS, "z [nm],F [nN]"), {}),
    "volts": (text(BESIDE, "Ex Z(nm),Ex T-B(V),Rt Z(nm),Rt T-B(V)"), "in volts", IN["side by side"], {}),
    "piezo in volts": (text(ROWS, "Piezo_LowV,Force_nN"), "column z is in volts", IN["MEMS"], {}),
    "no stiffness": (IN["in"], "give \\[instrument\\] stiffness", IN["in"], {"instrument": {"stiffness": "1 N/m"}}),
    "two alike": (text(BESIDE, "z [nm],F [nN],z [nm],F [nN]"), "add their segments", IN["side by side"], {}),
    "swapped": (text(ROWS, "F [nN],z [nm]"), "swapped: exchange", text(ROWS, "z [nm],F [nN]"), {}),
    "retraction first": (text(np.vstack([DOWN, UP]), "z [nm],F [nN]"), "must come first", IN["in"], {}),
    "words of a segment": (told("up", "down"), "has the word 'up'; known are approach", told("load", "unload"), {}),
    "segments exchanged": (told("retract", "approach"), "must come before", told("approach", "retract"), {}),
    "no text": (b"PK\0\3" * 99, "is no text", IN["in"], {}),
    "a deflection with ±": (
        IN["deflection"], "write the stiffness without it", IN["deflection"], {"instrument": {"stiffness": "0.5 N/m"}},
    ),
}  # fmt: skip
"""Files with a fault, the reason, and what it becomes if the advice is followed."""


@pytest.mark.parametrize("name", OUT)
def test_a_refusal_has_its_reason_and_following_it_helps(name: str, tmp_path: Path) -> None:
    wrong, reason, right, changes = OUT[name]
    before = RIGID if name == "no stiffness" else {"instrument": {"stiffness": "0.5 ± 0.1 N/m"}} if "±" in name else {}
    with pytest.raises(DataError, match=reason) as error:
        read_one(tmp_path / "curve.csv", wrong, **before)
    assert "\n" not in str(error.value)
    assert read_one(tmp_path / "curve.csv", right, **changes).positions.size == 2 * HALF


@pytest.mark.parametrize("rows", [ROWS, UP, DOWN], ids=["both", "approach", "retraction"])
@pytest.mark.parametrize("sides", [0, 1], ids=["in time", "side by side"])
def test_the_advised_signs_are_the_right_ones_at_once(rows: Array, sides: int, tmp_path: Path) -> None:
    if sides and rows is not ROWS:
        return
    names, table = ("z ex [nm],F ex [nN],z rt [nm],F rt [nN]", BACKWARDS) if sides else ("z [nm],F [nN]", rows)
    for signs, reverse in itertools.product(itertools.product((1, -1), repeat=2), ([], ["z"], ["F"], ["z", "F"])):
        right = [name for name, sign in zip("zF", signs, strict=True) if sign < 0]
        content = text(table * [*signs, *signs][: table.shape[1]], names)
        if reverse != right:
            with pytest.raises(DataError) as error:
                read_one(tmp_path / "curve.csv", content, reverse=reverse or None)
            advised = re.search(r"write reverse = (\[.*?\])", str(error.value))
            assert (eval(advised[1]) if advised else []) == right
            assert bool(advised) != ("leave reverse out" in str(error.value))
        curve = read_one(tmp_path / "curve.csv", content, reverse=right or None)
        assert curve.forces == pytest.approx(1e-9 * rows[:, 1], rel=DIGITS, abs=100e-9 * DIGITS)


def indentation(creep: float, noise: float) -> Array:
    """d [nm] and F [nN] of Hertz's contact in load control, 302 points at the largest load, (902, 2)."""
    F = np.concatenate([np.linspace(0.0, 1e3, 300), np.full(302, 1e3), np.linspace(1e3, 0.0, 300)])
    held = creep * (1.0 - np.exp(-np.linspace(0.0, 3.0, 302)))
    d = 10.0 * F ** (2.0 / 3.0) + 1e3 * np.concatenate([np.zeros(300), held, np.full(300, held[-1])])
    return np.column_stack([d, F + noise * np.random.default_rng(2).standard_normal(902)])


@pytest.mark.parametrize(("creep", "noise"), [(0.0, 0.0), (0.1, 0.0), (0.3, 0.0), (0.1, 5.0)])
def test_a_hold_at_the_set_load_is_a_segment(creep: float, noise: float, tmp_path: Path) -> None:
    curve = read_one(tmp_path / "x.csv", text(indentation(creep, noise), "Depth (nm),Load (nN)"), **RIGID)
    assert np.bincount(curve.kinds) == pytest.approx([300, 302, 300], abs=10 + 2 * noise)


@pytest.mark.parametrize("noise", [0.02, 1.0])
def test_a_hold_at_the_set_position_is_a_segment(noise: float, tmp_path: Path) -> None:
    """The force relaxes by a tenth."""
    up, down = np.split(contact(300, noise), 2)
    hold = np.column_stack([np.full(200, 100.0), up[-1, 1] - np.linspace(0.0, 10.0, 200)])
    curve = read_one(tmp_path / "x.csv", text(np.vstack([up, hold, down]), "z [nm],F [nN]"))
    assert np.bincount(curve.kinds) == pytest.approx([300, 200, 300], abs=5)


def test_a_smooth_extreme_is_no_cut_force(tmp_path: Path) -> None:
    """A sine has more than seven points within 1e-4 of its range; it turns gradually, too."""
    phase = np.linspace(0.0, 2.0 * np.pi, 4000)
    z = -100.0 * np.cos(phase)
    F = np.maximum(z, 0.0) ** 1.5 / 10.0 - 30.0 * np.sin(phase) ** 2 * (phase > np.pi)
    for digits in (4, 1):
        curve = read_one(tmp_path / "x.csv", text(np.round(np.column_stack([z, F]), digits), "z [nm],F [nN]"))
        assert np.bincount(curve.kinds) == pytest.approx([2000, 0, 2000], abs=30)
    for rows in (contact(500), np.column_stack([z, F])):
        for least, largest in ((-99.0, 70.0), (-15.0, 999.0)):
            with pytest.raises(DataError, match="saturated"):
                read_one(tmp_path / "x.csv", text(np.clip(rows, [-999.0, least], [999.0, largest]), "z [nm],F [nN]"))


def test_of_many_points_neighbours_are_averaged_within_segments(tmp_path: Path) -> None:
    rows = np.column_stack([contact(12_031), np.arange(24_062.0)])
    curve = read_one(tmp_path / "x.csv", text(rows, "z [nm],F [nN],t [s]"))
    assert np.bincount(curve.kinds).tolist() == [6016, 0, 6016]
    assert curve.lines[[0, 1, 6015, 6016]].tolist() == [2, 4, 12_032, 12_033]
    assert curve.times is not None
    assert curve.times[[0, 6015, 6016]].tolist() == [0.5, 12_030.0, 12_031.5]
    pairs = rows[12_031 : 12_031 + 12_030].reshape(-1, 2, 3).mean(axis=1)
    assert curve.forces[6016:-1] == pytest.approx(1e-9 * pairs[:, 1], abs=1e-13)


class Measured(dict[str, Any]):
    """A curve as afmformats returns it, of a cantilever of 0.5 N/m."""

    enum = 7

    @property
    def metadata(self) -> dict[str, float]:
        return {"spring constant": 0.5, "position x": 1e-6}


def test_the_file_of_an_instrument_becomes_curves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the stiffness of the file doubles the forces, since the deflection was measured."""
    file, z, F = tmp_path / "map.jpk-force-map", *1e-9 * ROWS.T
    monkeypatch.setitem(sys.modules, "afmformats", None)
    with pytest.raises(DataError, match=r'pip install "contact1d\[curves\]"'):
        read(file, b"PK\0")
    segment = np.repeat([0, 1], HALF)
    curve = Measured({"height (measured)": -z, "force": F, "segment": segment, "time": np.arange(100.0)})
    tip = Measured({"tip position": -z, "force": F, "segment": segment})
    errors = SimpleNamespace(AFMFileFormatError=KeyError, MissingMetaDataError=LookupError)
    monkeypatch.setitem(sys.modules, "afmformats", SimpleNamespace(load_data=lambda _: [curve, tip], errors=errors))
    read_curves = read(file, b"PK\0", instrument={"stiffness": "1 N/m"})
    for found, size in zip(read_curves, (1.0, 2.0), strict=True):
        assert isinstance(found, ForceCurve)
        assert found.forces == pytest.approx(2.0 * F)
        assert found.positions == pytest.approx(z + (size - 1.0) * 2.0 * F)
        assert found.kinds.tolist() == [0] * HALF + [2] * HALF
    refused, accepted = read(file, b"PK\0", **RIGID)
    assert 'stiffness = "0.5 N/m"' in str(refused)
    assert isinstance(accepted, ForceCurve)
    assert accepted.forces == pytest.approx(F)


def sources(package: str, folder: Path) -> Path:
    """The unpacked source archive of a package, which is not in this repository."""
    command = [sys.executable, "-m", "pip", "download", "-q", "--no-binary", ":all:", "--no-deps", package]
    if subprocess.run([*command, "-d", str(folder)], capture_output=True).returncode:
        pytest.skip(f"the package index has no source archive of {package}")
    (archive,) = folder.glob(f"{package}*.tar.gz")
    with tarfile.open(archive) as files:
        files.extractall(folder, filter="data")
    return archive.with_suffix("").with_suffix("")


@pytest.mark.slow
def test_real_files_of_instruments_get_in(tmp_path: Path) -> None:
    """One of each kind in the source archive of afmformats."""
    pytest.importorskip("afmformats", reason="the extra curves is not there")
    folder = sources("afmformats", tmp_path) / "tests" / "data"
    kinds = ("*igor*SiN*.ibw", "*hdf5*.h5", "*spot3*.jpk-force", "*map2x2*.jpk-force-map", "*.jpk-qi-data", "*.tab")
    for kind in (*kinds, "*sr_cell*.jpk-force", "*2021-10*.csv"):
        file = next(folder.glob(kind))
        for curve in read(file, file.read_bytes()):
            assert isinstance(curve, ForceCurve), str(curve)
            assert {0, 2} <= {*curve.kinds.tolist()}
            assert curve.positions[curve.of("approach")[-1]] > curve.positions[[0, -1]].max()


@pytest.mark.slow
def test_real_approaches_have_the_modulus_that_nanite_finds(tmp_path: Path) -> None:
    """Hertz's contact on its example and two curves of afmformats: within 3 %; times are printed."""
    nanite = pytest.importorskip("nanite", reason="the extra peers is not there")
    example = sources("nanite", tmp_path) / "examples" / "data" / "zebrafish-head-section-gray-matter.jpk-force"
    others = sources("afmformats", tmp_path)
    more = [next(others.glob(f"*/**/{name}.jpk-force")) for name in ("*spot3-0192", "force-save-example")]
    parameter = "material.lower.youngs_modulus"
    lower = {"youngs_modulus": "1 kPa", "poisson_ratio": 0.5}
    base = {"bodies": {"profile": {"kind": "parabola", "radius": "18.64 µm"}}}
    for file in (example, *more):
        begin = time.perf_counter()
        curve = nanite.load_group(file)[0]
        curve.apply_preprocessing(["compute_tip_position", "correct_force_offset", "correct_tip_offset"])
        first = curve.get_initial_fit_parameters(model_key="hertz_para")
        first["R"].value, first["nu"].value = 18.64e-6, 0.5
        curve.fit_model(model_key="hertz_para", params_initial=first, segment="approach", weight_cp=False)
        modulus, middle = curve.fit_properties["params_fitted"]["E"].value, time.perf_counter()
        stiffness = f"{curve.metadata['spring constant']} N/m"
        material = {"upper": "rigid", "lower": lower}
        result = fit(file, base | {"material": material}, parameters=[parameter], segment="approach",
                     instrument={"stiffness": stiffness})  # fmt: skip
        print(f"{file.name}: nanite {middle - begin:.2f} s, contact1d {time.perf_counter() - middle:.2f} s")
        assert result.fit.values[parameter] == pytest.approx(modulus, rel=0.03)


SCENE = '[bodies]\nprofile = { kind = "parabola", radius = 1.0 }\n[experiment]\nkind = "load"\n'
DOORS = {
    "scene.toml": (SCENE, ("fit", "sweep", "identify"), "this is a scene", "contact1d run scene.toml"),
    "fit.toml": ('data = "x.csv"\n[base]\n', ("run", "sweep", "deck"), "this is a fit file", "contact1d fit fit.toml"),
    "sweep.toml": ('scene = "s.toml"\n[[axes]]\n', ("run", "fit"), "this is a sweep file", "contact1d sweep"),
    "material.toml": ('radius = "1 mm"\nupper = "steel"\n', ("run", "fit"), "a material file", "contact1d identify"),
    "curve.csv": (text(ROWS, "z [nm],F [nN]"), ("run", "fit", "identify"), "has data", 'data = "curve.csv"'),
    "map.jpk-force": ("PK\0\1", ("run", "fit"), "has data", 'data = "map.jpk-force"'),
    "out/results.json": ("{}", ("run", "fit"), "has the results of a run", "contact1d report out"),
}  # fmt: skip


@pytest.mark.parametrize("name", DOORS)
def test_a_command_with_the_file_of_another_one_names_that(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content, commands, what, advice = DOORS[name]
    monkeypatch.chdir(tmp_path)
    path = Path(name)
    path.parent.mkdir(exist_ok=True)
    path.write_text(content, encoding="utf-8")
    for command, file in itertools.product(commands, {path, path.parent} - {Path()}):
        done = contact1d(command, file, "--out", "new")
        assert done.exit_code == 2
        assert what in done.output
        assert advice in done.output
        assert not Path("new").exists()
