"""What a fit is made of: contact models beside their closed forms, and noise beside its covariance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.stats import t as student

from contact1d.workflow.fit.curve import BESIDE_JUMP, ForceCurve
from contact1d.workflow.fit.forward import LAWS, Body
from contact1d.workflow.fit.noise import averaged, noises
from contact1d.workflow.scene import Circle, Cone, FlatPunch, Parabola
from validation.references.force_curves import Sphere, measured

MODULUS, WORK, RADIUS = 2e6, 0.05, 5e-6
TABOR = (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0)
"""Range of Maugis's contact with µ = 1 [m]."""
SPHERE = Sphere(MODULUS, WORK, RADIUS, TABOR)
DEPTH = SPHERE.zero_load_radius**2 / RADIUS
STIFF = 2.0 * MODULUS * SPHERE.zero_load_radius
CURVE = 2e-4
"""Of the pull-off force: 6000 places of the reference, with straight lines between."""
ROUND_OFF = 1e-9
QUARTER = 0.15
"""Relative: a quarter of the tension is gone between two edges of the branch; measured 0.09."""
Array = np.ndarray[Any, np.dtype[np.float64]]


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("stiffness", [STIFF, 100.0 * STIFF])
def test_a_contact_model_on_a_spring_is_the_closed_form(kind: str, stiffness: float) -> None:
    """Approach and retraction, with the place and the force at which the contact is lost."""
    body = Body.of(Parabola(kind="parabola", radius=RADIUS), 4.0 * DEPTH)
    branch = LAWS[kind].branch(body, MODULUS, WORK, TABOR)
    z = np.linspace(-2.5, 3.0, 300) * DEPTH
    up, down = np.split(measured(SPHERE, kind, stiffness, z), 2)
    force, down = 1.5 * math.pi * WORK * RADIUS, down[::-1]
    lost, _ = branch.snap_out(stiffness)
    d, F = SPHERE.branch(kind)
    exact = d + F / stiffness
    assert lost == pytest.approx(exact.min(), abs=1e-4 * DEPTH)
    held = z > lost + 0.02 * DEPTH
    assert branch.forces_at(z[held], stiffness, True) == pytest.approx(down[held], rel=1e-4, abs=CURVE * force)
    touching = z > (-TABOR if kind == "Maugis" else 0.0) + 0.02 * DEPTH
    assert branch.forces_at(z[touching], stiffness, True) == pytest.approx(up[touching], rel=1e-4, abs=CURVE * force)
    pitch = float(z[1] - z[0])
    let_go = branch.forces_at(z, stiffness, False, pitch)
    assert np.all(let_go[z < lost - pitch] == 0.0)
    assert let_go[held] == pytest.approx(down[held], rel=1e-4, abs=CURVE * force)


@pytest.mark.parametrize("kind", ["JKR", "DMT"])
def test_a_contact_that_is_known_to_hold_goes_on_where_the_model_has_lost_it(kind: str) -> None:
    """Straight, three times as steep as from there to where a quarter of the tension is gone."""
    branch = LAWS[kind].branch(Body.of(Parabola(kind="parabola", radius=RADIUS), 4.0 * DEPTH), MODULUS, WORK, 0.0)
    lost, force = branch.snap_out(STIFF)
    z = np.linspace(lost, 3.0 * DEPTH, 20_000)
    quarter = float(np.interp(0.75 * force, branch.forces_at(z, STIFF, True), z))
    slope = 3.0 * -0.25 * force / (quarter - lost)
    below = lost - np.array([0.1, 1.0]) * DEPTH
    assert branch.forces_at(below, STIFF, True) == pytest.approx(force - slope * (lost - below), rel=QUARTER)


def test_the_first_touch_is_between_the_axis_and_the_first_edge() -> None:
    """F = (4/3) E* √R d^(3/2)."""
    body = Body.of(Parabola(kind="parabola", radius=RADIUS), 4.0 * DEPTH)
    d = 0.5 * body.heights[1:2]
    exact = 4.0 / 3.0 * MODULUS * math.sqrt(RADIUS) * d**1.5
    assert LAWS["Hertz"].branch(body, MODULUS, 0.0, 0.0).forces_at(d, math.inf, True) == pytest.approx(exact, rel=0.2)


