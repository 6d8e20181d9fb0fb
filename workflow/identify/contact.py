"""The description of a contact in SI, from a TOML file or its tables: shapes, materials, attraction, load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from contact1d.workflow.body.cases import ASSUMED_RANGE
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Problem, Scene, SceneError, read_scene, read_tables
from contact1d.workflow.scene.file_kinds import require_kind
from contact1d.workflow.scene.measured import is_scan
from contact1d.workflow.scene.problems import nearest, shown
from contact1d.workflow.scene.profile_file import read_profile
from contact1d.workflow.scene.profiles import Profile as Shape
from contact1d.workflow.scene.read import set_values
from contact1d.workflow.scene.si_text import si_value
from contact1d.workflow.scene.tables import SPHERES

AnyContact = str | PathLike[str] | Mapping[str, Any]
"""A material file, by its path, or its tables."""
SCENE_KEYS = {
    "radius": "bodies.profile.radius",
    "profile": "bodies.profile",
    "upper": "material.upper",
    "lower": "material.lower",
    "contact_modulus": "material.contact_modulus",
    "surface_energy": "adhesion.surface_energy",
    "work_of_adhesion": "adhesion.work_of_adhesion",
    "range": "adhesion.range",
    "load": "experiment.force",
    "tolerance": "accuracy.tolerance",
    "title": "title",
}
"""Keys of a description that a scene has, too, with their dotted keys there."""
KEYS = (*SCENE_KEYS, "roughness", "model")
DEFAULTS = {
    "title": "A contact",
    "bodies.particles": "auto",
    "bodies.spacing": "auto",
    "bodies.profile.kind": "parabola",
    "bodies.profile.radius": 1.0,
    "bodies.reduction": "mdr",
    "bodies.lower": "rigid_plane",
    "bodies.bulk_stiffness": "auto",
    "material.length_unit": 1.0,
    "material.force_unit": 1.0,
    "accuracy.tolerance": 1e-3,
    "experiment.kind": "load",
    "experiment.force": 1.0,
}
"""Values of a chain on a rigid plane for all that a description does not give, by dotted keys of a scene."""
NONE_AT_ZERO = ("surface_energy", "work_of_adhesion")
"""Keys that count as absent if their value is 0."""


@dataclass(frozen=True)
class AskedContact:
    """The described contact of a body with a flat one, in SI.

    Attributes:
        scene: a chain on a rigid plane with the described values and DEFAULTS, in metres and newtons.
        given: the description.
        roughness: rms height [m]; None: not given.
    """

    scene: Scene
    given: Mapping[str, Any]
    roughness: float | None = None

    @property
    def shape(self) -> Shape:
        """The profile of the upper body, lengths in metres; with a counter radius, that of both bodies together."""
        return self.scene.bodies.profile

    @property
    def radius(self) -> float | None:
        """The radius of curvature R [m] of a paraboloid or sphere, the effective one of two; None of other bodies."""
        return self.shape.curvature_radius if self.shape.kind in SPHERES else None

    @property
    def contact_modulus(self) -> float:
        """The contact modulus E* [Pa] of both bodies, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, or as given."""
        assert self.scene.material is not None
        return self.scene.material.effective_modulus()

    @property
    def work_of_adhesion(self) -> float:
        """The work of adhesion W = 2γ [J/m²]; 0 without attraction."""
        return self.scene.work_of_adhesion

    @property
    def range(self) -> float:
        """The range h₀ of the attraction [m].

        Of an attraction without a given range it is 0.3 nm, and 0 without attraction.
        """
        return law_of(self.scene).range_of(self.scene, ASSUMED_RANGE)

    @property
    def load(self) -> float | None:
        """The load [N], compression positive; None where it is not given."""
        return self.scene.experiment.compression if "load" in self.given else None

    @property
    def is_of_particles(self) -> bool:
        """Whether the model is two chains of particles with a fitted interaction, else one chain on a rigid plane."""
        return self.given.get("model") == "particles"


def read_contact(source: AnyContact, complete: bool = True) -> AskedContact:
    """Return the contact that a file or its tables describe, read as a scene with 1 LU = 1 m and 1 FU = 1 N.

    Args:
        source: a TOML file, by its path, or its tables, which are not changed.
        complete: whether a load or an adhesion is required.

    Raises:
        SceneError: all problems of the description, in the order of its keys; or that the file can't be read or is a
            scene.
    """
    folder = Path() if isinstance(source, Mapping) else Path(fspath(source)).parent
    data = dict(source) if isinstance(source, Mapping) else read_tables(source)
    require_kind(data, "material file", source)
    problems = [*_mistakes(data, complete), *_without_unit(data, folder)]
    reported = {problem.path for problem in problems}
    scene = None
    try:
        scene = read_scene(_as_scene({key: v for key, v in data.items() if key not in reported}), folder=folder)
    except SceneError as error:
        of_scene = [_as_given(problem, data) for problem in error.problems]
        keys = data.keys() - reported
        problems += [problem for problem in of_scene if problem.path.partition(".")[0] in keys]
    roughness = _length(data, "roughness", problems)
    if problems or scene is None:
        raise SceneError(sorted(problems, key=_rank))
    return AskedContact(scene, data, roughness)


def _adheres(data: Mapping[str, Any]) -> bool:
    """Return whether a description has a surface energy or a work of adhesion; the number 0 counts as none.

    A text such as "0 J/m²" counts as one.
    """
    return bool(data.get("surface_energy") or data.get("work_of_adhesion"))


def _mistakes(data: Mapping[str, Any], complete: bool) -> Iterator[Problem]:
    """Yield the problems of a description that its scene would not have: unknown and missing keys.

    Also an unknown model and a negative load.

    `complete`: whether a load or an adhesion is required.
    """
    for key in (key for key in data if key not in KEYS):
        meant = nearest(key, KEYS)
        hint = f'did you mean "{meant}"?' if meant else f"allowed here: {', '.join(KEYS)}"
        yield Problem(key, "unknown key", hint=hint)
    if ("profile" in data) == ("radius" in data):
        hint = 'radius = "5 um" for a sphere, or profile = { kind = "cone", slope = 0.1 } as in a scene'
        yield Problem("radius", "give either a radius or a profile", hint=hint)
    if "contact_modulus" not in data and not {"upper", "lower"} <= data.keys():
        hint = (
            'write { youngs_modulus = "210 GPa", poisson_ratio = 0.3 }, "steel" or "rigid", or give contact_modulus, E*'
        )
        yield Problem("lower" if "upper" in data else "upper", "missing", hint=hint)
    if data.get("model", "plane") not in ("plane", "particles"):
        yield Problem("model", 'must be "plane" or "particles"', shown(data["model"]))
    if complete and "load" not in data and not _adheres(data):
        hint = "without attraction a load alone makes a contact; or give surface_energy or work_of_adhesion"
        yield Problem("load", "missing", hint=f'{hint}: load = "10 N"')
    if str(data.get("load", "")).lstrip().startswith("-"):
        yield Problem("load", "must be at least 0", shown(data["load"]))


def _without_unit(data: Mapping[str, Any], folder: Path) -> Iterator[Problem]:
    """Yield a problem if neither the file of a profile has units nor the profile a `scale` or `units`.

    None without a file, or for one that can't be read. `folder`: to which the file's path is relative.
    """
    profile = data.get("profile")
    if isinstance(profile, Mapping) and isinstance(profile.get("file"), str) and not {"scale", "units"} & {*profile}:
        with suppress(ValueError):
            if not read_profile(folder / profile["file"], is_scan(profile))[1]:
                hint = 'write scale = "1 um", the length of one of its units, or name the columns r [µm] and z [nm]'
                yield Problem("profile.scale", "missing: the file has no unit", hint=hint)


def _as_scene(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a chain on a rigid plane with the described values, and DEFAULTS for all others, unchecked.

    A surface energy or work of adhesion of the number 0 counts as absent. Without materials E* is 1 Pa; a missing
    one of two bodies is of steel.
    """
    given = {SCENE_KEYS[key]: v for key, v in data.items() if key in SCENE_KEYS and (v or key not in NONE_AT_ZERO)}
    unknown: dict[str, Any] = dict.fromkeys(("material.upper", "material.lower"), "steel")
    if not unknown.keys() & given.keys():
        unknown = {"material.contact_modulus": 1.0}
    if "range" in data and not _adheres(data):
        unknown["adhesion.work_of_adhesion"] = 0.0
    tables: dict[str, Any] = {}
    set_values(tables, DEFAULTS | unknown | given)
    return tables


