"""Fits of synthetic force curves: do the intervals of 95 % cover, and is the right contact model chosen?

Curves are closed forms (`references.force_curves`) with noise of 1 % of the pull-off force. Cantilever and radius are
off by what their ± allows, drawn anew for each curve. A curve that is refused counts as not covered.
"""

import csv
import math
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from validation.doors import Contact1dError, cores, fit, fit_many
from validation.references.force_curves import Sphere, measured, noise
from validation.row import Row, at_least, at_most, tables_beside
from validation.study import Bench, Lines, Study

MODULUS, WORK, RADIUS, POINT = 2e6, 0.05, 5e-6, 3e-7
"""E* [Pa], W [J/m²], R [m], contact point [m]."""
POINTS, NOISE, MEMORY = 1000, 0.01, 20.0
"""Of a curve; noise over the pull-off force; its memory [points]."""
STIFFNESS_SPREAD, RADIUS_SPREAD = 0.05, 0.02
"""± over the value, 95 %."""
LEAST, MOST = 0.90, 0.99
"""Share of intervals of 95 % that cover: 180 to 198 of 200."""
RIGHT = 0.9
"""Share of curves whose contact model is chosen, a factor of 3 from a border."""
SOURCE = "the parameters that the curves were made with"
CURVES, FULL_CURVES = 4, 20
DRAWS, FULL_DRAWS = 2, 10
MAP, FULL_MAP = 40, 1000


