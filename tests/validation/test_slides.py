"""Claim: flat chains slide as Prandtl and Tomlinson say, also under heat; traces of curved ones: `test_slide_legs`.

Flat chains slide as Prandtl and Tomlinson's particle does. Below the threshold of its springs, max(−U″) of the
corrugation U(x) = min_z Σ V + F_N z that the row has, a particle slides without slips. Commensurate chains are so many
particles. Incommensurate ones on springs k to a common body (Frenkel, Kontorova and Tomlinson without springs between
neighbours) are all of them in one well each for k > κ = max(−U″), and the body's energy does not depend on its place;
for k < κ they jump one after the other, and the friction of a slow drive is finite. κ is that of a particle at the
height that all share: on the top it presses its spring.

Under heat a slide has its temperature, also the plate, whose own drag comes with its heat: M ⟨(V − v)²⟩ = k_BT, the
ratio's own spread over independent times as error. ⟨F⟩(T, v) of one particle on a row is that of Smoluchowski's
equation, and of an ensemble for fast drives: a free energy by quadrature and a density in finite volumes, and a
vectorised integrator of other form (BAOAB) than LAMMPS's.
"""

from typing import Any

import numpy as np
import pytest

from contact1d import Run, Scene, read_scene, run
from tests.scenes import chains
from validation.paper import heat
from validation.references.incommensurate import threshold
from validation.references.prandtl_tomlinson import corrugation

LAW = (1.0, 0.5, 0.5, 1.0)
LOAD = 0.2
MOTION = 2e-3
"""Of ⟨F⟩: the cutoff changes the corrugation by 1e-4, and means are over other periods."""
FAST, LATE = 4e-3, 1e-3
"""Velocities [LU/TU], a factor of 4 apart: 1 for a friction that is finite at v = 0, 4 for one proportional to v."""
SMOOTH, PINNED, FREE = 2.5, 1.7, 3.5
WARM = 3.0
"""Standard errors of a temperature."""
SIGMAS = 4.0
"""Standard errors of run and reference: one test in 16 000 would fail by chance, and the seeds are fixed."""
EXCHANGED = 5e-3
"""Work that is neither given to the baths nor stored, over the energy that the drive and the baths exchange."""


def slid(velocity: float, stiffness: float, cantilever: float, distance: float, **tables: Any) -> Run:
    """A flat body of which each particle has a spring along x, on a rigid row."""
    bodies = {
        "particles": 32, "upper_particles": 1, "upper_offset": 0.0, "lower": "rigid_chain", "periodic": True,
        "profile": {"kind": "flat"}, "bulk_stiffness_tangential": stiffness, "mass": 1.0,
    } | tables.pop("bodies", {})  # fmt: skip
    count = bodies["upper_particles"]
    scene = chains(
        1.0, 1.0, LAW, title="flat", bodies=bodies, horizontal={}, damping={"coefficient": 0.4},
        plate={"free": ["x", "z"], "damping": 0.0}, cantilever={"stiffness": cantilever * count, "velocity": velocity},
        experiment={"kind": "slide", "normal_force": LOAD * count, "distance": distance},
    )  # fmt: skip
    return run(scene | tables)


def pulled(eta: float, velocity: float, **tables: Any) -> Run:
    """A particle whose spring to the drive, its own and the cantilever's in series, is max(−U″)/η."""
    stiffness = corrugation(LAW, 1.0, LOAD).steepest / eta
    return slid(velocity, 1.0, 1.0 / (1.0 / stiffness - 1.0), 4.0, **tables)


def test_below_the_threshold_it_slides_smoothly() -> None:
    """η = 0.8: no slip, and a friction that falls with the velocity."""
    fast, slow = (pulled(0.8, v).results for v in (FAST, LATE))
    assert slow.slips.value == 0
    assert fast.mean_friction.value / slow.mean_friction.value > SMOOTH


def test_a_commensurate_chain_is_so_many_particles() -> None:
    """With the same spring and force for each, and springs between them."""
    alone = pulled(2.0, FAST).results
    eight = {"upper_particles": 8, "particles": 8, "upper_offset": 0.5}
    chained = pulled(2.0, FAST, bodies=eight, neighbours={"stiffness": 0.5}).results
    for name in ("mean_friction", "static_friction"):
        assert chained[name].value == pytest.approx(8.0 * alone[name].value, rel=MOTION), name
    assert alone.static_friction.value == pytest.approx(corrugation(LAW, 1.0, LOAD).largest_force, rel=5e-3)


