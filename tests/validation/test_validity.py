"""Claim: every run says where its theory ends: slope, size of the body, Tabor parameter, yield, each with its number.

It is judged by its widest contact and its largest pressure, also where the bodies end apart. References: the whole
sphere by quadrature of its slope, Maugis and Dugdale's equations, Hertz, p(0) = 2E*a/πR, and his impact, a² =
R (15 M v²/(16 E* √R))^{2/5}.
"""

import math
import os
from collections.abc import Callable, Mapping
from typing import Any

import matplotlib.pyplot as plt
import pytest

from contact1d import Run, run
from tests.pages import require_shown
from tests.scenes import ROOT, in_si
from validation.references.maugis import LAMBDA_OVER_TABOR, marks
from validation.references.mdr import ReducedContact

RADIUS, RATIOS = 1.0, (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7)
"""R [LU], and contact radii of the ball over it."""
NUMBERS = {"contact_radius": "contact radius a", "displacement": "displacement d", "central_pressure": "pressure p(0)"}
LATTICE = 2e-3
"""Of the difference of two runs at 1e-3 beside that of the closed forms."""
BALL, GLASS, STRENGTH = 2e-3, 70e9 / (1.0 - 0.22**2), 50e6
"""R [m], E* and Y [Pa] of a rigid ball on glass."""
NEAR = 1e-3
"""Of a radius and a pressure between the states of an impact, and of the lattice."""


def ball(r: float) -> float:
    """f′(r) of a whole sphere."""
    return r / math.sqrt((RADIUS - r) * (RADIUS + r))


