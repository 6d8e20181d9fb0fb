"""Claim: with [noise] every free coordinate of a deck has its thermal variance, and a held one does not move at all.

The deck is written, its bodies are moved apart, and LAMMPS itself runs it on.

Reference (equipartition; exact for linear springs). Without neighbour springs ⟨u_z²⟩ = k_BT/k and ⟨u_x²⟩ = k_BT/k_t for
every particle away from the contact, u counted from the particle's place in its bulk, and ⟨v²⟩ = k_BT/m along every
free direction. With them the normal modes of a chain of N particles with free ends, of stiffness k + 4 k_n
sin²(πq/2N) and shape φ_q(i) ∝ cos(πq(i + 1/2)/N), give

    ⟨u_i²⟩ = k_BT Σ_q φ_q(i)² / (k + 4 k_n sin²(πq/2N)),        inside a long chain k_BT / √(k (k + 4 k_n)),
    ⟨u_i u_(i+1)⟩ = k_BT Σ_q φ_q(i) φ_q(i+1) / (k + 4 k_n sin²(πq/2N)).

What limits the tolerance: statistics. Each number must lie within 4 of its own sample's standard errors, from time
blocks long against the relaxation. The integrator's bias, 0.4 (ωΔt)² = the scene's tolerance of 1e-3, is below half a
standard error. Seeds are fixed: a failure is no bad luck.
"""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import read_scene, write_deck
from tests.scenes import chains

Array = NDArray[np.float64]

LMP = Path(sys.executable).with_name("lmp")
SIGMAS = 4.0
"""Standard errors: one test in 16 000 would fail by chance, and the seeds are fixed."""
LARGEST_ERROR = 0.02
"""Relative standard error that a sample must reach: a test that could not tell 10 % is none. Measured: 0.3–1.7 %."""
INTEGRATOR = 1e-3
"""Relative bias of a variance: the tolerance of the scene, from which the time step follows."""
TEMPERATURE, STIFFNESS, TANGENTIAL, MASS, DAMPING = 0.01, 0.83, 0.5, 1.0, 1.5
PARTICLES, BLOCKS = 100, 20
RUN_ON = """
displace_atoms upper_body move 0.0 0.0 30.0 units box
variable every equal "floor(1.5/v_time_step)"
group kept union particles plate
dump taken kept custom ${every} taken.txt x y z vx vy vz
dump_modify taken sort id first yes format float %.12g
run $(820*v_every)
"""
"""Behind the head of a deck: far beyond the cutoff, a state each 1.5 TU, which is 0.8 of the time γ/k of u."""
SETTLED = 21
"""States before the 800 that are taken, the places in the bulk first."""


@dataclass(frozen=True)
class Sample:
    """Displacements from the places in the bulk and velocities; shape (samples, 2 bodies × N, 3) [LU], [LU/TU].

    `plate`: its velocity along z, shape (samples,).
    """

    displacement: Array
    velocity: Array
    plate: Array


def sample(folder: Path, neighbours: float = 0.0, **tables: Any) -> Sample:
    scene = chains(
        1000.0,
        STIFFNESS,
        bodies={"particles": PARTICLES, "mass": MASS} | tables.pop("bodies", {}),
        damping={"coefficient": DAMPING},
        noise={"temperature": TEMPERATURE, "seed": 20},
        plate={},
        neighbours={"stiffness": neighbours} if neighbours else None,
        experiment={"kind": "load", "method": "dynamic", "force": 0.0},
        **tables,
    )
    write_deck(read_scene(scene), folder)
    head = (folder / "in.lammps").read_text(encoding="utf-8").partition("# phase settling")[0]
    (folder / "on.lammps").write_text(head + RUN_ON, encoding="utf-8")
    subprocess.run(
        [LMP, "-in", "on.lammps", "-log", "none"],
        cwd=folder, check=True, capture_output=True, env=os.environ | {"UCX_TLS": "self"},
    )  # fmt: skip
    lines = (folder / "taken.txt").read_text(encoding="utf-8").splitlines()
    atoms, header, count = int(lines[3]), 9, 2 * PARTICLES
    rows = [line for i, line in enumerate(lines) if i % (atoms + header) >= header]
    states = np.loadtxt(rows).reshape(-1, atoms, 6)
    moved = states[SETTLED:, :, :3] - states[0, :, :3]
    moved[:, PARTICLES:count, 2] -= moved[:, count, None, 2]  # with the plate, which is free
    return Sample(moved[:, :count], states[SETTLED:, :count, 3:], states[SETTLED:, count, 5])