@pytest.mark.parametrize("kind", ["Hertz", "JKR"])
@pytest.mark.parametrize("shape", ["cone", "punch", "circle"])
def test_any_body_has_its_integral(kind: str, shape: str) -> None:
    """A cone g = (π/2) a tan θ, a punch g = 0 up to its edge, a circle g = a artanh(a/R)."""
    profile, height, area = {
        "cone": (Cone(kind="cone", slope=0.2), lambda a: 0.1 * math.pi * a, lambda a: 0.05 * math.pi * a**2),
        "punch": (FlatPunch(kind="flat_punch", radius=RADIUS), lambda a: 0.0 * a, lambda a: 0.0 * a),
        "circle": (
            Circle(kind="circle", radius=RADIUS),
            lambda a: a * np.arctanh(a / RADIUS),
            lambda a: 0.5 * (RADIUS * a - (RADIUS**2 - a**2) * np.arctanh(a / RADIUS)),
        ),
    }[shape]
    body = Body.of(profile, DEPTH)
    branch, a = LAWS[kind].branch(body, MODULUS, WORK, 0.0), body.edges[1:]
    a = a[a < 0.9 * RADIUS] if shape == "circle" else a
    d = height(a) - (np.sqrt(2.0 * math.pi * a * WORK / MODULUS) if kind == "JKR" else 0.0)
    size = 2.0 * MODULUS * a[-1] * np.abs(d).max()
    assert branch.displacements[1 : 1 + a.size] == pytest.approx(d, rel=1e-6, abs=0.0)
    assert branch.forces[1 : 1 + a.size] == pytest.approx(2.0 * MODULUS * (a * d - area(a)), abs=2e-4 * size)
    assert float(profile.transformed(a[-1:])[0]) >= 8.0 * DEPTH or body.edges[-1] == pytest.approx(profile.reach)


RUNS = [np.array([0, 1, 2, 5, 6, 7, 8, 12]), np.arange(20, 32)]
"""Indices of points, some of which were left out."""


@pytest.mark.parametrize(("share", "memory"), [(0.0, 1.0), (0.4, 3.0), (1.0, 3.0), (0.9, 0.7)])
def test_whitening_makes_the_covariance_of_a_noise_unity(share: float, memory: float) -> None:
    """V = (1 − s) I + s exp(−|i − j|/τ) of each run: W V Wᵀ = I, log |V| = −2 log |W|."""
    (noise,) = noises([(share, memory)], RUNS)
    V = np.zeros((20, 20))
    for run, part in zip(RUNS, (slice(0, 8), slice(8, 20)), strict=True):
        V[part, part] = share * np.exp(-np.abs(run[:, None] - run) / memory) + (1.0 - share) * np.eye(run.size)
    W = noise.whitened(np.eye(20))
    assert W @ V @ W.T == pytest.approx(np.eye(20), abs=ROUND_OFF)
    assert noise.log_determinant == pytest.approx(np.linalg.slogdet(V)[1], abs=ROUND_OFF)


def test_a_line_in_white_noise_has_the_interval_of_student() -> None:
    """Two parameters of 12 points, nothing known: least squares, s² (JᵀJ)⁻¹ and t with 10 degrees of freedom."""
    slopes = np.column_stack([np.ones(12), np.arange(12.0)])
    residuals = np.tile([1.0, -1.2, 0.4], 4) + 0.3 * np.arange(12.0)
    found = averaged([np.arange(12)], residuals, slopes, np.zeros((0, 3)), looks=1)
    white = next(one for one in found.estimates if one.noise.share == 0.0)
    step, (squares,), *_ = np.linalg.lstsq(slopes, residuals)
    assert white.step == pytest.approx(step, rel=ROUND_OFF)
    assert white.deviation == pytest.approx(math.sqrt(squares / 10.0), rel=1e-4)
    assert white.covariance == pytest.approx(squares / 10.0 * np.linalg.inv(slopes.T @ slopes), rel=1e-4)
    assert found.freedom == 10.0
    assert sum(one.weight for one in found.estimates) == pytest.approx(1.0)
    for level in (0.025, 0.5, 0.9, 0.975):
        at = found.quantile(1, level)
        by = [
            one.weight * student.cdf((at - one.step[1] + found.best.step[1]) / math.sqrt(one.covariance[1, 1]), 10.0)
            for one in found.estimates
        ]
        assert sum(by) == pytest.approx(level, abs=1e-5)