def test_an_incommensurate_chain_changes_from_pinned_to_viscous_at_the_threshold() -> None:
    stiffness = threshold(LAW, 1.0, LOAD, 1.0)
    assert stiffness == pytest.approx(0.1225, abs=1e-4)
    bodies = {"particles": 34, "upper_particles": 21, "upper_spacing": 34 / 21}
    ratios = {}
    for share in (0.75, 1.6):
        fast, slow = (
            slid(v, share * stiffness, 5.0, 3.0, bodies=bodies, damping={"coefficient": 0.3}) for v in (FAST, LATE)
        )
        ratios[share] = fast.results.mean_friction.value / slow.results.mean_friction.value
    assert ratios[0.75] < PINNED
    assert ratios[1.6] > FREE


def hot_pair(**tables: Any) -> Scene:
    """A flat pair of eight particles that slides slowly under heat."""
    base = heat.FLAT_PAIR | {"experiment": {"kind": "slide", "normal_force": 1.6, "distance": 12.0}}
    changed = {name: base.get(name, {}) | tables.get(name, {}) for name in {**base, **tables}}
    return read_scene({"title": "slide under heat"} | changed)


@pytest.mark.parametrize(
    ("share", "velocity", "distance"), [pytest.param(0.15, 2e-2, 30.0, marks=pytest.mark.slow), (0.05, 2e-3, 6.0)]
)
def test_the_friction_under_heat_is_that_of_its_reference(share: float, velocity: float, distance: float) -> None:
    found = run(heat.scene(share, velocity, distance, seed=7)).results["mean_friction"]
    mean, error = heat.expected(share, velocity)
    sigma = (found.uncertainty**2 / heat.INTERVAL**2 + error**2) ** 0.5
    assert found.value == pytest.approx(mean, abs=SIGMAS * sigma)
    assert found.uncertainty < 0.5 * mean


def test_the_plate_is_as_warm_as_its_particles() -> None:
    """A drag of 4 beside 8 · 0.4 of the particles would cool it to 0.44 T if it had no heat of its own."""
    at_rest = {"kind": "slide", "normal_force": 1.6, "path": [[0.0, 12.0]]}
    found = run(hot_pair().with_({"experiment": at_rest})).results["plate_temperature"]
    assert found.value == pytest.approx(heat.TEMPERATURE, abs=WARM * found.uncertainty / 2.0)
    assert found.uncertainty < 0.2 * heat.TEMPERATURE


def test_heat_lowers_the_friction_and_the_balance_of_energy_holds() -> None:
    hot = run(hot_pair())
    work, lost, stored = (hot.results[f"{n}"].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=EXCHANGED * max(abs(work), abs(lost), abs(stored)))
    cold = run(hot_pair().with_(without="noise")).results
    assert hot.results.mean_friction.value < cold.mean_friction.value
    assert np.isfinite(hot.friction["friction"]).all()


def test_a_plate_at_rest_relaxes_with_its_drag() -> None:
    """Pulled aside and left, its force falls as the drag N γ + c on all that moves lets it, where nothing else holds.

    The friction of the incommensurate, stiff pair is nil; the time is that of the drag, with and without heat.
    """
    scene = hot_pair(
        bodies={"particles": 13, "upper_particles": 8, "upper_spacing": 13 / 8, "bulk_stiffness": 4.0},
        plate={"free": ["x", "z"], "mass": 8.0, "damping": 16.0},
        cantilever={"stiffness": 1.0, "velocity": 0.02},
        noise={"temperature": 1e-11},
    ).with_({"experiment": {"kind": "slide", "normal_force": 1.6, "path": [[0.5, 1.0], [0.0, 0.5]]}})
    total = 8 * 0.4 + 16.0
    rate = total / 32.0 * (1.0 - np.sqrt(1.0 - 4.0 * 16.0 / total**2))
    for one in (scene, scene.with_(without="noise")):
        found = run(one)
        resting = found.friction["time"] > 15.0  # the particles have come to rest, too
        time, pull = found.friction["time"][resting], found.friction["cantilever_force"][resting]
        assert -np.polyfit(time, np.log(np.abs(pull)), 1)[0] == pytest.approx(rate, rel=0.03)
