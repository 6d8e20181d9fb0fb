"""What the theories of an adhesive sphere say of a contact, and which of them holds: JKR, DMT, Maugis and Dugdale."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from contact1d.analysis.theory.dmt import Dmt
from contact1d.analysis.theory.jkr import Jkr
from contact1d.analysis.theory.maugis_dugdale import MaugisDugdale, maugis_parameter_of_tabor
from contact1d.analysis.theory.tabor import DMT_TABOR, JKR_TABOR, Verdict, tabor_number, valid_theory


@dataclass(frozen=True)
class Theories:
    """One adhesive sphere by every theory, in SI.

    Args:
        radius: effective R [m].
        contact_modulus: E* [Pa].
        work_of_adhesion: W > 0 [J/m²].
        range_of_attraction: z₀ [m].
        load: F [N], positive in compression; None: 0.
    """

    radius: float
    contact_modulus: float
    work_of_adhesion: float
    range_of_attraction: float
    load: float | None = None

    @cached_property
    def tabor(self) -> float:
        """μ = (R W²/(E*² z₀³))^(1/3)."""
        return tabor_number(self.radius, self.contact_modulus, self.work_of_adhesion, self.range_of_attraction)

    @cached_property
    def verdict(self) -> Verdict:
        """Which theory holds under the load, and why."""
        return valid_theory(self.tabor, (self.load or 0.0) / (math.pi * self.work_of_adhesion * self.radius))

    @cached_property
    def values(self) -> Mapping[str, Mapping[str, float]]:
        """By theory, F_A [N], a₀ [m], a where a fixed load pulls off [m], a under the load [m] where one is given."""
        return {"JKR": self._jkr(), "DMT": self._dmt(), "Maugis-Dugdale": self._maugis()}

    def _jkr(self) -> dict[str, float]:
        jkr = Jkr(self.radius, self.contact_modulus, self.work_of_adhesion)
        found = {
            "adhesion_force": jkr.pull_off_force(),
            "zero_load_radius": jkr.zero_load_radius(),
            "critical_radius": jkr.critical_radius(),
        }
        return found if self.load is None else found | {"loaded_radius": float(jkr.contact_radius(self.load))}

    def _dmt(self) -> dict[str, float]:
        dmt = Dmt(self.radius, self.contact_modulus, self.work_of_adhesion)
        found = {
            "adhesion_force": dmt.pull_off_force(),
            "zero_load_radius": dmt.zero_load_radius(),
            "critical_radius": 0.0,
        }
        return found if self.load is None else found | {"loaded_radius": float(dmt.contact_radius(self.load))}

    def _maugis(self) -> dict[str, float]:
        contact = MaugisDugdale(maugis_parameter_of_tabor(self.tabor))
        force = math.pi * self.work_of_adhesion * self.radius
        length = math.cbrt(math.pi * self.work_of_adhesion * self.radius**2 / (4.0 / 3.0 * self.contact_modulus))
        found = {
            "adhesion_force": force * contact.pull_off_load(),
            "zero_load_radius": length * contact.zero_load_radius(),
            "critical_radius": length * contact.critical_radius(),
        }
        return (
            found
            if self.load is None
            else found | {"loaded_radius": length * contact.contact_radius(self.load / force)}
        )

    @property
    def holding(self) -> str:
        """The theory of `values` whose numbers to take: by μ, DMT below 0.1, JKR above 5, else Maugis and Dugdale."""
        if self.tabor < DMT_TABOR:
            return "DMT"
        return "JKR" if self.tabor > JKR_TABOR else "Maugis-Dugdale"

    @property
    def jkr_error(self) -> float:
        """F_A of JKR over that of the theory that holds, less 1."""
        return self.values["JKR"]["adhesion_force"] / self.values[self.holding]["adhesion_force"] - 1.0
