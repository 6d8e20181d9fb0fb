"""Scenes with a [material], and the materials."""

from typing import Any

from tests.scenes import chains

STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}
RUBBER = {"youngs_modulus": 2e6, "poisson_ratio": 0.5}
E_STAR = {"contact_modulus": 200e9}
UNITS = {"length_unit": 1e-9, "force_unit": 1e-6}
JKR = E_STAR | {"surface_energy": 1.0}
PULL = {"kind": "pull_off", "preload": 0.3}
PATH = {"kind": "path", "displacements": [0.0, 0.3]}


def tables(material: dict[str, Any] | None = None, experiment: dict[str, Any] = PULL, **bodies: Any) -> dict[str, Any]:
    """A scene; on a rigid plane without its interaction."""
    made = chains(100.0, bodies=bodies, experiment=experiment, material=material)
    if bodies.get("lower") == "rigid_plane":
        del made["interaction"]
    return made
