"""The tables of small scenes, for tests that say only what is their own; folders, and what a JSON file says."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from contact1d import SceneError, read_scene

ROOT = Path(__file__).parents[1]
"""The folder of the project."""
SCENES = ROOT / "lammps_inputs" / "scenes"
"""The folder of the scenes that come with it."""
LAW = (0.18, 0.13, 0.09, 0.26)
"""A [FU·LU], a [LU], B [FU·LU], b [LU] of V(r) = A exp(−r/a) − B exp(−r/b)."""
STEEL_ON_GLASS = """
title = "Steel on glass"

[bodies]
particles = "auto"
spacing = "4 µm"
profile = { kind = "parabola", radius = "10 mm" }
bulk_stiffness = "auto"
lower = "rigid_plane"

[material]
upper = { youngs_modulus = "210 GPa", poisson_ratio = 0.3 }
lower = { youngs_modulus = "70 GPa", poisson_ratio = "22 %" }

[experiment]
kind = "load"
force = "10 N"
"""
"""A scene in SI, every number of which has a unit."""
MODULUS = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
"""Its E* [Pa]."""


def chains(radius: float, stiffness: float = 0.83, law: Sequence[float] = LAW, **tables: Any) -> dict[str, Any]:
    """A scene of two chains: a parabola of this `radius` [LU], springs to the bulk of this `stiffness` [FU/LU].

    The chains are as long as the contact needs and have a spacing of 1 LU, unless keys of bodies={…} say otherwise.
    Other tables come as they are; None leaves one out.
    """
    profile = {"kind": "parabola", "radius": radius}
    bodies = {"particles": "auto", "spacing": 1.0, "profile": profile, "bulk_stiffness": stiffness}
    near, far = ({"amplitude": law[i], "range": law[i + 1]} for i in (0, 2))
    interaction = {"repulsion": near, "attraction": far}
    found = {"title": "chains", "interaction": interaction} | tables | {"bodies": bodies | tables.get("bodies", {})}
    return {name: table for name, table in found.items() if table is not None}


def in_si(profile: dict[str, Any], modulus: str = "1 MPa", **tables: Any) -> dict[str, Any]:
    """A scene in SI of a body on a rigid plane, particles and spacing left open; other tables as they come."""
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile}
    return {"title": "in SI", "bodies": bodies, "material": {"contact_modulus": modulus}} | tables


PLANE = chains(50.0, 0.5, title="plane", interaction=None, bodies={"particles": 21, "lower": "rigid_plane"})
"""Some particles on a rigid plane, for an experiment: the quickest scene there is."""


def read_json(path: Path) -> dict[str, Any]:
    """What a JSON file says."""
    return dict(json.loads(path.read_text(encoding="utf-8")))


def refused(*scene: Any, **folder: Path) -> SceneError:
    """The error of a scene that can't be read, from what `read_scene` is given."""
    with pytest.raises(SceneError) as caught:
        read_scene(*scene, **folder)
    return caught.value
