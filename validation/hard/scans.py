"""Noisy scans of bodies whose shape is known: is what is taken of them, and what follows, within its uncertainty?

A parabola and a worn ball as an instrument gives them: with an offset, a tilt, and noise that is white or has an
exponential or a Gaussian autocorrelation. The land of a ball is 2 to 30 noises deep, or much more. A scan of noise
alone is no profile. The results are those of the reduced model with the whole error budget; a few scans run on LAMMPS
besides. Under a load F the displacement is off by δd where at a given displacement the force is off by
2E*a δd: the two are the same statement.
"""

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from validation.doors import Quantity, SceneError, modelled, read_scene
from validation.hard.surfaces import pieces
from validation.hard.units import Scene
from validation.references import force_curves
from validation.references.axisymmetric import Contact
from validation.references.numerics import Floats
from validation.row import Row, at_most
from validation.study import Bench, Lines, Refused, Study

SEEDS, FULL_SEEDS, FIRST_SEED = 10, 50, 20261125
"""How many noises, and the first of them: none that the method was made with."""
OUTSIDE, WIDEST, WIDEST_LAND = 0.12, 5.0, 6.0
"""Share of the seeds beyond the uncertainty, and the median uncertainty over the median error, at most, also of shallow
lands."""
FLATS = 20
"""Scans of noise alone."""
SAME = 0.5
"""Of LAMMPS and the reduced model. Measured: 0.497 with 0.1 nm of noise, where the lattice is all; worn balls 0.02."""
RADIUS, LAND, UNIT = 1e4, 100.0, 1e-6
"""R and land of the worn ball [µm]; in m."""
MODULUS, LOAD, WORK, PRELOAD = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9), 10.0, 1.0, 0.5
"""E* of steel on glass [Pa], load [N], W [J/m²] of the adhesive case and its preload [N]."""
TILT, OFFSET = 0.1, 40.0
"""[°], [µm]"""
SOURCE = "the MDR by quadrature of the body"


@dataclass(frozen=True)
class Case:
    """A body and its scan.

    Attributes:
        words: what it is.
        land: radius of the worn land [µm], 0 of the parabola; None: its depth is drawn, 2 to 30 noises.
        ends, pitch: of the scan [µm].
        noise, memory: standard deviation [nm] and correlation length [µm].
        gaussian: whether the autocorrelation is exp(−(h/l)²), and not exp(−h/l).
        tilt: [°]
        keys: of the profile.
        adheres: whether the contact does.
        spacing: of the particles [µm].
    """

    words: str
    land: float | None
    ends: tuple[float, float]
    pitch: float
    noise: float
    memory: float
    tilt: float
    keys: Scene
    adheres: bool = False
    spacing: float = 1.0
    gaussian: bool = False

    def worn(self, seed: int) -> float:
        """The radius of the land [µm]."""
        if self.land is not None:
            return self.land
        depth = 1e-3 * self.noise * 2.0 * 15.0 ** float(np.random.default_rng(seed).uniform())
        return math.sqrt(2.0 * RADIUS * depth)

    def scene(self, seed: int) -> Scene:
        """Its scene with the noise of this seed."""
        x = np.arange(self.ends[0], self.ends[1] + 0.5 * self.pitch, self.pitch)
        height = np.maximum(x**2 - self.worn(seed) ** 2, 0.0) / (2.0 * RADIUS)
        z = height + OFFSET + math.tan(math.radians(self.tilt)) * x + 1e-3 * self.noise * self._drawn(seed, x.size)
        profile = {"kind": "table", "x": (UNIT * x).tolist(), "z": (UNIT * z).tolist(), **self.keys}
        bodies = {"particles": "auto", "spacing": self.spacing * UNIT, "reduction": "mdr", "lower": "rigid_plane",
                  "profile": profile}  # fmt: skip
        material = {"contact_modulus": MODULUS, "length_unit": 1.0, "force_unit": 1.0}
        tables = {"title": self.words, "bodies": bodies, "material": material}
        load, pull = {"kind": "load", "force": LOAD}, {"kind": "pull_off", "preload": PRELOAD}
        held = {"adhesion": {"work_of_adhesion": WORK}, "experiment": pull}
        return tables | (held if self.adheres else {"experiment": load})

    def _drawn(self, seed: int, count: int) -> Floats:
        """Noise of unit variance at the points, (count,)."""
        draw = np.random.default_rng((seed, round(self.memory)))
        if not self.gaussian:
            return force_curves.noise(draw, count + 1000, self.memory / self.pitch)[1000:]
        kernel = np.exp(-2.0 * (self.pitch * np.arange(-500, 501) / self.memory) ** 2)
        return np.convolve(draw.standard_normal(count + 1000), kernel / math.sqrt(np.sum(kernel**2)), "valid")

    def exact(self, seed: int) -> dict[str, float]:
        """What the body of this seed has."""
        if self.adheres:
            tension = 1.5 * math.pi * WORK * RADIUS * UNIT
            rest = (4.5 * math.pi * WORK * (RADIUS * UNIT) ** 2 / MODULUS) ** (1.0 / 3.0)
            return {"adhesion_force": tension, "zero_load_radius": rest}
        land, end = self.worn(seed) * UNIT, RADIUS * UNIT
        contact = Contact(pieces((0.0, 0.0, 0.0), (land, land / end, 1.0 / end)), MODULUS)
        a = contact.pressed_radius(LOAD, (0.75 * LOAD * end / MODULUS) ** (1.0 / 3.0))
        return {"displacement": contact.displacement(a), "contact_radius": a}


