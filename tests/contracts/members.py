"""What scenes are made of: for each member of a registry its tables, and every combination that the rules allow.

Numbers are in model units, with their dimension, so that a scene can be written in any units.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import Any, get_args
from zlib import crc32

from contact1d import Scene, SceneError, read_scene
from contact1d.workflow.experiments import KINDS
from contact1d.workflow.scene import EFFECTS, Profile
from contact1d.workflow.scene.experiments import KINDS as TABLES
from contact1d.workflow.scene.kinds import Method


@dataclass(frozen=True)
class Q:
    """A number in model units, of the dimension LU^length FU^force TU^time."""

    value: float
    length: float = 0.0
    force: float = 0.0
    time: float = 0.0

    def times(self, factor: float) -> Q:
        return replace(self, value=self.value * factor)


def dimension(length: float = 0.0, force: float = 0.0, time: float = 0.0) -> Callable[[float], Q]:
    """Makes numbers of a dimension."""
    return lambda value: Q(value, length, force, time)


length, force, stiffness = dimension(1.0), dimension(0.0, 1.0), dimension(-1.0, 1.0)
duration, velocity = dimension(time=1.0), dimension(1.0, time=-1.0)
energy, mass = dimension(1.0, 1.0), dimension(-1.0, 1.0, 2.0)

RADIUS, WORK, RANGE, SLOPE, PUNCH, MODULUS = 1000.0, 1e-3, 0.1, 0.03, 20.5, 1.0
CURVE = [2.0 * i for i in range(101)]
PROFILES: dict[str, dict[str, Any]] = {
    "parabola": {"radius": length(RADIUS)},
    "circle": {"radius": length(200.0)},
    "ellipsoid": {"radius": length(200.0), "height": length(80.0)},
    "cone": {"slope": SLOPE},
    "flat_punch": {"radius": length(PUNCH)},
    "power": {"exponent": 3.0, "radius": length(20.0), "height": length(0.4)},
    "table": {"r": [length(r) for r in CURVE], "z": [length(r * r / 2.0 / RADIUS) for r in CURVE]},
    "flat": {},
    "blunt_cone": {"slope": SLOPE, "tip_radius": length(300.0)},
    "truncated_cone": {"slope": SLOPE, "land_radius": length(5.0)},
    "truncated_parabola": {"radius": length(500.0), "land_radius": length(8.0)},
    "rounded_punch": {"radius": length(5.0), "edge_radius": length(200.0)},
    "hyperboloid": {"slope": SLOPE, "tip_radius": length(300.0)},
    "capped_punch": {"radius": length(12.0), "cap_radius": length(500.0)},
}
"""By their kind; under LOAD on a plane the contact radius is 10 to 20 LU."""

ARMS = [{"share": 0.4, "time": duration(1.0)}, {"share": 0.3, "time": duration(10.0)}]
NEAR, FAR = ({"amplitude": energy(A), "range": length(a)} for A, a in ((0.18, 0.13), (0.09, 0.26)))
PAIR = {"repulsion": NEAR, "attraction": FAR}
LONG = {
    "repulsion": {"amplitude": energy(1.0), "range": length(0.5)},
    "attraction": {"amplitude": energy(0.2), "range": length(1.0)},
}
"""Of bodies that slide: a shorter range lets them fall into each other's gaps."""
LAWS: dict[str, dict[str, Any]] = {
    "elastic": {},
    "neighbours": {"neighbours": {"stiffness": stiffness(0.3)}},
    "jkr": {"adhesion": {"work_of_adhesion": stiffness(WORK)}},
    "maugis": {"adhesion": {"work_of_adhesion": stiffness(WORK), "range": length(RANGE)}},
    "rate": {"adhesion": {"work_of_adhesion": stiffness(WORK), "rate": {"velocity": velocity(1.0), "exponent": 0.6}}},
    "prony": {"viscoelasticity": {"terms": ARMS}},
    "kelvin_voigt": {"viscoelasticity": {"retardation_time": duration(0.3)}},
    "restitution": {"viscoelasticity": {"restitution": 0.7}},
    "friction": {"friction": {"coefficient": 0.3}},
    "noise": {"noise": {"temperature": energy(1e-3), "seed": 1}},
    "pairs": {"interaction": {"repulsion": NEAR}},
    "attracting": {"interaction": PAIR},
    "attracting neighbours": {"interaction": PAIR, "neighbours": {"stiffness": stiffness(0.3)}},
    "attracting horizontal": {"interaction": PAIR, "horizontal": {}},
    "attracting alike": {"interaction": PAIR, "horizontal": {}, "neighbours": {"stiffness": stiffness(0.3)}},
    "attracting noise": {"interaction": PAIR, "noise": {"temperature": energy(1e-4), "seed": 1}},
}
"""Effects of the bodies and their contact by a name; those of a motion come with the experiment."""
MOTION = {
    "damping": {"coefficient": "auto"},
    "plate": {},
    "horizontal": {},
    "cantilever": {"stiffness": stiffness(20.0), "velocity": velocity(0.05)},
}

