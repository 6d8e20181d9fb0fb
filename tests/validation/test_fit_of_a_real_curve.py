"""A curve of an instrument, from nanite's source archive (GPL-3, fetched and never shipped), beside nanite itself.

The archive's one CSV has approach and retraction side by side. Its force is 0.02 nN over 300 nm and what the instrument
was is not in it, so that the stiffness and the radius here are assumed, the same in both programs.
"""

from __future__ import annotations

import subprocess
import sys
import tarfile
import time
from pathlib import Path

import pytest

from contact1d import fit

VERSION = "4.2.3"
NAME = "fmt-afm-workshop-fd_single_2021-10-22_14.16.csv"
STIFFNESS, RADIUS = 0.05, 10e-6
"""k_c [N/m] and R [m], assumed."""
FACTOR = 2.0
"""Between a Hertz fit of the approach and one with adhesion of both ways: the retraction has a pull-off force."""
NANITE = f"""
import sys, time, nanite
begin = time.time()
curve = nanite.load_group(sys.argv[1], meta_override={{"spring constant": {STIFFNESS}}})[0]
curve.apply_preprocessing(["compute_tip_position", "correct_force_offset", "correct_tip_offset"])
given = curve.get_initial_fit_parameters(model_key="hertz_para")
given["R"].value, given["nu"].value = {RADIUS}, 0.5
curve.fit_model(model_key="hertz_para", params_initial=given, weight_cp=0)
print(curve.fit_properties["params_fitted"]["E"].value, time.time() - begin)
"""


@pytest.mark.slow
def test_a_real_curve_has_the_modulus_of_nanite(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    venv = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", venv], check=True)
    pip = [venv / "bin" / "pip", "--disable-pip-version-check"]
    package = f"nanite=={VERSION}"
    subprocess.run([*pip, "download", "-q", package, "--no-binary", "nanite", "--no-deps", "-d", tmp_path], check=True)
    subprocess.run([*pip, "install", "-q", package], check=True)
    with tarfile.open(tmp_path / f"nanite-{VERSION}.tar.gz") as archive:
        source = archive.extractfile(f"nanite-{VERSION}/tests/data/{NAME}")
        assert source is not None
        lines = source.read().decode().splitlines()
    raw = tmp_path / NAME
    raw.write_text("\n".join(lines) + "\n")
    said = subprocess.run([venv / "bin" / "python", "-c", NANITE, raw], check=True, capture_output=True, text=True)
    theirs, their_seconds = map(float, said.stdout.split())

    start = next(i for i, line in enumerate(lines) if line.startswith("Extend"))
    rows = [line.split(",") for line in lines[start + 1 :] if line.strip()]
    data = [
        f"{z},{F},{way}" for way, at in (("approach", 0), ("retract", 2)) for z, F in (row[at : at + 2] for row in rows)
    ]
    curve = tmp_path / "curve.csv"
    curve.write_text("z [nm],F [nN],segment\n" + "\n".join(data) + "\n")
    begin = time.perf_counter()
    found = fit(
        {
            "data": str(curve),
            "parameters": ["material.contact_modulus", "adhesion.work_of_adhesion"],
            "instrument": {"stiffness": f"{STIFFNESS} N/m ± 5 %"},
            "base": {
                "bodies": {"profile": {"kind": "parabola", "radius": f"{RADIUS} m"}},
                "material": {"contact_modulus": "30 Pa"},
                "adhesion": {"work_of_adhesion": "1 µJ/m²"},
            },
        }
    )
    ours, seconds = 0.75 * found.fit.values["material.contact_modulus"], time.perf_counter() - begin
    with capsys.disabled():
        print(f"\nE: nanite {theirs:.3g} Pa in {their_seconds:.2f} s, contact1d {ours:.3g} Pa in {seconds:.2f} s")
        print(found.fit.intervals, found.warnings, list(found.models))
    assert 1.0 / FACTOR < ours / theirs < FACTOR
