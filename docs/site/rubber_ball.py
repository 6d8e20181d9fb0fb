"""Draw docs/rubber_ball.png, the figure of the first page: a rubber ball that is pulled off glass, and JKR's formulas.

.venv/bin/python docs/site/rubber_ball.py. The formulas are typed here and share no code with the program.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

import contact1d

R, W = 2e-3, 0.08
E = 1.0 / ((1.0 - 0.5**2) / 2e6 + (1.0 - 0.22**2) / 70e9)
"""Radius of the ball [m], work of adhesion [J/m²], effective modulus of rubber and glass [Pa]."""
A_0, A_MIN = (np.cbrt(factor * np.pi * W * R**2 / E) for factor in (4.5, 0.125))
"""Contact radius [m] at zero load, and where a contact under displacement control ends."""


def displacement(a: float) -> float:
    """Return JKR's displacement [m] at a contact radius a [m]."""
    return a**2 / R - np.sqrt(2.0 * np.pi * W * a / E)


def force(d: np.ndarray) -> np.ndarray:
    """Return JKR's force [N] at the displacements d [m], compression positive, shape (n,)."""
    a = np.array([brentq(lambda a, d=d: displacement(a) - d, A_MIN, 10.0 * A_0, xtol=1e-18) for d in d])
    return 4.0 * E * a**3 / (3.0 * R) - np.sqrt(8.0 * np.pi * W * E * a**3)


def pressure(r: np.ndarray, a: float) -> np.ndarray:
    """Return JKR's pressure [Pa] at the distances r < a from the axis, at a contact radius a [m]."""
    root = np.sqrt(a**2 - r**2)
    return 2.0 * E * root / (np.pi * R) - np.sqrt(2.0 * W * E * a / np.pi) / root


def panels(column: np.ndarray, x: np.ndarray, value: np.ndarray, theory: np.ndarray, band: np.ndarray) -> None:
    """Draw values with those of theory above, and below their difference with the ± of the run, which is printed."""
    above, below = column
    above.plot(x, value, "o", ms=4, color="C0", label="contact1d, on LAMMPS")
    above.plot(x, theory, "k-", lw=1, label="JKR")
    above.axhline(0.0, color="0.7", lw=0.6)
    print(f"largest difference over its uncertainty: {np.max(np.abs(value - theory) / band):.2f}")
    below.fill_between(x, -band, band, color="C0", alpha=0.25, lw=0, label="stated uncertainty ±")
    below.plot(x, value - theory, ".", ms=4, color="C0", label="contact1d − JKR")
    below.axhline(0.0, color="k", lw=0.8)


def main() -> None:
    """Run the pull-off and write the figure."""
    run = contact1d.sphere(radius="2 mm", upper="rubber", lower="glass", work_of_adhesion="80 mJ/m²").pull_off()
    curve, table = run.curve, run.tables["pressure_3d"]
    held = np.flatnonzero((curve.branch == "unloading") & (curve.force != 0.0))
    held = held[np.argsort(curve.displacement[held])]
    figure, axes = plt.subplots(
        2, 2, figsize=(9.6, 4.8), height_ratios=(3, 1.2), sharex="col", layout="constrained", dpi=110
    )
    d, F = curve.displacement[held], curve.force[held]
    panels(axes[:, 0], d * 1e6, F * 1e6, force(d) * 1e6, curve.force_uncertainty[held] * 1e6)
    zero = (table.state == "zero_load") & (table.r < 0.985 * A_0)
    r, p = table.r[zero], table.pressure[zero]
    panels(axes[:, 1], r * 1e6, p * 1e-3, pressure(r, A_0) * 1e-3, table.pressure_uncertainty[zero] * 1e-3)
    axes[0, 0].set(ylabel="force F (µN)", title="Pull-off of a rubber ball, R = 2 mm, from glass")
    axes[1, 0].set(xlabel="displacement d (µm)", ylabel="difference (µN)")
    axes[0, 1].set(ylabel="pressure p (kPa)", title="Pressure at zero load")
    axes[1, 1].set(xlabel="distance from the axis r (µm)", ylabel="difference (kPa)")
    axes[0, 0].legend(frameon=False)
    axes[1, 0].set_ylim(-0.5, 1.0)
    axes[1, 0].legend(frameon=False, loc="upper right", ncols=2)
    figure.savefig(Path(__file__).parents[1] / "rubber_ball.png")


if __name__ == "__main__":
    main()
