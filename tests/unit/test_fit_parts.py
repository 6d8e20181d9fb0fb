"""What a fit is made of: files of curves to their bounds, contact models beside closed forms, noise and covariance."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student

from contact1d import read_scene
from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.data import DataError
from contact1d.workflow.fit.forward import LAWS, Body, Branch
from contact1d.workflow.fit.noise import averaged, noises
from tests.unit.test_fit import BASE, DEPTH, MODULUS, RADIUS, STIFFNESS, TABOR, WORK, Array
from tests.unit.test_fit_files import read_one
from validation.references.force_curves import Sphere, measured, noise

SPHERE = Sphere(MODULUS, WORK, RADIUS, TABOR)
CURVE = 2e-4
"""Of the pull-off force: 6000 places of the reference, with straight lines between."""
ROUND_OFF = 1e-9


def rows(count: int = 60) -> Array:
    """z [nm] up and down again, and F [nN], an approach of half the points that touches in its middle."""
    z = np.round(np.linspace(-100.0, 100.0, count // 2), 2)
    z = np.append(z, z[::-1][: count - count // 2])
    z = np.append(z, z[-1:] - 1.0) if z.size < count else z
    return np.column_stack([z, np.round(np.maximum(z, 0.0) ** 1.5 / 10.0 + 0.01 * np.cos(37.0 * np.arange(count)), 4)])


def text(numbers: Array, names: str = "z [nm],F [nN]") -> str:
    return names + "\n" + "".join(",".join(f"{x:.4f}" for x in row) + "\n" for row in numbers)


def test_an_indentation_with_opposite_signs_becomes_the_position_of_the_piezo(tmp_path: Path) -> None:
    """z = d + F/k."""
    given = read_one(tmp_path / "curve.csv", text(-rows(), "d [nm],F [nN]"), reverse=["d", "F"])
    assert given.forces == pytest.approx(1e-9 * rows()[:, 1], rel=1e-12, abs=1e-20)
    assert given.positions == pytest.approx(1e-9 * (rows()[:, 0] + rows()[:, 1] / 0.5), rel=1e-12, abs=1e-20)


def cut(rank: int) -> Array:
    """Forces above the one of this rank are equal to it."""
    return np.column_stack([rows()[:, 0], np.minimum(rows()[:, 1], np.sort(rows()[:, 1])[-rank])])


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (rows(40), ""),
        (rows(39), "39 points, and at least 40"),
        (cut(5), ""),
        (cut(6), "saturated: 6 points"),
        (np.delete(rows(), slice(8, 14), axis=0), ""),
        (np.delete(rows(), slice(8, 16), axis=0), "gap in z after line 9"),
        (rows(70)[:45], ""),
        (rows(70)[:44], "segment retract has 9 points"),
        (rows() * [-1.0, 1.0], r'reverse = \["z"\]'),
    ],
)
def test_what_is_just_a_curve_and_what_is_none(data: Array, words: str, tmp_path: Path) -> None:
    if not words:
        assert read_one(tmp_path / "curve.csv", text(data)).of("approach").size >= 20
        return
    with pytest.raises(DataError, match=words):
        read_one(tmp_path / "curve.csv", text(data))


def forces(*jump: float) -> ForceCurve:
    """Approach and retraction of 60 points each, with noise of 0.1, and a jump of these steps in both."""
    draw = np.random.default_rng(8)
    fall = np.concatenate([np.zeros(30), -np.cumsum(jump), np.full(30 - len(jump), -sum(jump))])
    z = np.concatenate([np.arange(60.0), 59.0 - np.arange(60.0)])
    F = 5.0 + np.concatenate([fall, fall[::-1]]) + 0.1 * draw.uniform(-1.0, 1.0, 120)
    return ForceCurve(z, F, np.repeat([0, 2], 60), np.arange(120) + 2)


@pytest.mark.parametrize("jump", [(4.0,), (1.0, 2.5, 0.9)])
def test_a_jump_has_its_steps_and_three_points_beside_it_are_left_out(jump: tuple[float, ...]) -> None:
    curve = forces(*jump)
    approach, retraction = curve.segments
    many = len(jump)
    assert (approach.jump, retraction.jump) == ((29, 29 + many), (30 - many, 30))
    assert approach.held.tolist() == list(range(29 + many, 60))
    assert approach.apart.tolist() == list(range(30))
    assert retraction.held.tolist() == list(range(60, 91 - many))
    assert retraction.apart.tolist() == list(range(90, 120))
    assert set(range(60)) - set(approach.compared.tolist()) == set(range(27, 32 + many))
    assert curve.baseline == pytest.approx(5.0, abs=0.05)
    rising = ForceCurve(curve.positions, np.linspace(0.0, 119.0, 120), curve.kinds, curve.lines)
    assert rising.baseline == pytest.approx(5.5)  # without a jump the first fifth of the approach


def branch_of(kind: str) -> Branch:
    bodies = BASE["bodies"] | {"particles": 3, "spacing": "1 nm", "bulk_stiffness": "auto", "lower": "rigid_plane"}
    load = {"kind": "load", "force": "1 nN"}
    scene = read_scene({"title": kind, "bodies": bodies, "material": BASE["material"], "experiment": load})
    return LAWS[kind].branch(Body.of(scene.bodies.profile, 4.0 * DEPTH), MODULUS, WORK, TABOR)


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("stiffness", [STIFFNESS, 100.0 * STIFFNESS])
def test_a_contact_model_on_a_spring_is_the_closed_form(kind: str, stiffness: float) -> None:
    """Approach and retraction, with the place and the force at which the contact is lost."""
    branch = branch_of(kind)
    z = np.linspace(-2.5, 3.0, 300) * DEPTH
    up, down = np.split(measured(SPHERE, kind, stiffness, z), 2)
    force, down = 1.5 * math.pi * WORK * RADIUS, down[::-1]
    lost, _ = branch.snap_out(stiffness)
    d, F = SPHERE.branch(kind)
    assert lost == pytest.approx((d + F / stiffness).min(), abs=1e-4 * DEPTH)
    held = z > lost + 0.02 * DEPTH
    touching = z > (-TABOR if kind == "Maugis" else 0.0) + 0.02 * DEPTH
    for where, exact in ((held, down), (touching, up)):
        found = branch.forces_at(z[where], stiffness, True)
        assert found == pytest.approx(exact[where], rel=1e-4, abs=CURVE * force)
    pitch = float(z[1] - z[0])
    let_go = branch.forces_at(z, stiffness, False, pitch)
    assert np.all(let_go[z < lost - pitch] == 0.0)
    assert let_go[held] == pytest.approx(down[held], rel=1e-4, abs=CURVE * force)


RUNS = [np.array([0, 1, 2, 5, 6, 7, 8, 12]), np.arange(20, 32)]
"""Indices of points, some of which were left out."""


@pytest.mark.parametrize(("share", "memory"), [(0.0, 1.0), (0.4, 3.0), (1.0, 3.0), (0.9, 0.7)])
def test_whitening_makes_the_covariance_of_a_noise_unity(share: float, memory: float) -> None:
    """V = (1 − s) I + s exp(−|i − j|/τ) of each run: W V Wᵀ = I, log |V| = −2 log |W|."""
    (filtered,) = noises([(share, memory)], RUNS)
    V = np.zeros((20, 20))
    for run, part in zip(RUNS, (slice(0, 8), slice(8, 20)), strict=True):
        V[part, part] = share * np.exp(-np.abs(run[:, None] - run) / memory) + (1.0 - share) * np.eye(run.size)
    W = filtered.whitened(np.eye(20))
    assert W @ V @ W.T == pytest.approx(np.eye(20), abs=ROUND_OFF)
    assert filtered.log_determinant == pytest.approx(np.linalg.slogdet(V)[1], abs=ROUND_OFF)


def test_a_line_in_white_noise_has_the_interval_of_student() -> None:
    """Two parameters of 12 points, nothing known: least squares, s² (JᵀJ)⁻¹ and t with 10 degrees of freedom."""
    slopes = np.column_stack([np.ones(12), np.arange(12.0)])
    residuals = np.tile([1.0, -1.2, 0.4], 4) + 0.3 * np.arange(12.0)
    found = averaged([np.arange(12)], residuals, slopes, np.zeros((0, 3)), looks=1)
    white = next(estimate for estimate in found.estimates if estimate.noise.share == 0.0)
    _, (squares,), *_ = np.linalg.lstsq(slopes, residuals)
    assert white.covariance == pytest.approx(squares / 10.0 * np.linalg.inv(slopes.T @ slopes), rel=1e-4)
    ends = found.ends(1, 0.95) + found.best.step[1]
    shares = [e.weight * student.cdf((ends - e.step[1]) / math.sqrt(e.covariance[1, 1]), 10.0) for e in found.estimates]
    assert sum(shares) == pytest.approx([0.025, 0.975], abs=1e-5)


@pytest.mark.parametrize("pause", [False, True])
def test_two_runs_share_their_noise_unless_there_was_a_pause(pause: bool) -> None:
    """A force that is largest at the turn: σ² (Jᵀ V⁻¹ J)⁻¹ with V of the record, or of each run if far apart there."""
    runs, memory, draw = [np.arange(100), np.arange(100, 200)], 20.0, np.random.default_rng(11)
    x = np.concatenate([np.linspace(-1.0, 1.0, 100), np.linspace(1.0, -1.0, 100)])
    slopes = np.column_stack([np.maximum(x, 0.0) ** 1.5, np.repeat(np.eye(2), 100, axis=0)])
    drawn = [noise(draw, 100, memory), noise(draw, 100, memory)] if pause else [noise(draw, 200, memory)]
    found = averaged(runs, np.concatenate(drawn), slopes, np.zeros((0, 4)), looks=2).best
    share, memory = found.noise.share, found.noise.memory
    V = share * np.exp(-np.abs(np.subtract.outer(np.arange(200), np.arange(200))) / memory)
    V = (V * np.kron(np.eye(2), np.ones((100, 100))) if pause else V) + (1.0 - share) * np.eye(200)
    exact = found.deviation**2 * np.linalg.inv(slopes.T @ np.linalg.solve(V, slopes))
    assert found.covariance == pytest.approx(exact, rel=1e-4)
