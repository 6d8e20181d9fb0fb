"""Claim: what a refusal says is possible is, and a little more is refused: of chains, profiles, ways and sizes."""

import math
import os
import re
from collections.abc import Callable
from typing import Any

import pytest

from contact1d import SettingsError
from tests.decks.test_lengths_and_forces import FREE, TENSION, path, slide
from tests.decks.written import written
from tests.scenes import chains

LOAD = {"kind": "load", "force": 0.05}
PLANE: dict[str, Any] = {"bodies": {"lower": "rigid_plane", "reduction": "mdr"}, "interaction": None}
TIMED = {"damping": {"coefficient": "auto"}, "experiment": LOAD | {"method": "dynamic"}}
FIGURES = 1e-3
"""Relative: four figures of a number in a message."""


def refused(tables: dict[str, Any], told: str) -> float:
    """The number that the refusal of a scene names."""
    with pytest.raises(SettingsError, match=told) as caught:
        written(tables)
    return float(re.findall(told, str(caught.value))[0].rstrip(":,."))


def wide(particles: float) -> dict[str, Any]:
    body = {"particles": round(particles), "profile": {"kind": "circle", "radius": 30.0}}
    return chains(1.0, bodies=body, experiment=LOAD)


def narrow(spacing: float, particles: Any) -> dict[str, Any]:
    body = {"particles": particles, "profile": {"kind": "circle", "radius": 3.0}, "spacing": spacing}
    return chains(1.0, bodies=body, experiment=path(0.01))


def reaching(cutoff: float) -> dict[str, Any]:
    tables = chains(100.0, bodies={"particles": 20, "spacing": 1e-3}, experiment=path(0.01))
    return tables | {"interaction": tables["interaction"] | {"cutoff": cutoff}}


def far(displacement: float) -> dict[str, Any]:
    return chains(100.0, **PLANE, experiment=path(-displacement))


@pytest.mark.parametrize(
    ("tables", "too_much", "told", "more"),
    [
        (wide, 80, r"at most (\d+) particles", 2.0),
        (lambda s: narrow(s, "auto"), 2.5, r"a bodies.spacing below (\S+) LU", None),
        (lambda s: narrow(s, 3), 3.5, r"a bodies.spacing below (\S+) LU", None),
        (lambda n: slide(particles=round(n), upper_particles=12), 20, r"at least (\d+) bodies.particles", -2.0),
        (lambda d: slide(d, particles=60, upper_particles=12), 60.0, r"a distance of at most (\S+) LU", None),
        (far, 1e12, r"at most (\S+) LU are possible", None),
    ],
)  # fmt: skip
def test_what_is_said_to_be_possible_is_and_no_more(
    tables: Callable[[float], dict[str, Any]], too_much: float, told: str, more: float | None
) -> None:
    possible = refused(tables(too_much), told)
    written(tables(possible if more else possible * (1.0 - FIGURES)))
    refused(tables(possible + more if more else possible * (1.0 + FIGURES)), told)


def test_the_limits_are_those_of_the_documentation() -> None:
    """5000 opposite particles within reach; 10⁹ spacings on a plane; an even chain on a circle."""
    assert refused(reaching(2.501), r"5\d+ opposite ones, at most 5000 .*cutoff below (\S+) LU") == 2.5
    assert refused(far(1e12), r"at most (\S+) LU are") == pytest.approx(1e9, rel=FIGURES)
    assert refused(wide(80), r"at most (\d+) particles") == 60
    assert refused(narrow(2.5, "auto"), r"below (\S+) LU") == 2.0


def test_a_way_too_short_for_a_mean_is_not_advised() -> None:
    """Four spacings: a run-in and three periods."""
    rooms = []
    for particles in range(18, 42, 2):
        with pytest.raises(SettingsError, match="too short for the sliding distance") as caught:
            written(slide(60.0, particles=particles, upper_particles=12))
        rooms += re.findall(r"a distance of at most (\S+) LU|$", str(caught.value))[:1]
    assert "" in rooms
    assert 4.0 * 0.8 <= min(float(room) for room in rooms if room) < 4.0 / 0.8