LOAD, BETWEEN, DEPTH, END = 10.0, 0.5, 0.3, 3.0
"""Forces on a plane and between particles [FU], a displacement [LU], a duration [TU]."""
STEPS = [length(d) for d in (0.0, 0.2, DEPTH, 0.1)]
TURNS = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [END, -0.5]]
EXPERIMENTS: dict[str, dict[str, Any]] = {
    "load": {"force": force(LOAD)},
    "path": {"displacements": STEPS},
    "path from contact": {"displacements": STEPS[::-1], "start": "contact"},
    "pull_off": {"preload": force(LOAD)},
    "pull_off twice": {"preload": force(LOAD), "cycles": 2},
    "pull_off at a velocity": {"preload": force(LOAD), "velocity": velocity(0.01)},
    "tangential": {"normal_force": force(LOAD), "displacements": [length(u) for u in (0.0, 0.05, 0.1, -0.05)]},
    "tangential cycles": {
        "normal_force": force(LOAD), "cycles": {"amplitude": length(0.08), "number": 1, "points": 8}
    },
    "history": {"displacement": [[duration(t), length(DEPTH * share)] for t, share in TURNS]},
    "history of a force": {"force": [[duration(t), force(LOAD * max(share, 0.0))] for t, share in TURNS]},
    "hold": {"displacement": length(DEPTH), "duration": duration(60.0)},
    "hold a force": {"force": force(LOAD), "duration": duration(400.0)},
    "impact": {"velocity": velocity(0.3)},
    "impact obliquely": {"velocity": velocity(0.3), "tangential_velocity": velocity(0.2)},
    "slide": {"normal_force": force(0.2), "distance": length(4.0)},
}  # fmt: skip
"""By a name that begins with their kind."""
METHODS: tuple[str, ...] = get_args(Method)
ADD = "tests/contracts/members.py has no {what} {names}: add {it} to {where}, with numbers as of the others there"


def unknown() -> list[str]:
    """A sentence for each member of a registry that no scene here has."""
    kinds = {get_args(one.model_fields["kind"].annotation)[0] for one in get_args(get_args(Profile)[0])}
    used = {name for law in LAWS.values() for name in law} | MOTION.keys()
    lacking = {
        ("profile", "its tables", "PROFILES"): kinds - PROFILES.keys(),
        ("effect", "a law with it", "LAWS (or to MOTION)"): {*EFFECTS} - used,
        ("experiment", "its keys", "EXPERIMENTS"): (TABLES.keys() | KINDS.keys()) - {*map(kind_of, EXPERIMENTS)},
    }
    return [
        ADD.format(what=what, it=it, where=where, names=sorted(names))
        for (what, it, where), names in lacking.items()
        if names
    ]


def kind_of(experiment: str) -> str:
    return experiment.split()[0]


