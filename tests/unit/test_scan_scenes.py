"""Scans in scenes: the keys, what is kept, said and drawn, and the uncertainty that the noise gives to results."""

import importlib.util
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Scene, SceneError, load_run, read_scene, run
from tests.scenes import MODULUS

STEEL_ON_GLASS = "lammps_inputs/scenes/steel_on_glass.toml"
R, NOISE = 1e4, 3e-3
"""[µm]"""
X = np.arange(-400.0, 401.0, 1.0)
Z = X**2 / (2.0 * R) + 40.0 + 0.001 * X + NOISE * np.random.default_rng(5).standard_normal(X.size)
FIT = "centre = 'auto', fit = 'parabola'"


def text(names: str = "x [µm];z [nm]\n", x: Any = X, z: Any = Z) -> str:
    return names + "".join(f"{a:.1f};{1e3 * b:.2f}\n" for a, b in zip(x, z, strict=True))


def scene(file: Path, keys: str = FIT, *set_: str) -> Scene:
    return read_scene(STEEL_ON_GLASS, [f"bodies.profile={{ kind = 'table', file = '{file}', {keys} }}", *set_])


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "scan.csv").write_text(text(), encoding="utf-8")
    return tmp_path / "scan.csv"


def test_a_run_says_what_was_removed_and_keeps_the_points(file: Path, tmp_path: Path) -> None:
    done = run(scene(file), tmp_path / "run", figures="png")
    scan = done.document["scan"]
    assert abs(scan["centre"]["value"] + 10e-6) <= scan["centre"]["uncertainty"] < 1e-6
    assert abs(scan["radius"]["value"] - 0.01) <= scan["radius"]["uncertainty"] < 1e-5
    assert scan["noise"]["value"] == pytest.approx(3e-9, rel=0.1)
    assert "removed: apex at" in scan["text"]
    assert "LU" not in scan["text"]
    exact = (0.75 * 10.0 * 0.01 / MODULUS) ** (1.0 / 3.0)
    assert abs(done.results.contact_radius.value - exact) <= done.results.contact_radius.uncertainty
    assert (tmp_path / "run" / "scan.png").stat().st_size > 10_000
    again = load_run(tmp_path / "run")
    assert again.scene == done.scene == read_scene(tomllib.loads(str(done.scene)))
    assert again.scene.bodies.profile.height(np.asarray([1e-4])) == done.scene.bodies.profile.height(np.asarray([1e-4]))
    again.plot("scan")


def test_more_noise_is_a_larger_part_of_the_uncertainty(tmp_path: Path) -> None:
    """The same draw ten times as large: the noise is then the whole uncertainty but a few percent."""
    widths, noise = [], Z - X**2 / (2.0 * R) - 0.001 * X - 40.0
    for size in (30.0, 300.0):
        (tmp_path / "scan.csv").write_text(text(z=X**2 / (2.0 * R) + size * noise), encoding="utf-8")
        done = run(scene(tmp_path / "scan.csv", FIT, "bodies.spacing=1 µm"))
        widths.append(done.results.displacement.uncertainty)
    assert widths[1] / widths[0] == pytest.approx(10.0, rel=0.1)


def test_a_scan_that_is_not_the_fitted_shape_is_a_warning(file: Path, tmp_path: Path) -> None:
    (tmp_path / "worn.csv").write_text(text(z=np.maximum(Z, 40.0 + 0.001 * X + 0.5)), encoding="utf-8")
    assert "is no parabola" in run(scene(tmp_path / "worn.csv")).warnings["scan_fit"]
    assert "scan_fit" not in run(scene(file)).warnings


def points(found: Scene) -> Any:
    profile: Any = found.bodies.profile
    return profile.x, profile.z


