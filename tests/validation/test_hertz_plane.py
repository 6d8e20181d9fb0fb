"""Claim: on the rigid plane the force is the exact sum over the particles, and goes to the closed form as spacing².

Reference. Without neighbour springs every particle is a one-sided spring: F = Σ_i k max(0, d − x_i²/2R). Its limit
for a fixed layer c_n = k/s is F_c = (4√2/3) c_n √R d^{3/2} = (2/3) c_n a³/R, a = √(2Rd) (Eqs. 1–3 of the paper).

The rate (derived here). The sum is s Σ g(x_i), x_i = (i + θ)s, of g(x) = (c_n/2R)(a² − x²) cut at ±a: smooth but for a
kink at either edge. By Poisson's sum formula its error is Σ_{m≠0} ĝ(2πm/s) exp(2πimθ) with
ĝ(ω) = (2c_n/R)(sin(ωa)/ω³ − a cos(ωa)/ω²), and the Fourier series of the Bernoulli polynomials B₂(t) = t² − t + 1/6,
B₃(t) = t³ − 3t²/2 + t/2 add it up:

    F/F_c − 1 = −(3/2) (s/a)² B₂(t) + (1/2) (s/a)³ B₃(t),    t = a/s − θ modulo 1,  for θ = 0 or 1/2.

That is exact. The error depends on where the edge lies between two particles: −1/4 … +1/8 of (s/a)² (the envelope),
0 + O(s³) on average over offsets, and √(∫B₂²) = 1/√180: a root mean square of (3/2)/√180 (s/a)². So the rate is 2.

Nothing has to come to rest, so that round-off limits the tolerance.
With neighbour springs the plane is a penalty, 1/tolerance stiffer than the chain; the reference is the exact active-set
solution of `validation.references.rigid_plane`.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import run
from tests.scenes import chains
from validation.references.hertz import hertz_contact_radius, hertz_force
from validation.references.model import ChainModel
from validation.references.solver import trace

Array = NDArray[np.float64]

CLOSED_FORM = 1e-9
"""Of F/F_c − 1, absolute: round-off again. Measured 2e-12."""
RATE = 0.01
"""Of the exponent; measured 1e-3: a itself changes by up to 6 % over a period."""
SPREAD = 5e-3
"""Relative, of the constant (3/2)/√180; measured 1e-3: OFFSETS points of a period with two kinks."""
OFFSETS = 64
PENALTY = 1e-3
"""Relative: the tolerance of the scene, and the plane's softness over the chain's. Measured 2e-6 for forces."""
STIFFNESS = 0.5


def on_plane(
    radius: float,
    spacing: float,
    stiffness: float,
    displacements: Array,
    neighbours: float = 0.0,
) -> tuple[Array, Array, Array]:
    """Of one chain on the plane at these displacements [LU]: forces, places, and the pressures of the last state."""
    bodies = {"spacing": spacing, "lower": "rigid_plane", "reduction": "geike_popov"}
    path = {"kind": "path", "displacements": displacements.tolist()}
    scene = chains(radius, stiffness, bodies=bodies, interaction=None, experiment=path)
    if neighbours:
        scene["neighbours"] = {"stiffness": neighbours}
    done = run(scene)
    return done.curve.force, done.profiles["final"].x, done.profiles["final"].pressure


def test_convergence_towards_the_closed_form() -> None:
    """c_n and R fixed; at each spacing the displacements move the edge through one spacing."""
    radius, layer, edge = 1000.0, 0.5, 64.0
    spacings = np.array([4.0, 2.0, 1.0, 0.5])
    spread = []
    for spacing in spacings:
        edges = edge + spacing * ((np.arange(OFFSETS) + 0.5) / OFFSETS - 0.5)
        displacements = edges**2 / (2.0 * radius)
        forces, places, _ = on_plane(radius, float(spacing), layer * float(spacing), displacements)
        closed = hertz_force(displacements, 0.5 * radius, 2.0 * layer)
        error = forces / closed - 1.0
        half_width = 2.0 * hertz_contact_radius(displacements, 0.5 * radius)
        first = float(places[0]) / float(spacing)
        assert error == pytest.approx(bernoulli_error(half_width / spacing, first), abs=CLOSED_FORM)
        assert np.all(error * (half_width / spacing) ** 2 > -0.25 - RATE)
        assert np.all(error * (half_width / spacing) ** 2 < 0.125 + RATE)
        spread.append(float(np.sqrt(np.mean(error**2))))
    rate = float(np.polyfit(np.log(spacings), np.log(spread), 1)[0])
    assert rate == pytest.approx(2.0, abs=RATE)
    constant = spread[-1] * (edge / 0.5) ** 2
    assert constant == pytest.approx(1.5 / np.sqrt(180.0), rel=SPREAD)


def bernoulli_error(ratio: Array, offset: float) -> Array:
    """F/F_c − 1 of the module's docstring; `ratio` a/s, `offset` θ (0 or 1/2 modulo 1)."""
    t = np.mod(ratio - offset, 1.0)
    return -1.5 * (t**2 - t + 1.0 / 6.0) / ratio**2 + 0.5 * (t**3 - 1.5 * t**2 + 0.5 * t) / ratio**3


def test_neighbour_springs() -> None:
    """Down, deeper, and back: the contact has no memory, in the program as in the reference."""
    displacements, neighbours = np.array([0.1, 0.5, 2.0, 0.3]), 3.0
    forces, places, pressure = on_plane(1000.0, 1.0, STIFFNESS, displacements, neighbours)
    model = ChainModel(places.size, STIFFNESS, radius=1000.0, neighbour_stiffness=neighbours, rigid_plane=True)
    exact = trace(model, displacements)
    assert forces == pytest.approx([state.force for state in exact], rel=PENALTY)
    reaction = exact[-1].pair_force[:, 1]
    assert pressure == pytest.approx(reaction, abs=PENALTY * float(reaction.max()))
