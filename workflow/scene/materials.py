"""Named materials, "steel": Young's modulus and Poisson's ratio with their source, from `materials.toml`."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from contact1d.workflow.scene.problems import plain

ELASTIC = ("youngs_modulus", "poisson_ratio")
"""The keys of a material that a scene needs."""
MATERIALS: dict[str, dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("materials.toml").read_text(encoding="utf-8")
)
"""Every named material in the order of the file: `ELASTIC`, `source`, and at times `aliases` and `note`."""
BY_NAME = {
    plain(word): {key: material[key] for key in ELASTIC}
    for name, material in MATERIALS.items()
    for word in (name, *material.get("aliases", ()))
}
"""The table that each name and alias stands for in a scene, these as `problems.plain` writes them."""
