"""A measured state of a contact, and its contact radius.

Displacements d [LU] are those of the plate towards the other body, forces F [FU] positive in compression.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.scene import Scene


def radius_rule(scene: Scene, tolerance: float) -> RadiusRule:
    """Return the definition of the contact radius for a scene, an object that reads the radius off a pressure profile.

    The contact law and the profile choose it: the half-width of a body with a vertical edge; of bodies that attract
    each other the radius of the largest tension, for opposite chains, or the edge at which the line load jumps or that
    the law computes; else that of the compressed particles. `tolerance`: relative, of the main results; its calibrated
    share of the largest pressure counts as 0.
    """
    return law_of(scene).rule(scene)(scene.bodies, CALIBRATION.residual * tolerance)


@dataclass(frozen=True)
class State:
    """One state of a contact, measured in LAMMPS or made by the reduced model.

    Attributes:
        phase: name of its phase, "unloading_2" for instance.
        displacement: of the plate towards the other body [LU]; 0: the undeformed bodies touch, or are at r₀.
        force: of the contact on the plate, compression positive [FU]: the sum over the upper particles.
        profile: pressure and shear along x, (n,) [FU/LU].
        rule: reads the contact radius off the profile.
        smallest_distance: between particles of opposite bodies, or of a particle from the plane [LU].
        depth: how far an upper particle lies below the lower surface [LU]; 0 where none does.
        residual: largest unbalanced force of a particle along a direction in which it may move [FU].
        plate_x: position of the plate along x [LU], relative to that in system.data.
        step: number of the LAMMPS timestep at its end.
        pushed: force of other effects that presses the upper body onto the lower one [FU].
        plate_velocity: of the approach [LU/TU], negative while the bodies separate; 0 where its position is prescribed.
        cantilever_force: force of the cantilever on the plate along x [FU], positive towards +x; 0 without one.
        missing: force that LAMMPS adds up on the plate beyond those that are known [FU]; None: not available.
        time: of a history [TU]; 0 for an equilibrium.
        motion: of a slide, the quantities of `contact.MOTION` and `contact.HEAT` by name, in the units that stand
            there.
        number: of its load step, over all phases, from 0 on.
    """

    phase: str
    displacement: float
    force: float
    profile: Profile
    rule: RadiusRule = field(repr=False, compare=False)
    smallest_distance: float
    depth: float
    residual: float
    plate_x: float
    step: float
    pushed: float = 0.0
    plate_velocity: float = 0.0
    cantilever_force: float = 0.0
    missing: float | None = None
    time: float = 0.0
    motion: Mapping[str, float] = field(default_factory=dict, compare=False)
    number: int = field(default=0, compare=False)

    @property
    def carried(self) -> float:
        """The external load in equilibrium with the state [FU], compression positive: `force` − `pushed`.

        `pushed` is the force of other effects that presses the bodies together. Of a state in motion, inertia and drag
        are missing.
        """
        return self.force - self.pushed

    @cached_property
    def radius(self) -> ContactRadius | None:
        """The contact radius with its edges and uncertainty [LU], cached; None where the bodies do not touch.

        That is, without a compressed particle or, where bodies attract each other, without any tension or any force, by
        the definition of the radius.

        Raises:
            ValueError: the profile has fewer than 3 particles, or tensions where a radius of compressed particles
                is read.
        """
        return self.rule.of(self.profile)

    @property
    def radius_or_spot(self) -> ContactRadius:
        """The contact radius with its edges and uncertainty [LU]; where bodies do not touch, 0 ± 1.5 spacings.

        Raises:
            ValueError: the profile has fewer than 3 particles, or tensions where a radius of compressed particles
                is read.
        """
        return self.radius or self.rule.or_spot(self.profile)