def test_units_of_columns_without_names_and_of_a_ball_measured_from_above(file: Path, tmp_path: Path) -> None:
    other, wanted = tmp_path / "other.csv", points(scene(file))
    for names, z in (("", Z), ("", -Z), ("x [µm];z [nm]\n", -Z)):
        other.write_text(text(names, z=z), encoding="utf-8")
        up, down = ("nm", "-nm") if z is Z else ("-nm", "nm")
        assert points(scene(other, f"{FIT}, units = ['µm', '{up}']")) == wanted
        with pytest.raises(SceneError, match="as those of a bump seen from above") as caught:
            scene(other, f"{FIT}, units = ['µm', '{down}']")
        advised = str(caught.value).split("or of its unit: ")[1].splitlines()[0]
        assert points(scene(other, f"{FIT}, {advised}")) == wanted
    other.write_text(text(""), encoding="utf-8")
    with pytest.raises(SceneError, match="nothing says what LU stands for"):
        scene(other)


WRONG = {
    "no options": ("level = false", 'scan, write centre = "auto" with smooth = "auto" or a fit'),
    "no flat part": (f"{FIT}, level = true", "a tilt of a parabola only moves the apex; remove level"),
    "other units": (f"{FIT}, units = ['mm', 'nm']", "not together with other units in the file's names"),
    "units of what": (f"{FIT}, units = ['V', 'nm']", "must be the two units of position and height"),
    "two units": (f"{FIT}, units = ['µm', 'nm'], scale = '1 µm'", "not together with scale"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_key_gets_its_sentence(name: str, file: Path) -> None:
    keys, words = WRONG[name]
    with pytest.raises(SceneError) as caught:
        scene(file, keys)
    assert words in str(caught.value)


def test_a_noisy_side_is_refused_with_units_and_the_way_out(tmp_path: Path) -> None:
    side = X >= 0.0
    (tmp_path / "side.csv").write_text(text("r [µm];z [nm]\n", X[side], (Z - 0.001 * X)[side]), encoding="utf-8")
    with pytest.raises(SceneError, match=r"must have its apex at r = 0; at r = .* µm the height is lower by .* nm"):
        scene(tmp_path / "side.csv", "level = false")
    body = scene(tmp_path / "side.csv", "smooth = 'auto'").bodies.profile
    assert float(body.height(np.asarray([3e-4]))[0]) == pytest.approx(4.5e-6, rel=1e-3)


def test_a_stated_length_is_compared_with_half_of_it(file: Path) -> None:
    profile = scene(file, "centre = 'auto', smooth = '50 µm'").bodies.profile
    (finer,) = profile.alternatives
    assert profile.taken is not None
    assert profile.taken.knots == pytest.approx(np.linspace(0.0, 4.1e-4, 9), rel=0.01)
    assert len(finer.knots) == 17
    r = np.asarray([1e-4])
    assert float(finer.height(r)[0]) == pytest.approx(float(profile.height(r)[0]), rel=0.01)


def test_a_clean_scan_may_keep_its_points(tmp_path: Path) -> None:
    """An apex between two points: centre alone shifts them, and the mean of both sides is the parabola."""
    (tmp_path / "clean.csv").write_text(text(z=(X - 10.25) ** 2 / (2.0 * R)), encoding="utf-8")
    body = scene(tmp_path / "clean.csv", "centre = 'auto'").bodies.profile
    # Heights with two decimals of a nm
    assert float(body.height(np.asarray([3e-4]))[0]) == pytest.approx(4.5e-6, rel=1e-5)


@pytest.mark.skipif(importlib.util.find_spec("SurfaceTopography") is None, reason="the extra instruments is not there")
def test_a_map_of_an_instrument_is_its_line_through_the_highest_point(tmp_path: Path) -> None:
    from SurfaceTopography import Topography

    along = np.linspace(-300.0, 300.0, 601)
    x, y = np.meshgrid(along, along[::10], indexing="ij")
    Topography(-(x**2 + y**2) / (2.0 * R), (601.0, 610.0), unit="µm").to_x3p(str(tmp_path / "map.x3p"))
    profile = scene(tmp_path / "map.x3p").bodies.profile
    assert profile.curvature_radius is None
    assert float(profile.height(np.asarray([1e-4]))[0]) == pytest.approx(0.5e-6, rel=1e-3)


def test_without_the_reader_of_instruments_the_way_to_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "SurfaceTopography", None)
    (tmp_path / "map.x3p").write_bytes(b"PK")
    with pytest.raises(SceneError, match=r"pip install contact1d\[instruments\]"):
        scene(tmp_path / "map.x3p")