def cases(full: bool) -> Iterator[Case]:
    """The parabola by its fit and by a smooth curve; the worn ball from one side and from both."""
    both, centred = (-400.0, 400.0), {"centre": "auto"}
    ways: dict[str, Scene] = {"fit": {"fit": "parabola"}, "smooth": {"smooth": "auto"}}
    for name, how in ways.items():
        for noise in (0.1, 1.0, 3.0) if full else (1.0,):
            for memory in (0.0, 5.0):
                words = f"parabola, {noise:g} nm{f' over {memory:g} µm' if memory else ''}, {name}"
                yield Case(words, 0.0, both, 0.5, noise, memory, TILT, centred | how)
        yield Case(f"parabola that adheres, 3 nm, {name}", 0.0, both, 0.5, 3.0, 0.0, TILT, centred | how, True)
    for sides, ends, keys in (("both sides", (-600.0, 600.0), centred), ("one side", (0.0, 600.0), {})):
        for tilt in (0.0, TILT):
            how = ways["smooth"] | ({"level": True} if tilt else {})
            words = f"worn ball, {sides}{', tilted' if tilt else ''}"
            yield Case(words, LAND, ends, 1.0, 3.0, 0.0, tilt, keys | how)
        for words, memory in (("white", 0.0), ("exponential", 4.0), ("Gaussian", 4.0)):
            words = f"land of 2 to 30 noises, {sides}, {words} noise"
            yield Case(words, None, ends, 1.0, 3.0, memory, 0.0, keys | ways["smooth"], gaussian="Gauss" in words)


def measure(bench: Bench) -> Lines:
    """Rows of each case, and of its first seed on LAMMPS."""
    for case in cases(bench.full):
        seeds = range(FIRST_SEED, FIRST_SEED + (FULL_SEEDS if bench.full else SEEDS))
        found = [modelled(read_scene(case.scene(seed))) for seed in seeds]
        exact = [*map(case.exact, seeds)]
        for name in exact[0]:
            yield from judged(case, name, [one[name] for one in found], np.asarray([one[name] for one in exact]))
        run = bench.run(case.words.replace(" ", "_").replace(",", ""), case.scene(FIRST_SEED))
        apart = [math.inf]
        if not isinstance(run, Refused):
            pairs = [(run.results[name].value, found[0][name]) for name in exact[0]]
            apart = [abs(value - one.value) / one.uncertainty for value, one in pairs]
        words = f"{case.words}: largest difference of LAMMPS from the reduced model over the uncertainty"
        yield at_most(words, max(apart), SAME, "the same chain, whose edge is found otherwise")
    yield from flats(range(FIRST_SEED, FIRST_SEED + FLATS))


def flats(seeds: Iterable[int]) -> Iterator[Row]:
    """Scans without curvature: each is refused, by every curve."""
    for keys in ({"smooth": "auto"}, *({"fit": shape} for shape in ("parabola", "circle", "power"))):
        case = Case("noise", math.inf, (-400.0, 400.0), 1.0, 3.0, 0.0, 0.0, {"centre": "auto"} | keys)
        accepted = 0
        for seed in seeds:
            with suppress(SceneError):
                accepted += bool(read_scene(case.scene(seed)))
        yield at_most(f"noise alone, {keys}: accepted scans", accepted, 0, "it has no curvature")


def judged(case: Case, name: str, found: list[Quantity], exact: Floats) -> Lines:
    """How many are within their uncertainties, and how wide these are."""
    off = np.abs([one.value for one in found] - exact) / exact
    spread = np.asarray([one.uncertainty for one in found]) / exact
    outside, width = float(np.mean(off > spread)), float(np.median(spread) / np.median(off))
    said = f"median uncertainty {np.median(spread):.1e} of it"
    yield at_most(f"{case.words}: share of {len(found)} values of {name} outside", outside, OUTSIDE, SOURCE, said)
    if name in ("displacement", "adhesion_force") or case.land is None:
        words = f"{case.words}: median uncertainty of {name} over its median error"
        yield at_most(words, width, WIDEST_LAND if case.land is None else WIDEST, SOURCE, said)


SCANS = Study(
    "scans",
    "Noisy scans of known bodies",
    "A scan has an offset, a tilt and noise. Are radii and forces of the fitted profile within their uncertainties, "
    "and are these no wider than the noise requires?",
    measure,
)