class Group(NamedTuple):
    """Curves of one kind.

    Attributes:
        kind: contact model.
        memory: of the noise [points].
        softness: stiffness of the cantilever over E*a₀.
        tabor: µ of Maugis's contact.
    """

    kind: str
    memory: float
    softness: float
    tabor: float = 1.0

    @property
    def sphere(self) -> Sphere:
        """The contact as the scene has it."""
        reach = (RADIUS * WORK**2 / MODULUS**2) ** (1.0 / 3.0) / self.tabor
        return Sphere(MODULUS, WORK, RADIUS, reach if self.kind == "Maugis" else 0.0)

    @property
    def stiffness(self) -> float:
        """k_c [N/m]."""
        return self.softness * MODULUS * self.sphere.zero_load_radius

    @property
    def parameters(self) -> dict[str, float]:
        """What is fitted, and its true value."""
        return {"material.contact_modulus": MODULUS} | (
            {"adhesion.work_of_adhesion": WORK} if self.kind != "Hertz" else {}
        )

    def plan(self, data: Path, reach: float | None = None) -> dict[str, Any]:
        """Its fit file, whose first guesses are off by factors."""
        base: dict[str, Any] = {
            "bodies": {"profile": {"kind": "parabola", "radius": f"{RADIUS} m ± {100 * RADIUS_SPREAD} %"}},
            "material": {"contact_modulus": "0.5 MPa"},
        }
        reach = reach or self.sphere.range
        if self.kind != "Hertz" or reach:
            base["adhesion"] = {"work_of_adhesion": "20 mJ/m²"} | ({"range": f"{reach} m"} if reach else {})
        stiffness = f"{self.stiffness} N/m ± {100 * STIFFNESS_SPREAD} %"
        names = ["material.contact_modulus", *["adhesion.work_of_adhesion"] * ("adhesion" in base)]
        return {"data": str(data), "parameters": names, "instrument": {"stiffness": stiffness}, "base": base}

    def curve(self, seed: int) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        """Positions [m] and forces [N] of one measurement."""
        draw = np.random.default_rng(seed)
        radius = RADIUS * (1.0 + RADIUS_SPREAD / 1.96 * draw.standard_normal())
        stiffness = self.stiffness * (1.0 + STIFFNESS_SPREAD / 1.96 * draw.standard_normal())
        depth = self.sphere.zero_load_radius**2 / RADIUS
        positions = np.linspace(-2.5 * depth - 1.2 * self.sphere.range, 3.0 * depth, POINTS // 2)
        sphere = Sphere(MODULUS, WORK, radius, self.sphere.range)
        both = np.concatenate([noise(draw, POINTS // 2, self.memory) for _ in range(2)])
        force = measured(sphere, self.kind, stiffness, positions) + NOISE * 1.5 * math.pi * WORK * RADIUS * both
        return np.concatenate([positions, positions[::-1]]) + POINT, force


GROUPS = [Group(**group) for group in tables_beside(__file__)["groups"]]


def write(group: Group, places: Mapping[int, str], head: str, path: Path) -> Path:
    """The curves of some seeds, each line behind a place."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [f"{head}z [nm],F [nN]"]
    for seed, place in places.items():
        lines += [f"{place}{1e9 * z:.4f},{1e9 * F:.5f}" for z, F in zip(*group.curve(seed), strict=True)]
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path


def write_map(group: Group, seeds: range, folder: Path) -> Path:
    """Curves as one map."""
    places = {seed: f"{seed},{seed % 32},{seed // 32}," for seed in seeds}
    return write(group, places, "curve,x [µm],y [µm],", folder / "map.csv")


def lines_of(plan: dict[str, Any], folder: Path) -> Iterator[dict[str, str]]:
    """The lines of fits.csv of a fit of many curves, each as a dict by column."""
    done = fit_many(plan, folder / "fits", workers=cores())
    with (done.folder / "fits.csv").open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def covers(row: Mapping[str, str], name: str, exact: float) -> bool:
    """Whether the interval of a number of a line holds its value."""
    ends = [next((v for k, v in row.items() if k.startswith(f"{name}_{end} ")), "") for end in ("low", "high")]
    return all(ends) and float(ends[0]) <= exact <= float(ends[1])


def measure(bench: Bench) -> Lines:
    """Coverage, choice of the model, and time."""
    named, all_of = list[bool](), dict[str, list[bool]]()
    for i, group in enumerate(GROUPS):
        folder, first = bench.folder / f"group_{i}", 1000 * i
        curves = write_map(group, range(first, first + (FULL_CURVES if bench.full else CURVES)), folder)
        for row in lines_of(group.plan(curves), folder):
            named.append(bool(row.get("hysteresis")))
            for name, exact in group.parameters.items():
                all_of.setdefault(name, []).append(covers(row, name, exact))
    for name, found in all_of.items():
        share, words = float(np.mean(found)), f"share of {len(found)} intervals of {name} that cover"
        yield at_least(words, share, LEAST, SOURCE)
        if bench.full:
            yield at_most(words, share, MOST, SOURCE)
    words = f"share of {len(named)} curves without hysteresis in which one is named"
    yield at_most(words, float(np.mean(named)), 0.03, SOURCE)
    yield from _choices(bench)
    count = FULL_MAP if bench.full else MAP
    folder = bench.folder / "map"
    curves = write_map(GROUPS[1], range(count), folder)
    begin = time.perf_counter()
    fit_many(GROUPS[1].plan(curves), folder / "fits", workers=cores())
    minutes = (time.perf_counter() - begin) / 60.0
    yield at_most(f"minutes for a map of 1000 curves, from {count}", minutes * 1000 / count, 10.0, "set bound")


def _choices(bench: Bench) -> Iterator[Row]:
    """How often the most likely contact model is the one that a curve was made with."""
    kinds = [Group("JKR", MEMORY, 2.0), Group("DMT", MEMORY, 2.0), Group("Hertz", MEMORY, 2.0)]
    kinds += [Group("Maugis", MEMORY, 2.0, tabor) for tabor in (0.3, 1.0, 1.67)]
    for i, group in enumerate(kinds):
        right, seeds = [], range(FULL_DRAWS if bench.full else DRAWS)
        for seed in seeds:
            try:
                data = write(
                    group, {50_000 + 100 * i + seed: ""}, "", bench.folder / f"choice_{i}_{seed}" / "curve.csv"
                )
                likely = next(iter(fit(group.plan(data, group.sphere.range or 1e-9)).models))
                right.append(bool(likely == group.kind))
            except Contact1dError as error:  # of a curve without adhesion the refusal names Hertz's contact
                right.append(group.kind == "Hertz" and "no adhesion" in str(error))
        words = f"share of {len(right)} curves of {group.kind}{f', µ = {group.tabor}' if group.sphere.range else ''}"
        yield at_least(f"{words} whose model is chosen", float(np.mean(right)), RIGHT, SOURCE)


FITS = Study(
    "fits",
    "Fits of force curves",
    "Do the 95 % intervals of a fit contain the true modulus and work of adhesion, and does it choose the right "
    "contact model?",
    measure,
)