def check(products: Array, expected: float, largest_error: float = LARGEST_ERROR) -> None:
    """The mean of `products` (samples, particles) is `expected` within SIGMAS standard errors from time blocks."""
    means = np.array([block.mean() for block in np.split(products, BLOCKS)])
    error = float(means.std(ddof=1) / np.sqrt(BLOCKS))
    assert error < largest_error * expected
    assert abs(float(products.mean()) - expected) < SIGMAS * error + INTEGRATOR * expected


def modes(neighbours: float) -> tuple[Array, Array]:
    """Stiffness of each normal mode of a chain with free ends, and its shape φ_q(i), columns q, of unit length."""
    q = np.arange(PARTICLES)
    shape = np.cos(np.pi * q[None, :] * (np.arange(PARTICLES)[:, None] + 0.5) / PARTICLES)
    shape /= np.sqrt((shape**2).sum(axis=0))
    return STIFFNESS + 4.0 * neighbours * np.sin(np.pi * q / (2 * PARTICLES)) ** 2, shape


def test_chains_with_neighbour_springs_have_the_variances_of_their_modes_and_stay_in_line(tmp_path: Path) -> None:
    """The ends move further than the rest."""
    neighbours = 0.3
    taken = sample(tmp_path / "deck", neighbours)
    stiffness, shape = modes(neighbours)
    z = taken.displacement[:, :, 2]
    exact = TEMPERATURE * (shape**2 / stiffness).sum(axis=1)
    middle = slice(20, PARTICLES - 20)
    check(z[:, middle] ** 2, float(exact[middle].mean()))
    assert exact[PARTICLES // 2] == pytest.approx(TEMPERATURE / np.sqrt(STIFFNESS * (STIFFNESS + 4.0 * neighbours)))
    for body in (slice(PARTICLES), slice(PARTICLES, None)):
        check(z[:, body] ** 2, float(exact.mean()))
    beside = TEMPERATURE * (shape[:-1] * shape[1:] / stiffness).sum(axis=1)
    bodies = z.reshape(-1, 2, PARTICLES)
    check(bodies[..., :-1] * bodies[..., 1:], float(beside.mean()))
    check(bodies[..., [0, -1]] ** 2, float(exact[0]), largest_error=0.1)  # of four particles
    for energy, mode in zip(stiffness, shape.T, strict=True):
        check((bodies @ mode) ** 2 * energy, TEMPERATURE, largest_error=0.2)  # of one number a body
    check(taken.velocity[:, :, 2] ** 2, TEMPERATURE / MASS)
    check(taken.plate**2, TEMPERATURE / (PARTICLES * MASS), largest_error=0.2)
    assert not taken.displacement[..., :2].any()
    assert not taken.velocity[..., :2].any()


def test_both_directions_have_their_own_stiffness_and_nothing_leaves_the_plane(tmp_path: Path) -> None:
    taken = sample(tmp_path / "deck", bodies={"bulk_stiffness_tangential": TANGENTIAL}, horizontal={})
    x, y, z = np.moveaxis(taken.displacement, -1, 0)
    check(x**2, TEMPERATURE / TANGENTIAL)
    check(z**2, TEMPERATURE / STIFFNESS)
    check(taken.velocity[:, :, 0] ** 2, TEMPERATURE / MASS)
    assert abs((x * z).mean()) < SIGMAS * (x * z).std() / np.sqrt(x.size)
    assert not y.any()
