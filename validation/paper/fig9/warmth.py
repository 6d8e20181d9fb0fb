"""One particle on a rigid row over the temperature, beside Smoluchowski's equation."""

from __future__ import annotations

import math

import numpy as np

from validation.doors import Scene, Slide, settings_for
from validation.figures import Panel, Series
from validation.paper.fig9.asperity import series_stiffness, wells_of
from validation.paper.fig9.sweeps import TEMPERATURE, slides
from validation.references.prandtl_tomlinson import slow_friction
from validation.references.thermal_friction import free_corrugation, thermal_friction
from validation.row import Row, absolute, solver
from validation.slides import law_of
from validation.study import Rows, found

SIGMAS, INTERVAL = 4.0, 1.96
"""Standard errors that a row allows; half-width of a run's interval of 95 % over its standard error."""
DRAGGED = {
    "drag": "the reference has the same drag, against what moves with the drive",
    "energy": "the mean friction is asked for, not the balance of energies",
}


def smoluchowski(scene: Scene, temperature: float) -> float:
    """⟨F⟩ [FU] of the scene at another kT [FU·LU]."""
    settings = settings_for(scene)
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)
    wells = free_corrugation(law_of(scene), scene.bodies.spacing, scene.experiment.normal_force, temperature)
    drag, mass = settings.damping + settings.plate_damping, scene.bodies.mass + settings.plate_mass
    return thermal_friction(*wells, series_stiffness(scene), drag, temperature, scene.cantilever.velocity, mass)


def temperature_checks(row: Rows) -> tuple[list[Row], Panel]:
    """⟨F⟩ at each temperature, and a line of the equation between them."""
    points = slides(TEMPERATURE)
    temperatures = [kT for (kT,) in points.names]
    scene = points.scenes[temperatures[0],]
    cold = wells_of(scene)
    top = cold.largest_force
    barrier = 2.0 * abs(float(cold.coefficients[0]))
    checks = []
    for kT in temperatures:
        ours = found(row.runs[points.names[kT,]], "mean_friction")
        sigma = ours.uncertainty / INTERVAL / top
        checks.append(
            row(
                f"⟨F⟩/F_max of one particle, kT = {kT / barrier:.2g} of the barrier",
                ours.value / top,
                solver(smoluchowski(scene, kT) / top, "Smoluchowski's equation"),
                absolute(
                    SIGMAS * sigma if math.isfinite(sigma) else 0.0, "statistics: four standard errors of the run"
                ),
                uncertainty=ours.uncertainty / top,
                on=[points.names[kT,]],
                despite=DRAGGED,
                wide="four standard errors, and by chance it is near",
            )
        )
    fine = np.linspace(0.6 * temperatures[0], 1.05 * temperatures[-1], 12)
    line = np.asarray([smoluchowski(scene, kT) for kT in fine.tolist()]) / top
    means = [found(row.runs[name], "mean_friction") for name in points.every]
    shown = Series(
        "runs",
        np.asarray(temperatures) / barrier,
        np.asarray([one.value for one in means]) / top,
        np.asarray([one.uncertainty for one in means]) / top,
    )
    none = Series(
        "without heat, for v → 0", np.zeros(1), np.asarray([slow_friction(cold, series_stiffness(scene)) / top])
    )
    theory = Series("Smoluchowski's equation", fine / barrier, line)
    panel = Panel("kT over the barrier between two hollows", r"$\langle F\rangle/F_{max}$", [shown], [theory, none])
    return checks, panel