def contact(kind: str, experiment: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """E* = 1 Pa, R = 1 m, particles by the tolerance."""
    return in_si({"kind": kind, "radius": "1 m"}, "1 Pa", title=kind, experiment=experiment, **more)


def checks(found: Run) -> dict[str, Any]:
    """By name."""
    return {one["name"]: one for one in found.document["validity"]}


def test_the_error_of_a_paraboloid_over_its_radius_is_on_the_page() -> None:
    sphere, paraboloid = ReducedContact(ball, 1.0), ReducedContact(lambda r: r / RADIUS, 1.0)
    rows, errors = [], dict[str, list[float]]((name, []) for name in NUMBERS)
    for ratio in RATIOS:
        force = sphere.force(ratio)
        runs = [run(contact(kind, {"kind": "load", "force": f"{force!r} N"})) for kind in ("parabola", "circle")]
        for name in NUMBERS:
            flat, whole = (found.results[name].value for found in runs)
            errors[name].append(flat / whole - 1.0)
        a = paraboloid.contact_radius(paraboloid_depth(force))
        assert errors["contact_radius"][-1] == pytest.approx(a / ratio - 1.0, abs=LATTICE)
        rows.append(f"| {ratio:g} | " + " | ".join(f"{100.0 * errors[name][-1]:+.2g} %" for name in NUMBERS) + " |\n")
        slopes = [checks(found)["slope"] for found in runs]
        assert [one["value"] for one in slopes] == pytest.approx([a, ball(ratio)], rel=2e-2)
        for found, slope in zip(runs, slopes, strict=True):
            assert slope["holds"] == (slope["value"] <= slope["limit"]) == ("slope" not in found.warnings)
        if a > 0.1:
            assert f"a contact radius {1.0 - ratio / a:.1%} smaller" in runs[0].warnings["slope"]
    head = "| a/R of the ball | " + " | ".join(NUMBERS.values()) + " |\n| ---" + " | ---" * len(NUMBERS) + " |\n"
    require_shown("docs/validity.md", "paraboloid", head + "".join(rows))
    if os.environ.get("WRITE_DOCS"):
        draw(errors)
    assert (ROOT / "docs" / "validity.png").is_file()


def paraboloid_depth(force: float) -> float:
    """Hertz's d [LU] of R = 1, E* = 1."""
    return float((0.75 * force) ** (2.0 / 3.0))


def draw(errors: Mapping[str, list[float]]) -> None:
    """The figure of the page."""
    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for name, values in errors.items():
        axes.plot(RATIOS, [abs(value) for value in values], "o-", label=NUMBERS[name])
    axes.set(xscale="log", yscale="log", xlabel="contact radius of the ball over its radius, a/R")
    axes.set_xticks(RATIOS, [f"{ratio:g}" for ratio in RATIOS])
    axes.set_xticks([], minor=True)
    axes.set_ylabel("relative error of the paraboloid")
    axes.axvline(0.1, color="0.6", ls="--", label="limit of the warning")
    axes.legend()
    figure.savefig(ROOT / "docs" / "validity.png", dpi=150)


@pytest.mark.parametrize(("work", "reach"), [(0.2, None), (0.08, 0.1e-9)])
def test_jkr_is_held_against_maugis_and_dugdale(work: float, reach: float | None) -> None:
    """A sphere of 1 µm and E* = 50 GPa; without a range 0.3 nm are assumed, and said; with one F_A is Maugis's own."""
    tables = contact("parabola", {"kind": "pull_off", "preload": "1 pN"})
    tables["bodies"]["profile"]["radius"] = "1 µm"
    tables |= {"material": {"contact_modulus": "50 GPa"}, "adhesion": {"work_of_adhesion": f"{work} J/m²"}}
    if reach:
        tables["adhesion"] |= {"range": f"{reach} m"}
    found = run(tables)
    tabor = (1e-6 * work**2 / (50e9**2 * (reach or 0.3e-9) ** 3)) ** (1.0 / 3.0)
    assert checks(found)["tabor"]["value"] == pytest.approx(tabor, rel=1e-9)
    force = marks(LAMBDA_OVER_TABOR * tabor)[1]
    if reach:
        assert "tabor" not in found.warnings
        assert found.results.adhesion_force.value == pytest.approx(math.pi * work * 1e-6 * force, rel=1e-6)
        assert found.results.tabor_parameter.value == pytest.approx(tabor, rel=1e-9)
        return
    assert f"{1.0 - 1.5 / force:.1%} smaller" in found.warnings["tabor"]
    assert "assumed" in found.warnings["tabor"]


@pytest.mark.parametrize(
    ("kind", "force", "yields"),
    [
        ("parabola", 0.999, False),
        ("parabola", 1.001, True),
        ("cone", 1e-2, True),
    ],
)
def test_the_softer_body_yields_at_1_6_y(kind: str, force: float, yields: bool) -> None:
    """F at first yield by Hertz: p(0)³ = 6 F E*²/π³R² with p(0) = 1.6 Y."""
    upper = {"youngs_modulus": "200 GPa", "poisson_ratio": 0.3, "yield_strength": "900 MPa"}
    lower = {"youngs_modulus": "100 GPa", "poisson_ratio": 0.3, "yield_strength": "300 MPa"}
    modulus = 1.0 / (0.91 / 200e9 + 0.91 / 100e9)
    first = (1.6 * 300e6) ** 3 * math.pi**3 * 0.01**2 / (6.0 * modulus**2)
    tables = contact(kind, {"kind": "load", "force": f"{first * force!r} N"})
    profile = {"kind": "cone", "slope": 0.05} if kind == "cone" else {"kind": kind, "radius": "10 mm"}
    tables["bodies"] |= {"profile": profile}
    found = run(tables | {"material": {"upper": upper, "lower": lower}})
    assert ("yield" in found.warnings) == yields
    assert not yields or "480 MPa" in found.warnings["yield"]


def impact(velocity: float) -> tuple[dict[str, Any], float]:
    """Of 0.2 g, and its largest a [m]."""
    depth = (15.0 * 2e-4 * velocity**2 / (16.0 * GLASS * math.sqrt(BALL))) ** 0.4
    plate = {"mass": "0.2 g", "free": ["z"]}
    return {"experiment": {"kind": "impact", "velocity": f"{velocity!r} m/s"}, "plate": plate}, math.sqrt(BALL * depth)


def history(displacement: float) -> tuple[dict[str, Any], float]:
    """In and out again."""
    points = [[f"{t} s", f"{d!r} m"] for t, d in ((0, -1e-9), (1, displacement), (2, -1e-9))]
    return {"experiment": {"kind": "history", "displacement": points}}, math.sqrt(BALL * displacement)


def path(displacement: float) -> tuple[dict[str, Any], float]:
    """To a displacement, and back to a tenth of it."""
    places = [f"{part * displacement!r} m" for part in (0.0, 0.5, 1.0, 0.1)]
    return {"experiment": {"kind": "path", "displacements": places}}, math.sqrt(BALL * displacement)


@pytest.mark.parametrize(
    ("made", "size", "broken"),
    [
        (impact, 0.01, {"yield"}),
        (history, 0.1e-9, set()),
        (path, 60e-6, {"yield", "slope"}),
    ],
)
def test_the_largest_state_is_checked(
    made: Callable[[float], tuple[dict[str, Any], float]], size: float, broken: set[str]
) -> None:
    tables, a = made(size)
    glass = {"youngs_modulus": "70 GPa", "poisson_ratio": 0.22, "yield_strength": "50 MPa"}
    scene = contact("parabola", {}) | {"material": {"upper": "rigid", "lower": glass}} | tables
    scene["bodies"]["profile"]["radius"] = f"{BALL!r} m"
    done = run(scene)
    expected = {"slope": a / BALL, "body_size": a / BALL, "yield": 2.0 * GLASS * a / (math.pi * BALL) / STRENGTH}
    assert {name: one["value"] for name, one in checks(done).items()} == pytest.approx(expected, rel=NEAR)
    failed = {name for name, one in checks(done).items() if not one["holds"]}
    assert failed == broken == checks(done).keys() & done.warnings.keys()
