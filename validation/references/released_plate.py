"""The paper's setup (Fig. 5) with momentum: a plate at rest under F_D, on which a tension T acts from one moment on.

M d'' + c d' + F(d) = -T with d the compression and F(d) the contact's force, particles following at once. In the time
unit sqrt(M/K), K = F'(d_0) at F(d_0) = 0, only the damping ratio zeta = c/(2 sqrt(M K)) is left:
    d'' + 2 zeta d' + (F(d) + T)/K = 0,  d(0) = d_D with F(d_D) = F_D,  d'(0) = 0.
The contact is lost where d passes the unstable place of the same tension. The largest tension that is held is F_A for a
slow plate, and less for one that swings: the more so the larger F_D. Without damping it follows from the energy,
int (F + T) dd = 0 between d_D and the unstable place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

from validation.references.interaction import Floats

LONGEST = 100.0
"""Time that a tension is given [sqrt(M/K)]: just below the limit the plate creeps past the fold."""
POINTS = 400
"""Of the spline of F(d)."""
SHARE = 1e-4
"""Width of the final bracket over F_A."""
STEP_ERROR = 1e-8
"""Of the integration, relative."""


@dataclass(frozen=True)
class ReleasedPlate:
    """A plate on a contact that does not snap.

    Args:
        force: F(d) [FU], compression positive; one minimum within the range.
        low: end of the range where the bodies are apart [LU].
        high: its other end, beyond every preload [LU].
    """

    force: Callable[[float], float]
    low: float
    high: float

    def largest_tension(self, preload: float, damping_ratio: float) -> float:
        """Return the largest tension that is held [FU].

        Args:
            preload: F_D >= 0 [FU], reached within the range.
            damping_ratio: zeta >= 0, 1 for critical damping of small motions about F = 0.
        """
        d = np.linspace(self.low, self.high, POINTS)
        law = CubicSpline(d, [self.force(float(x)) for x in d])
        place = float(d[int(np.argmin(law(d)))])
        around = (place - d[1] + d[0], place + d[1] - d[0])
        fold = float(minimize_scalar(law, bounds=around, method="bounded", options={"xatol": 1e-12}).x)
        limit = -float(law(fold))
        zero = float(brentq(law, fold, self.high))
        start = float(brentq(lambda x: law(x) - preload, zero - 1e-12, self.high))
        stiffness = float(law(zero, 1))

        def lost(tension: float) -> bool:
            edge = float(brentq(lambda x: law(x) + tension, self.low, fold))  # the unstable place of this tension

            def apart(_: float, state: Floats) -> float:
                return float(state[0] - edge)

            def slope(_: float, state: Floats) -> list[float]:
                return [state[1], -2.0 * damping_ratio * state[1] - (float(law(state[0])) + tension) / stiffness]

            apart.terminal = True  # type: ignore[attr-defined]  # scipy reads it off the function
            found = solve_ivp(
                slope, (0.0, LONGEST), [start, 0.0], method="LSODA", events=apart, rtol=STEP_ERROR, atol=STEP_ERROR
            )
            return bool(found.status == 1)

        held, broken = 1e-3 * limit, limit * (1.0 - 1e-9)
        if not lost(broken):
            return limit
        while broken - held > SHARE * limit:
            middle = 0.5 * (held + broken)
            held, broken = (held, middle) if lost(middle) else (middle, broken)
        return 0.5 * (held + broken)
