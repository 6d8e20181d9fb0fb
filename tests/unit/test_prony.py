"""Prony series: from a file into a scene, one of its terms by its index, and from a measured relaxation.

References typed here: E(t) and E′ + i E″ of random series; Mindlin's stiffness.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Contact1dError, SceneError, prony_terms, read_scene, run
from tests.command import contact1d
from tests.scenes import refused

E = 3e6
SCENE = """
title = "relaxes"
bodies.profile = { kind = "parabola", radius = "2 mm" }
bodies.particles = "auto"
bodies.spacing = "0.02 mm"
bodies.lower = "rigid_plane"
material = { upper = "rigid", lower = { youngs_modulus = "3 MPa", poisson_ratio = 0.4 } }
experiment = { kind = "history", displacement = [["0 s", "0 µm"], ["1 s", "8 µm"], ["5 s", "8 µm"]] }
viscoelasticity.terms = """
LISTED = '[{ share = "0.3 ± 0.02", time = "1.5 ± 0.1 s" }, { share = 0.2, time = "10 s" }]'
FILE = '{ file = "t.csv" }'
CLOSE, NOISY = 0.01, 0.02
"""Of E(0): what the given times of the fit leave of an exact table, and of one with 1 % of noise."""


@pytest.mark.parametrize(
    "text",
    [
        "share,time [ms]\n0.3 ± 0.02,1500 ± 100\n0.2,10000\n",
        "i;g_i;tau_i (s)\n1;0.3 ± 0.02;1.5 ± 0.1\n2;0.2;10\n",
        "Messung 7\nTime (s);share;share_uncertainty;time uncertainty/ms\n1,5;0,3;0,02;100\n10;0,2;;\n",
    ],
)
def test_a_series_in_a_file_is_that_of_a_list(text: str, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(text, encoding="latin-1")
    found, same = read_scene(SCENE + FILE, folder=tmp_path), read_scene(SCENE + LISTED)
    assert found == same == read_scene(str(found))
    assert found.shares == pytest.approx(dict(same.shares))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("share,time [s]\n\n1.5,2\n", "share (t.csv, line 3) = 1.5: must be greater than 0 and at most 1"),
        ("share,time [s]\n0.6,1\n0.7,2\n", '"t.csv": the shares of the instantaneous modulus must add up to 1'),
        ("t [s],E [MPa]\n1,2\n", '"t.csv": has moduli and no shares: contact1d terms t.csv --out terms.csv'),
        ("a,b\n0.3,1\n", 'terms.file = "t.csv": has no lines below headings that are known: share and time [s]'),
    ],
)
def test_a_wrong_file_is_named_with_its_line(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(text)
    assert words in str(refused(SCENE + FILE, folder=tmp_path))


def test_one_term_is_changed_by_its_index() -> None:
    base, key = read_scene(SCENE + LISTED), "viscoelasticity.terms[1].share"
    changed = read_scene(SCENE + LISTED.replace("0.2", "0.25"))
    assert base.with_({key: 0.25}) == read_scene(base, [f"{key}=0.25"]) == changed
    assert base.moved(key, 0.25 / 0.2).viscoelasticity == changed.viscoelasticity


def test_a_rigid_body_leaves_the_shear_modulus_to_the_other_one() -> None:
    """Along x 2 (1 − ν)/(2 − ν) of E* (Mindlin)."""
    found = read_scene(SCENE + LISTED)
    assert found.tangential_stiffness / found.bulk_stiffness == pytest.approx(1.2 / 1.6)
    with pytest.raises(SceneError, match="one of the two bodies must be elastic; give its E and ν"):
        found.with_(material__lower="rigid")


def relaxed(t: Any, shares: Any, times: Any) -> Any:
    """E(t)/E(0), with the share of E(∞) first."""
    return shares[0] + np.exp(-np.divide.outer(t, times)) @ shares[1:]


def table(t: Any, shares: Any, times: Any, noise: Any) -> dict[str, Any]:
    """E(t) with one noise, E′ and E″ with two."""
    if len(noise) == 1:
        return {"Time [ms]": 1e3 * t, "E(t) [MPa]": 1e-6 * E * relaxed(t, shares, times) * noise[0]}
    found = E * (shares[0] + (1.0 / (1.0 - 1j * np.divide.outer(t, times))) @ shares[1:])
    return {"f [Hz]": 0.5 / math.pi / t, "E' [Pa]": found.real * noise[0], "Loss/kPa": 1e-3 * found.imag * noise[1]}


@pytest.mark.parametrize("moduli", [1, 2])
@pytest.mark.parametrize(("noise", "allowed"), [(0.0, CLOSE), (0.01, NOISY)])
def test_the_series_of_a_table_has_its_modulus(noise: float, allowed: float, moduli: int) -> None:
    rng = np.random.default_rng(5)
    for count in [1, 2, 3, 5, 8] * 5:
        shares, times = rng.dirichlet(np.ones(count + 1)), 10.0 ** rng.uniform(-3.0, 3.0, count)
        t = np.geomspace(0.1 * min(times), 10.0 * max(times), 60)
        found = prony_terms(table(t, shares, times, 1.0 + noise * rng.standard_normal((moduli, 60))))
        parts, own = zip(*((term["share"], float(term["time"][:-2])) for term in found.terms), strict=True)
        fitted = found.modulus.value * relaxed(t, [1.0 - sum(parts), *parts], own)
        assert fitted == pytest.approx(E * relaxed(t, shares, times), abs=allowed * E)
        assert abs(found.modulus.value - E) <= found.modulus.uncertainty


def test_a_contact_by_the_terms_of_a_table_is_that_of_its_body(tmp_path: Path) -> None:
    t = np.geomspace(1e-3, 1e3, 40)
    rows = np.c_[1e6 * t, relaxed(t, [0.5, 0.3, 0.2], [1.5, 10.0])]
    np.savetxt(tmp_path / "e.txt", rows, delimiter=";", header="t [µs];modulus/MPa", comments="", encoding="latin-1")
    done = contact1d("terms", tmp_path / "e.txt", "--out", tmp_path / "t.csv")
    assert (done.stderr, done.stdout[:27]) == ("", "instantaneous modulus: 1.00")
    scene = read_scene(SCENE + FILE, folder=tmp_path)
    found, exact = (run(one, figures=False) for one in (scene, SCENE + LISTED))
    assert found.results.force.value == pytest.approx(exact.results.force.value, rel=CLOSE)
    assert read_scene(found.folder / "scene.toml").viscoelasticity == scene.viscoelasticity


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"t [s]": [1, 2], "E [MPa]": [3, -2]}, "line 3: E must be greater than 0"),
        ({"ω [Hz]": [1], "E' [Pa]": [2], "E'' [Pa]": [1]}, "ω must be an angular frequency"),
    ],
)
def test_what_is_no_relaxation_is_reported(columns: dict[str, Any], words: str) -> None:
    with pytest.raises(Contact1dError, match=words):
        prony_terms(columns)


def test_a_table_that_ends_before_a_plateau_has_a_warning() -> None:
    found = prony_terms({"t [s]": [1, 2, 3, 4], "E [Pa]": [4, 3, 2.5, 2.2]})
    assert [*found.warnings] == ["short_times", "long_times"]
