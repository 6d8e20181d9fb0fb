"""A closed form beside a run: when it applies, and what it says of the results by their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.material import SPHERES
from contact1d.workflow.units import Quantity

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Case:
    """A finished run, as a closed form sees it; all in model units.

    Attributes:
        scene: what ran.
        quantities: what it found, of the body, by name.
    """

    scene: Scene
    quantities: Mapping[str, Quantity]

    @property
    def contact_modulus(self) -> float:
        """E* [FU/LU²] of the body: that of the layer, c = k/χh, with the MDR; 2c with the paper's reduction."""
        layer = self.scene.bulk_stiffness / (self.scene.chains * self.scene.bodies.spacing)
        return layer if self.scene.bodies.reduction == "mdr" else 2.0 * layer

    @property
    def radius(self) -> float | None:
        """Effective R [LU] of a sphere on a plane, or of the paper's two equal spheres, R/2; None for no sphere."""
        curvature = self.scene.bodies.profile.curvature_radius
        if curvature is None or self.scene.bodies.reduction == "mdr":
            return curvature
        return 0.5 * curvature if self.scene.bodies.profile.kind in SPHERES else None

    @property
    def force(self) -> float | None:
        """F [FU] of the state that is reported, where the scene gives it; else None."""
        return float(self.quantities["force"]) if "force" in self.quantities else None

    @property
    def displacement(self) -> float | None:
        """d [LU] of the state that is reported, where the scene gives it (the deepest of a path); else None."""
        places = self.scene.experiment.places()
        return max(places) if places and self.force is None else None

    @property
    def is_elastic(self) -> bool:
        """Whether springs under the profile are all there is: no attraction, no neighbour springs, no noise."""
        scene = self.scene
        return not (scene.adheres or scene.neighbours or scene.noise)


@dataclass(frozen=True)
class ClosedForm:
    """One theory.

    Attributes:
        name: what it is called: "Hertz".
        source: where it is written down.
        applies: why it holds for a case, in a few words; "" where it does not.
        values: what it says, by the names of results, in their model units; of those the run's are compared.
        pressure: p(r) [FU/LU²] at r [LU] in the reported state, where it says that.
    """

    name: str
    source: str
    applies: Callable[[Case], str]
    values: Callable[[Case], Mapping[str, float]]
    pressure: Callable[[Case, Array], Array] | None = None
