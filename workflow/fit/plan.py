"""A fit file: data, parameters, instrument and a base scene; checked as a scene is, every problem at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Gt
from pydantic import Field, ValidationError

from contact1d.workflow.scene import Problem, Scene, SceneError, read_scene, read_tables
from contact1d.workflow.scene.check import mend_words, report_faults
from contact1d.workflow.scene.conversion import convert
from contact1d.workflow.scene.file_kinds import require_kind
from contact1d.workflow.scene.problems import shown
from contact1d.workflow.scene.quantities import POSITIVE, Listed, Place, Table, Unit, allowed_by
from contact1d.workflow.scene.read import plain_data
from contact1d.workflow.scene.si_text import in_si
from contact1d.workflow.scene.tables import WHOLE
from contact1d.workflow.scene.uncertain import take_shares

AnyFit = str | PathLike[str] | Mapping[str, Any]
"""What `read_fit` makes a plan of."""
STIFFNESS = "instrument.stiffness"
BODIES = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane"}
"""Defaults of the bodies of a base scene."""
LOAD = {"kind": "load", "force": "1 nN"}
"""The experiment of a base scene, which gives none."""
HISTORY = {"kind": "history", "displacement": [["0 s", "0 nm"], ["1 s", "1 nm"]]}
"""The same of a body that relaxes."""


class Instrument(Table):
    """The instrument that presses the bodies together."""

    stiffness: Annotated[float, POSITIVE, Unit("N/m")] | None = None
    """stiffness k_c of the cantilever, with its ± where that is known; absent: rigid, and the data have d"""
    baseline: Literal["auto", "flat", "sloped"] = "auto"
    """whether the force of bodies apart depends on the position; "auto": where the data show it"""


class Fit(Table):
    """The keys of a fit file except its base scene."""

    title: str = "Fit of a force curve"
    """title, one line; absent: that of the base scene"""
    data: str
    """a CSV file with columns z or d, and F; several by a folder or a pattern, or a column `curve`: a map"""
    parameters: Listed[str]
    """dotted keys of the base scene's numbers that are to be found; their values there are first guesses"""
    segment: Literal["approach", "retract", "both", "auto"] = "auto"
    """the segment that is fitted; "both": the data must have both; "auto": what they have"""
    contact_point: Annotated[float, Unit("m")] | Literal["free"] = "free"
    """position z of the contact point, or "free\""""
    reverse: Listed[Literal["z", "d", "F"]] | None = None
    """columns whose sign is opposite: z and d grow towards the sample, F is positive in compression"""
    instrument: Instrument | None = None
    """the instrument; absent: it is rigid, and the data have d"""
    outliers: Annotated[int, Gt(-1)] = Field(default=20)
    """most points that may be left out as outliers"""


@dataclass(frozen=True)
class FitPlan:
    """A fit file with its base scene.

    Attributes:
        fit: the keys of the file except its base scene.
        base: the scene.
        folder: to which the path of the data is relative.
        known: 95 % half-widths over the values of numbers with ±, by dotted key.
    """

    fit: Fit
    base: Scene
    folder: Path
    known: Mapping[str, float]

    @cached_property
    def numbers(self) -> dict[str, Place]:
        """The numbers of the base scene other than 0 by dotted key, each with its value, in SI, and unit; cached.

        Numbers with decimals only: no counts, words or lists.
        """
        tables = Place(self.base.model_dump(by_alias=True, exclude_none=True), WHOLE)
        return {place.path: place for place in tables if place.allowed.quantity and place.is_number}

    def unit(self, key: str) -> str:
        """Return the SI unit of the number at a dotted key of the base scene, as text: "Pa", "J/m²", "1" for none.

        Raises:
            KeyError: the scene has no such number, or it is 0.
        """
        unit = self.numbers[key].unit
        return unit.text[0] if unit.text else in_si(unit.name)

    @property
    def stiffness(self) -> float:
        """The stiffness k_c [N/m] of the instrument; infinite without an instrument, which is then rigid."""
        given = self.fit.instrument.stiffness if self.fit.instrument else None
        return float("inf") if given is None else given

    @property
    def baseline(self) -> Literal["auto", "flat", "sloped"]:
        """Whether the baseline has a slope: "flat", "sloped", or "auto", also without an instrument."""
        return self.fit.instrument.baseline if self.fit.instrument else "auto"


