"""Geometry: positions of particles and anchors at displacement 0.

Particle i is at x_i = (i − (N−1)/2)·spacing; the lower body at z = 0, the upper one at z = rest + h(x). In LAMMPS
the paper's z is z and the plane of motion is y = const: y = 0 for the lower body, y = ε for the upper one (see
`potentials.table`).

An anchor is the bulk's end of a particle's spring. Neighbour springs of zero rest length, k_n (p_{i+1} − p_i), pull a
chain's ends inward and a curved chain straight. Their force on the undeformed chain, r_i = k_n Σ_j (p_j − p_i) over the
neighbours j of i, is cancelled exactly by moving each anchor by −r_i/k, k the stiffness of the bulk spring: since that
is linear and of zero rest length too, it is a constant force −r_i on particle i, and Σ r_i = 0 leaves the plate's force
unchanged. The deck moves the anchors, so that k_n and k stand in in.lammps alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.model.settings import STAGGER_SHARE, Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """One body: positions [LU], shape (N, 3), columns x, y (out of plane), z.

    Attributes:
        name: "lower" or "upper".
        particles: undeformed positions at displacement 0, shape (N, 3).
        anchors: the bulk's ends of the bulk springs, shape (N, 3), or (0, 3) where particles are fixed in the body.
        moves: −r_i/k_n of the anchors, shape (N, 3); 0 without springs between neighbours.
        ratio: k_n/k, by which the deck multiplies these moves.
        far_anchors: the bulk's ends of long bonds, which make springs stiffer along x or z, shape (N, 3), or (0, 3).
    """

    name: str
    particles: Array
    anchors: Array
    far_anchors: Array
    moves: Array
    ratio: float = 0.0

    @property
    def corners(self) -> Array:
        """The ends of all its atoms along each axis once the deck has moved its anchors, (2, 3) [LU]."""
        atoms = np.concatenate([self.particles, self.anchors, self.anchors + self.ratio * self.moves, self.far_anchors])
        return np.stack([atoms.min(axis=0), atoms.max(axis=0)])


def particle_positions(count: int, spacing: float) -> Array:
    """Return the positions of N = `count` particles along x, x_i = (i − (N−1)/2)·spacing [LU], i from 0, (count,)."""
    return np.asarray((np.arange(count) - 0.5 * (count - 1)) * spacing, dtype=np.float64)


def moves_of(particles: Array) -> Array:
    """Return −r_i/k_n = −Σ_j (p_j − p_i) over the neighbours j of i of a chain of `particles`, (N, 3) [LU].

    The chain is open: its two ends are no neighbours. The sum of the moves is 0.
    """
    return np.diff(np.diff(particles, axis=0), axis=0, prepend=0.0, append=0.0) * -1.0


def bodies(scene: Scene, settings: Settings) -> tuple[Body, ...]:
    """Return the bodies of a scene at displacement 0, (lower, upper); on a rigid plane (upper,) alone.

    Each has the positions of its particles, (N, 3) [LU], of the anchors of their springs, which a rigid chain and a
    body with fixed particles lack, (0, 3), and of far anchors where springs have another stiffness along x than along
    z, else (0, 3). The upper apex is at z = settings.forces.rest, the lower body at z = 0; y is 0, of the upper body
    with an interaction a small offset, and what moves with a plate is shifted along y by 5e-4 of the chain's length,
    with alternating sign. Positions of a periodic upper body are in one period around 0.
    """
    x = particle_positions(settings.chains.upper, scene.bodies.own_spacing)
    flat = np.zeros_like(x)
    offset = settings.forces.table.plane_offset if settings.forces.table else 0.0
    along = x + start_offset(scene, settings)
    if scene.bodies.periodic:
        half = 0.5 * period(scene, settings)
        along = (along + half) % (2.0 * half) - half
    upper = np.column_stack([along, flat + offset, settings.forces.rest + scene.bodies.height(x)])
    if scene.bodies.lower == "rigid_plane":
        return (_body("upper", upper, scene, settings),)
    none = upper[:0]
    below = particle_positions(settings.chains.lower, scene.bodies.spacing)
    lower = np.column_stack([below, 0.0 * below, 0.0 * below])
    if scene.bodies.lower == "rigid_chain":
        return Body("lower", lower, none, none, none), _body("upper", upper, scene, settings)
    return _body("lower", lower, scene, settings), _body("upper", upper, scene, settings)


def period(scene: Scene, settings: Settings) -> float:
    """Return the length of the lower chain along x [LU], particles times spacing: the period of periodic bodies."""
    return settings.chains.lower * scene.bodies.spacing


def start_offset(scene: Scene, settings: Settings) -> float:
    """Return the position of the upper body's middle along x [LU]: as given, else 0.

    In a slide on a lower chain, without a given one, it is within half a spacing of 0, of either sign, so that
    particles begin between those of the chain: on top of them the equilibrium is unstable.
    """
    bodies = scene.bodies
    if bodies.upper_offset is not None:
        return bodies.upper_offset
    if not scene.experiment.motion_is_result or bodies.lower == "rigid_plane":
        return 0.0
    first = 0.5 * (settings.chains.lower - 1) * bodies.spacing - 0.5 * (settings.chains.upper - 1) * bodies.own_spacing
    phase = first / bodies.spacing - math.floor(first / bodies.spacing)
    return bodies.spacing * (0.5 - phase)


def _body(name: str, particles: Array, scene: Scene, settings: Settings) -> Body:
    """Return a body with anchors at its particles, and their moves against forces of neighbour springs.

    These are 0 in a periodic body, and along x without [horizontal]. No anchors, (0, 3), where particles are fixed in
    the body. Far anchors are there only where particles may move along x and springs have another stiffness along x
    than along z: settings.chains.far [LU] from the particles, along −x where the tangential stiffness is the larger,
    else along z away from the other body. With a plate the upper atoms that move with it, anchors or fixed particles,
    are also shifted along y.

    `particles`: positions, (N, 3) [LU].
    """
    none = np.empty((0, 3))
    if scene.stands:
        return Body(name, particles + _staggered(particles, scene), none, none, none)
    tangential = scene.tangential_stiffness
    softer = min(settings.forces.bulk_stiffness, tangential) if settings.chains.far else settings.forces.bulk_stiffness
    moves, ratio = np.zeros_like(particles), 0.0
    if scene.neighbours and not scene.bodies.periodic:
        moves, ratio = moves_of(particles), scene.neighbours.stiffness / softer
        if not scene.horizontal:
            moves[:, 0] = 0.0
    anchors = particles + _staggered(particles, scene) if name == "upper" else particles
    if settings.chains.far == 0.0:
        return Body(name, particles, anchors, none, moves, ratio)
    away = np.zeros(3)
    if tangential > settings.forces.bulk_stiffness:
        away[0] = -settings.chains.far
    else:
        away[2] = settings.chains.far if name == "upper" else -settings.chains.far
    return Body(name, particles, anchors, particles + away, moves, ratio)


def _staggered(particles: Array, scene: Scene) -> Array:
    """Return the shift of a plate's atoms along y, out of the plane of motion, (N, 3) [LU]; 0 without a plate.

    Its magnitude is 5e-4 of the chain's length, N spacings, with + for the first atom and alternating sign.

    `particles`: of which N is the number, (N, 3).
    """
    shift = np.zeros_like(particles)
    if scene.plate:
        shift[:, 1] = STAGGER_SHARE * len(particles) * scene.bodies.own_spacing * (-1.0) ** np.arange(len(particles))
    return shift