def _as_given(problem: Problem, data: Mapping[str, Any]) -> Problem:
    """Return a problem of the scene with the key of the description in its path, as a new `Problem`.

    The path is unchanged if it belongs to no key of the description.
    """
    keys = [key for key in SCENE_KEYS if key in data]
    described = next((key for key in keys if problem.path.startswith(SCENE_KEYS[key])), problem.path)
    path = problem.path.replace(SCENE_KEYS.get(described, described), described, 1)
    return Problem(path, problem.message, problem.given, problem.hint)


def _rank(problem: Problem) -> int:
    """Return the position of a problem's key among the keys of a description, from 0; -1 for an unknown key."""
    key = problem.path.partition(".")[0]
    return KEYS.index(key) if key in KEYS else -1


def _length(data: Mapping[str, Any], key: str, problems: list[Problem]) -> float | None:
    """Return a length [m]; None if it is absent or no length.

    Of one below 0, infinite or NaN the problem is appended, and the value returned nevertheless.

    Args:
        data: the description; a text has a unit, a number is in [m].
        key: of the length.
        problems: list to which the problem of an invalid length is appended.
    """
    given = data.get(key)
    if given is None:
        return None
    try:
        value = float(si_value(given, "m")[0] if isinstance(given, str) else given)
    except (TypeError, ValueError) as error:
        problems.append(Problem(key, str(error), shown(given)))
        return None
    if not 0.0 <= value < math.inf:
        problems.append(Problem(key, "must be at least 0", shown(given)))
    return value
