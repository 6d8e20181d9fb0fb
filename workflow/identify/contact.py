"""What a person knows of a real contact, from a TOML file or a table: shapes, materials, attraction, load, in SI."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

from contact1d.workflow.scene import Problem, SceneError
from contact1d.workflow.scene.material import Elastic
from contact1d.workflow.scene.problems import nearest, shown
from contact1d.workflow.scene.profile_file import ProfileFileError, ScaleError, read_profile
from contact1d.workflow.scene.si_text import UnitTextError, example, in_words, si_value

AnyContact = str | PathLike[str] | Mapping[str, Any]
"""What `read_contact` makes a contact of: a TOML file, by its path, or its tables."""
Model = Literal["plane", "particles"]
MODELS: tuple[Model, ...] = ("plane", "particles")
USUAL_RANGE = 0.3e-9
"""Range of attraction [m] where none is given: a distance between atoms, and z₀ of most solids."""
RIGID = "rigid"
UNITS = {
    "radius": "m",
    "contact_modulus": "Pa",
    "surface_energy": "J/m²",
    "work_of_adhesion": "J/m²",
    "range": "m",
    "load": "N",
    "roughness": "m",
    "tolerance": "1",
}
"""Keys that hold a quantity, each a number in this unit or a text with any unit of its dimension."""
KEYS = ("title", "radius", "profile", "upper", "lower", *[key for key in UNITS if key != "radius"], "model")
LENGTHS, OF_A_FILE = ("radius", "height"), ("file", "scale")
"""Keys of a profile that hold a length, and those that its file is read by."""
BODY = {"youngs_modulus": "Pa", "poisson_ratio": "1"}
LARGEST_POISSON = 0.5


@dataclass(frozen=True)
class AskedContact:
    """A body on a flat one, in SI.

    Attributes:
        title: one line.
        profile: of the upper body, with the keys of a scene's; numbers in metres.
        contact_modulus: E* [Pa].
        bodies: both, where their elasticity is given; empty where E* is, or one of them is rigid.
        work_of_adhesion: W = 2γ [J/m²]; 0: no attraction.
        range: z₀ of the attraction [m].
        range_is_assumed: whether it is the usual one and nobody gave it.
        load: [N]; None: not given.
        roughness: rms height [m]; None: not given.
        tolerance: of the scene.
        model: "plane", a chain on a rigid plane; "particles", two chains with an interaction that is searched for.
    """

    title: str
    profile: Mapping[str, Any]
    contact_modulus: float
    bodies: Mapping[str, Elastic] = field(default_factory=dict)
    work_of_adhesion: float = 0.0
    range: float = USUAL_RANGE
    range_is_assumed: bool = True
    load: float | None = None
    roughness: float | None = None
    tolerance: float = 1e-3
    model: Model = "plane"

    @property
    def radius(self) -> float | None:
        """R of a sphere [m], None of another body."""
        sphere = self.profile.get("kind") in ("parabola", "circle")
        return float(self.profile["radius"]) if sphere else None


def read_contact(source: AnyContact) -> AskedContact:
    """The contact that a file or its tables describe.

    Raises:
        SceneError: with every problem at once.
    """
    folder = Path() if isinstance(source, Mapping) else Path(fspath(source)).parent
    return _Reader(_tables(source), folder).contact()


def _tables(source: AnyContact) -> dict[str, Any]:
    if isinstance(source, Mapping):
        return dict(source)
    path = fspath(source)
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise SceneError([Problem(path, error.strerror or str(error))]) from None
    except ValueError as error:  # not TOML, or not UTF-8
        raise SceneError([Problem(path, f"is no TOML: {error}")]) from None


class _Reader:
    """Reads one contact and gathers what is wrong with it."""

    def __init__(self, data: dict[str, Any], folder: Path) -> None:
        self.data, self.folder = data, folder
        self.problems: list[Problem] = []

    def contact(self) -> AskedContact:
        """The contact. Raises SceneError with every problem."""
        if {"bodies", "experiment"} <= self.data.keys():
            raise SceneError([Problem("bodies", "this is a scene and no material", hint="run it with contact1d run")])
        for key in self.data:
            if key not in KEYS:
                meant = nearest(key, KEYS)
                hint = f'did you mean "{meant}"?' if meant else f"allowed here: {', '.join(KEYS)}"
                self.problems.append(Problem(key, "unknown key", hint=hint))
        values = {key: self._quantity(key, self.data, unit, key) for key, unit in UNITS.items()}
        profile = self._profile(values["radius"])
        bodies, modulus = self._elasticity(values["contact_modulus"])
        energy = self._energy(values["surface_energy"], values["work_of_adhesion"])
        self._positive(values)
        model = self.data.get("model", "plane")
        if model not in MODELS:
            self.problems.append(Problem("model", 'must be "plane" or "particles"', shown(model)))
        if not energy and values["load"] is None:
            hint = "without attraction a load alone makes a contact; or give surface_energy or work_of_adhesion"
            self.problems.append(Problem("load", "missing", hint=f'{hint}: load = "{example("N")}"'))
        title = self.data.get("title", "A contact")
        if not isinstance(title, str) or not title.strip() or not title.isprintable():
            self.problems.append(Problem("title", "must be one line of text", shown(title)))
        if self.problems:
            raise SceneError(self.problems)
        reach = values["range"]
        return AskedContact(
            title=title,
            profile=profile,
            contact_modulus=modulus,
            bodies=bodies,
            work_of_adhesion=energy,
            range=USUAL_RANGE if reach is None else reach,
            range_is_assumed=reach is None,
            load=values["load"],
            roughness=values["roughness"],
            tolerance=values["tolerance"] or 1e-3,
            model=model,
        )

    def _quantity(self, path: str, table: Mapping[str, Any], unit: str, key: str) -> float | None:
        """The number at a key, in SI; None where it is absent or wrong."""
        given = table.get(key)
        if given is None:
            return None
        if isinstance(given, str):
            try:
                return float(si_value(given, unit)[0])
            except UnitTextError as error:
                self.problems.append(Problem(path, str(error), shown(given)))
                return None
        if isinstance(given, bool) or not isinstance(given, int | float) or not abs(given) < float("inf"):
            must = f"must be {in_words(unit)}, or a number in {unit}" if unit != "1" else "must be a number"
            self.problems.append(Problem(path, must, shown(given)))
            return None
        return float(given)

    def _positive(self, values: Mapping[str, float | None]) -> None:
        for key, value in values.items():
            least = "at least 0" if key in ("load", "roughness", "surface_energy", "work_of_adhesion") else ""
            if value is not None and (value < 0.0 if least else value <= 0.0):
                self.problems.append(Problem(key, f"must be {least or 'greater than 0'}", f"{value:g} {UNITS[key]}"))

    def _profile(self, radius: float | None) -> Mapping[str, Any]:
        given = self.data.get("profile")
        if (given is None) == ("radius" not in self.data):
            hint = 'radius = "5 um" for a sphere, or profile = { kind = "cone", slope = 0.1 } as in a scene'
            self.problems.append(Problem("radius", "give either a radius or a profile", hint=hint))
            return {}
        if given is None:
            return {"kind": "parabola", "radius": radius}
        if not isinstance(given, Mapping) or not isinstance(given.get("kind"), str):
            hint = 'write { kind = "cone", slope = 0.1 }, as in a scene'
            self.problems.append(Problem("profile", 'must be a table with a "kind"', shown(given), hint))
            return {}
        lengths = {key: self._quantity(f"profile.{key}", given, "m", key) for key in LENGTHS if key in given}
        points = self._points(given) if isinstance(given.get("file"), str) else {}
        return {key: value for key, value in {**given, **lengths, **points}.items() if key not in OF_A_FILE}

    def _points(self, given: Mapping[str, Any]) -> dict[str, list[float]]:
        """The lists r and z [m] of a profile's file."""
        try:
            lists, units = read_profile(self.folder / given["file"]).scaled(given.get("scale"))
        except ProfileFileError as error:
            self.problems.append(Problem("profile.file", str(error), shown(given["file"])))
            return {}
        except ScaleError as error:
            self.problems.append(Problem("profile.scale", str(error), shown(given["scale"])))
            return {}
        if "scale" not in given and None in units.values():
            hint = 'write scale = "1 um", the length of one of its units, or name the columns r [µm] and z [nm]'
            self.problems.append(Problem("profile.scale", "missing: the file says no unit", hint=hint))
            return {}
        meters = {key: 1.0 if unit is None else float(si_value(unit, "m")[0]) for key, unit in units.items()}
        return {key: [meters[key] * value for value in values] for key, values in lists.items()}

    def _elasticity(self, modulus: float | None) -> tuple[dict[str, Elastic], float]:
        """Both bodies, as far as they are elastic and given, and E* [Pa]."""
        given: dict[str, Any] = {name: self.data[name] for name in ("upper", "lower") if name in self.data}
        if "contact_modulus" in self.data:
            if given:
                hint = "give E*, or E and ν of both bodies"
                self.problems.append(Problem("contact_modulus", "not together with upper or lower", hint=hint))
            return {}, modulus or 1.0
        if len(given) < 2:
            absent = "lower" if "upper" in given else "upper"
            hint = 'write { youngs_modulus = "210 GPa", poisson_ratio = 0.3 } or "rigid", or give contact_modulus, E*'
            self.problems.append(Problem(absent, "missing", hint=hint))
            return {}, 1.0
        bodies = {name: self._body(name, table) for name, table in given.items() if table != RIGID}
        elastic: dict[str, Elastic] = {name: body for name, body in bodies.items() if body is not None}
        if not bodies:
            self.problems.append(Problem("upper", "one of the two bodies must be elastic"))
        if not elastic:
            return {}, 1.0
        modulus = 1.0 / sum(body.compliance for body in elastic.values())
        return (elastic if len(elastic) == 2 else {}), modulus

    def _body(self, name: str, table: object) -> Elastic | None:
        must = 'must be a table with youngs_modulus and poisson_ratio, or "rigid"'
        if not isinstance(table, Mapping) or set(table) != set(BODY):
            self.problems.append(Problem(name, must, shown(table)))
            return None
        before = len(self.problems)
        numbers = {key: self._quantity(f"{name}.{key}", table, unit, key) for key, unit in BODY.items()}
        youngs, poisson = numbers["youngs_modulus"], numbers["poisson_ratio"]
        if youngs is not None and youngs <= 0.0:
            self.problems.append(Problem(f"{name}.youngs_modulus", "must be greater than 0", f"{youngs:g} Pa"))
        if poisson is not None and not -1.0 < poisson <= LARGEST_POISSON:
            self.problems.append(
                Problem(f"{name}.poisson_ratio", "must be greater than -1 and at most 0.5", f"{poisson:g}")
            )
        if len(self.problems) > before or youngs is None or poisson is None:
            return None
        return Elastic(youngs_modulus=youngs, poisson_ratio=poisson)

    def _energy(self, gamma: float | None, work: float | None) -> float:
        """W [J/m²]."""
        if "surface_energy" in self.data and "work_of_adhesion" in self.data:
            hint = "γ of one side is half of W, the work of adhesion: give one of the two"
            self.problems.append(Problem("surface_energy", "not together with work_of_adhesion", hint=hint))
        return work if work is not None else 2.0 * (gamma or 0.0)