def read_fit(source: AnyFit, **changes: Any) -> FitPlan:
    """Read the plan of a fit file and return it.

    Paths in it are relative to the folder of the file, or to the current one for tables.

    Args:
        source: the path of the file, or its tables, which are not changed.
        changes: keys at the top of the file that replace its own.

    Raises:
        SceneError: with every problem of the file and of its base scene, or that the file cannot be read.
    """
    tables = dict(plain_data(source) if isinstance(source, Mapping) else read_tables(source)) | changes
    require_kind(tables, "fit file", source)
    folder = Path.cwd() if isinstance(source, Mapping) else Path(source).parent
    base = tables.pop("base", None)
    if isinstance(base, Mapping) and "title" in base:
        tables.setdefault("title", base["title"])
    whole = Place(tables, allowed_by(Fit))
    mend_words(whole)
    shares = take_shares(whole)
    convert(whole)
    fit = None
    try:
        fit = Fit.model_validate(tables)
    except ValidationError as error:
        report_faults(whole, error)
    problems = list(whole.problems)
    if not isinstance(base, Mapping):
        must = "missing" if base is None else "must be a table of a scene's tables"
        problems.append(Problem("base", must, hint="write [base.bodies], [base.material] … as in a scene"))
        raise SceneError(problems)
    scene, base_problems = _base(base, folder)
    problems += base_problems
    if fit is not None and scene is not None:
        plan = FitPlan(fit, scene, folder, {**scene.shares, **shares})
        problems += _of_parameters(plan)
        if not problems:
            return plan
    raise SceneError(problems)


def _base(base: Mapping[str, Any], folder: Path) -> tuple[Scene | None, list[Problem]]:
    """Return (base scene with the defaults of a fit, its problems), [] for none.

    Defaults are a rigid plane and automatic spacing, and a load of 1 nN. The scene is None where it cannot be read,
    with all its problems; else the first problem alone is returned: no rigid plane with the MDR, a punch, an effect
    that a fit does not have, or no material in SI. Paths of problems begin with "base.". `folder`: for the file of a
    profile.
    """
    bodies = base.get("bodies", {})
    given = {"title": "fit", "experiment": HISTORY if "viscoelasticity" in base else LOAD, **base}
    given["bodies"] = {**BODIES, **bodies} if isinstance(bodies, Mapping) else bodies
    try:
        scene = read_scene(given, folder=folder)
    except SceneError as error:
        return None, [Problem(f"base.{fault.path}", fault.message, fault.given, fault.hint) for fault in error.problems]
    if scene.bodies.lower != "rigid_plane" or scene.bodies.reduction != "mdr":
        return scene, [Problem("base.bodies.lower", 'must be "rigid_plane", with the reduction "mdr"')]
    if scene.bodies.profile.has_edge:
        return scene, [Problem("base.bodies.profile", "not a punch in a fit, whose contact models have no edge")]
    for name, effect in zip(scene.effects, scene.present, strict=True):
        if not effect.keeps_springs and name != "viscoelasticity":
            return scene, [Problem(f"base.{name}", "not in a fit, whose contact models are of linear springs")]
    if scene.viscoelasticity is not None and not scene.viscoelasticity.terms:
        return scene, [Problem("base.viscoelasticity", "must have terms, whose relaxation a fit can follow")]
    material = scene.material
    if material is None or (material.length_unit, material.force_unit) != (1.0, 1.0):
        hint = (
            'give [base.material] and every number its unit, such as radius = "5 µm", and no length_unit or force_unit'
        )
        return scene, [Problem("base.material", "must be in SI, as measured data are", hint=hint)]
    return scene, []


def _of_parameters(plan: FitPlan) -> list[Problem]:
    """Return the problems of the names of parameters: unknown, of a number that is 0, or named twice; [] for none."""
    problems, names = [], plan.fit.parameters
    tables = ("bodies.", "material.", "adhesion.", "viscoelasticity.")
    unfitted = ("bodies.spacing", "material.length_unit", "material.force_unit")
    for i, name in enumerate(names):
        must = "is no number of the base scene" if name not in plan.numbers else ""
        must = "is named twice" if name in names[:i] else must
        if must:
            allowed = [key for key in plan.numbers if key.startswith(tables) and key not in unfitted]
            hint = f"give it there, as a first guess; numbers of the scene are {', '.join(allowed)}"
            problems.append(Problem(f"parameters[{i}]", must, shown(name), hint))
    return problems