@dataclass(frozen=True)
class Combination:
    """A scene by the names of its members."""

    profile: str
    law: str
    experiment: str
    method: str
    spacing: float = 1.0
    tolerance: float = 1e-2

    def __str__(self) -> str:
        return f"{self.profile}-{self.law}-{self.experiment}-{self.method}".replace(" ", "_")

    @property
    def on_plane(self) -> bool:
        return "interaction" not in LAWS[self.law]

    @property
    def members(self) -> frozenset[str]:
        """Of all registries."""
        effects = self.tables.keys() & {*EFFECTS}
        return frozenset({self.profile, self.law, self.experiment, self.method, *effects})

    @property
    def refines(self) -> bool:
        """Whether results converge with the spacing, which is otherwise a property of the bodies."""
        return self.on_plane and "neighbours" not in self.tables and "noise" not in self.tables

    @property
    def tables(self) -> dict[str, Any]:
        """Of the scene."""
        kind, h = TABLES[kind_of(self.experiment)], self.spacing
        bodies: dict[str, Any] = {
            "particles": "auto", "spacing": length(h), "lower": "rigid_plane" if self.on_plane else "particles",
            "reduction": "mdr", "profile": {"kind": self.profile} | PROFILES[self.profile],
            "bulk_stiffness": stiffness(MODULUS * h if self.on_plane else 0.83), "mass": mass(1.0),
        }  # fmt: skip
        if self.experiment == "slide":
            bodies["bulk_stiffness"] = stiffness(2.0)
        if self.profile == "flat":
            bodies |= {"particles": 16, "periodic": True}
        tables = {"bodies": bodies} | LAWS[self.law]
        if self.experiment == "slide" and "interaction" in tables:
            tables["interaction"] = {name: LONG[name] for name in tables["interaction"]}
        needed = [*kind.needs, *(kind.needs_in_time if self.method == "dynamic" else ())]
        if self.method == "dynamic":
            needed = [name for name in needed if name not in kind.excludes]
        if self.experiment == "hold a force" or kind_of(self.experiment) == "impact":
            needed.append("plate")
        own = {"impact": {"mass": mass(10.0)}, "slide": {"free": ["x", "z"]}}
        tables |= {name: MOTION.get(name, {}) for name in dict.fromkeys(needed) if name not in tables}
        if kind_of(self.experiment) == "impact":
            tables.pop("damping", None)
        if kind_of(self.experiment) == "hold" and self.experiment != "hold a force":
            tables.pop("plate", None)
        if "plate" in tables:
            tables["plate"] = own.get(kind_of(self.experiment), {})
        if self.experiment == "impact obliquely":
            tables["plate"] = tables["plate"] | {"lever_arm": length(400.0), "moment_of_inertia": Q(8e5, 1.0, 1.0, 2.0)}
        experiment = {"kind": kind_of(self.experiment)} | EXPERIMENTS[self.experiment]
        if not self.on_plane:
            experiment |= {key: force(BETWEEN) for key in ("force", "preload") if key in experiment}
        if "noise" in tables and experiment["kind"] == "pull_off" and "velocity" not in experiment:
            experiment["loading_rate"] = Q(0.05, 0.0, 1.0, -1.0)
        if kind.only_method is None:
            experiment["method"] = self.method
        return tables | {"accuracy": {"tolerance": self.tolerance}, "experiment": experiment}


@dataclass(frozen=True)
class Units:
    """How the numbers of a scene are written: a model unit in each, and the names of units; without, numbers alone."""

    length: float = 1.0
    force: float = 1.0
    time: float = 1.0
    names: tuple[str, str, str] | None = None

    def size(self, one: Q) -> float:
        return self.length**one.length * self.force**one.force * self.time**one.time

    def written(self, tables: Any) -> Any:
        """Tables of a scene file."""
        if isinstance(tables, Q):
            number = tables.value * self.size(tables)
            return number if self.names is None else f"{number!r} {self._unit(tables)}"
        if isinstance(tables, Mapping):
            return {name: self.written(one) for name, one in tables.items()}
        return [self.written(one) for one in tables] if isinstance(tables, list) else tables

    def _unit(self, one: Q) -> str:
        assert self.names is not None
        powers = zip(self.names, (one.length, one.force, one.time), strict=True)
        return "*".join(f"{name}^{power:g}" for name, power in powers if power) or "1"


MODEL = Units()
OTHERS = {
    "scaled": Units(2.0**-40, 2.0**50, 2.0**-15),
    "nm": Units(1e3, 1e-3, 1.0, ("nm", "mN", "ms")),
    "m": Units(1e-6, 1e-6, 1e-3, ("m", "N", "s")),
    "ft": Units(1e-6 / 0.3048, 1e-6 / 4.4482216152605, 1e-3 / 60.0, ("ft", "lbf", "min")),
}
"""LU = 1 µm, FU = 1 µN, TU = 1 ms, but for the first."""


def scene_of(combination: Combination, units: Units = MODEL) -> Scene:
    """Raises SceneError where the rules do not allow it."""
    return read_scene({"title": str(combination)} | units.written(combination.tables))


@cache
def allowed() -> tuple[Combination, ...]:
    """All that the rules allow."""
    return tuple(_allowed())


def _allowed() -> Iterator[Combination]:
    for names in product(PROFILES, LAWS, EXPERIMENTS, METHODS):
        one = Combination(*names)
        kind = TABLES[kind_of(one.experiment)]
        if kind.only_method not in (None, one.method):
            continue
        try:
            scene_of(one)
        except SceneError:
            continue
        yield one


def sample(every: Sequence[Combination], least: int = 2) -> list[Combination]:
    """Combinations in which each member of each registry is at least so many times, or as often as it is allowed.

    The next one has the most members that are still lacking; of equal ones that with the smallest digest.
    """
    rest = sorted(every, key=lambda one: crc32(str(one).encode()))
    members = set().union(*(one.members for one in rest))
    lacking = {name: min(least, sum(name in one.members for one in rest)) for name in members}
    found = []
    while any(lacking.values()):
        best = max(rest, key=lambda one: sum(lacking[name] > 0 for name in one.members))
        rest.remove(best)
        found.append(best)
        lacking = {name: count - (name in best.members) for name, count in lacking.items()}
        lacking = {name: max(count, 0) for name, count in lacking.items()}
    return found