def test_what_is_known_counts_as_a_further_point() -> None:
    """A parameter known to ± 1 and measured to ± 1 is their mean, known to ± 1/√2."""
    residuals = np.tile([1.0, -1.0], 2000) + 3.0
    slopes, prior = np.full((4000, 1), 1.0 / math.sqrt(4000.0)), np.array([[1.0, 0.0]])
    found = averaged([np.arange(4000)], residuals, math.sqrt(4000.0) * slopes, prior, looks=1)
    white = next(one for one in found.estimates if one.noise.share == 0.0)
    weight = 4000.0 / white.deviation**2
    assert white.step[0] == pytest.approx(3.0 * weight / (weight + 1.0), rel=1e-6)
    assert white.covariance[0, 0] == pytest.approx(1.0 / (weight + 1.0), rel=1e-6)
    assert found.freedom == 4000.0


def test_what_is_known_of_one_parameter_moves_the_other_that_is_tied_to_it() -> None:
    """Only their sum is measured, to be 5 with next to no doubt; the second is known to be 2 ± 1."""
    slopes, prior = np.ones((100, 2)), np.array([[0.0, 1.0, 2.0]])
    residuals = 5.0 + 1e-6 * np.random.default_rng(1).standard_normal(100)
    found = averaged([np.arange(100)], residuals, slopes, prior, looks=1)
    white = next(one for one in found.estimates if one.noise.share == 0.0)
    assert white.step == pytest.approx([3.0, 2.0], rel=1e-5)
    assert np.sqrt(np.diag(white.covariance)) == pytest.approx(1.0, rel=1e-5)
    assert found.freedom == 99.0


@pytest.mark.parametrize("memory", [0.0, 8.0])
def test_the_noise_of_a_series_is_found(memory: float) -> None:
    draw = np.random.default_rng(4)
    drawn, kept = draw.standard_normal(800), math.exp(-1.0 / memory) if memory else 0.0
    for i in range(1, 800):
        drawn[i] = kept * drawn[i - 1] + math.sqrt(1.0 - kept**2) * drawn[i]
    found = averaged([np.arange(400), np.arange(400, 800)], 2.0 * drawn, np.ones((800, 1)), np.zeros((0, 2)), looks=2)
    weights = np.array([one.weight for one in found.estimates])
    deviation = weights @ [one.deviation for one in found.estimates]
    share, length = (weights @ [getattr(one.noise, name) for one in found.estimates] for name in ("share", "memory"))
    assert deviation == pytest.approx(2.0, rel=0.25 if memory else 0.1)
    if memory:
        assert share > 0.9
        assert length == pytest.approx(memory, rel=0.4)
    else:
        assert share < 0.2


def forces(*jump: float) -> ForceCurve:
    """Approach and retraction of 60 points each, with noise of 0.1, and a jump of these steps in both."""
    draw = np.random.default_rng(8)
    fall = np.concatenate([np.zeros(30), -np.cumsum(jump), np.full(30 - len(jump), -sum(jump))])
    z = np.concatenate([np.arange(60.0), 59.0 - np.arange(60.0)])
    F = 5.0 + np.concatenate([fall, fall[::-1]]) + 0.1 * draw.uniform(-1.0, 1.0, 120)
    return ForceCurve(z, F, 60, np.arange(120) + 2)


@pytest.mark.parametrize("jump", [(4.0,), (2.0, 2.5), (1.0, 2.5, 0.9)])
def test_a_jump_has_its_steps_and_what_is_beside_it_is_left_out(jump: tuple[float, ...]) -> None:
    curve = forces(*jump)
    approach, retraction = curve.segments
    many = len(jump)
    assert approach.jump == (29, 29 + many)
    assert retraction.jump == (30 - many, 30)
    assert approach.held.tolist() == list(range(29 + many, 60))
    assert approach.apart.tolist() == list(range(30))
    assert retraction.held.tolist() == list(range(60, 91 - many))
    assert retraction.apart.tolist() == list(range(90, 120))
    left = set(range(60)) - set(approach.compared.tolist())
    assert left == set(range(30 - BESIDE_JUMP, 29 + many + BESIDE_JUMP))
    assert curve.baseline == pytest.approx(5.0, abs=0.05)
    assert curve.depth == 59.0


def test_without_a_jump_all_is_compared_and_nothing_known_to_hold() -> None:
    curve = forces(0.0)
    for one in curve.segments:
        assert one.jump is None
        assert one.compared.tolist() == one.points.tolist()
        assert not one.held.size
        assert not one.apart.size
    rising = ForceCurve(curve.positions, np.linspace(0.0, 119.0, 120), 60, curve.lines)
    assert rising.baseline == pytest.approx(5.5)  # the first fifth of the approach