@pytest.mark.parametrize("particles", [3, 301])
def test_springs_are_refused_whose_last_digit_is_more_force_than_may_be_left(particles: int) -> None:
    """Half a unit of the last digit of a place is to be a tenth of the tolerance of a pair's largest tension."""

    def stiff(stiffness: float) -> dict[str, Any]:
        return chains(100.0, stiffness, bodies={"particles": particles}, experiment=path(0.01))

    told = r"Use (\S+) FU/LU, which is practically rigid"
    digit = 0.5 * math.ulp(FREE + 0.01 + (0.5 * (particles - 1)) ** 2 / 200.0)
    stiffest = 0.1 * 1e-3 * TENSION / digit
    assert refused(stiff(1e15), told) == float(f"{0.3 * stiffest:.1g}")
    written(stiff(0.999 * stiffest))
    refused(stiff(1.001 * stiffest), told)


@pytest.mark.parametrize("height", [0.99, 1.01])
def test_an_apex_may_stand_a_thousand_times_the_reach_of_all_forces_above_its_neighbours(height: float) -> None:
    """Half a spacing beside the apex of an even chain; an odd one has a particle there."""
    cutoff = written(chains(100.0, experiment=path(0.01))).cutoff
    for particles in (20, 21):
        of = chains(0.125 / (height * 1e3 * cutoff), bodies={"particles": particles}, experiment=path(0.0))
        if height > 1.0 and particles == 20:
            assert refused(of, r"rises by (\S+) LU from its apex") == pytest.approx(height * 1e3 * cutoff, rel=FIGURES)
        else:
            written(of)


def test_a_system_is_refused_that_the_machine_has_no_memory_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """2 kB for each particle, and 8 bytes for each of the pairs within reach."""
    memory = {"SC_PHYS_PAGES": 1, "SC_PAGE_SIZE": 0}
    of = chains(100.0, bodies={"particles": 1000, "spacing": 0.8}, experiment=path(0.01))
    needed = 1000 * (2000.0 + 8.0 * (2.0 * written(of).cutoff / 0.8 + 2.0))
    monkeypatch.setattr(os, "sysconf", lambda name: memory[name])
    memory["SC_PAGE_SIZE"] = math.ceil(needed)
    written(of | {"title": "enough"})
    memory["SC_PAGE_SIZE"] = round(0.999 * needed)
    told = refused(of | {"title": "too little"}, r"need about (\S+) GB")
    assert told == pytest.approx(needed / 1e9, rel=0.05)  # two digits at least
    flat = chains(3.6e12, experiment=LOAD)
    assert 1e7 < refused(flat, r"the contact would need (\S+) particles per body, more than 1e\+07") < 1.03e7


@pytest.mark.parametrize(
    ("tables", "told"),
    [
        (slide(40_000.01), r"the slide would need (\d+) load steps"),
        (
            chains(100.0, bodies={"particles": 20}, experiment=path(999_998.5 * 0.05 * FREE, 0.0)),
            r"the path would need (\d+)",
        ),
    ],
)
def test_rows_beyond_a_million_are_counted(tables: dict[str, Any], told: str) -> None:
    """20 of a spacing of 0.8 LU; three places, and a move for each twentieth of the free distance in an approach."""
    assert refused(tables, told) == 1_000_001


def test_as_many_timesteps_as_lammps_counts_are_possible() -> None:
    def held(mass: float) -> dict[str, Any]:
        damped = TIMED | {"damping": {"coefficient": 0.3}}
        return chains(100.0, bodies={"particles": 20}, **damped, plate={"mass": mass, "damping": 0.0})

    most = 1e10 * (2**31 / written(held(1e10)).number("row_steps")) ** 2
    written(held((1.0 - FIGURES) * most))
    assert refused(held((1.0 + FIGURES) * most), r"would need (\S+) timesteps, at most 2147483647") > 2**31 - 1
