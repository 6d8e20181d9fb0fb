"""Claim: a material's name stands for its numbers, wherever a body's elasticity does; each number has its source.

docs/materials.md is made from the table. Renew it with WRITE_DOCS=1 pytest tests/unit/test_materials.py.
"""

from __future__ import annotations

import math
import os
import tomllib
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import contact1d
from contact1d import SceneError, read_scene
from contact1d.__main__ import app
from contact1d.workflow.identify.contact import read_contact
from contact1d.workflow.runs.plausibility import SOFTEST, STIFFEST
from contact1d.workflow.scene.materials import MATERIALS
from contact1d.workflow.scene.si_text import si_value

PAGE = Path(__file__).parents[2] / "docs" / "materials.md"
HEAD = """# Named materials

`upper = "steel"` in `[material]` of a scene, or in a file of `contact1d identify`, stands for Young's modulus and
Poisson's ratio of this table; `contact1d materials` prints it. The scene that ran has the numbers themselves, and needs
the table no more. Capitals, spaces, `_` and `-` make no difference.

The values are typical ones at room temperature, of isotropic bodies. Metals and glasses differ from them by some
percent, plastics by a third, rubbers by a factor: where a result depends on it, measure the modulus, and write
`upper = { youngs_modulus = "3 MPa", poisson_ratio = 0.5 }`.

| name | also | Young's modulus | Poisson's ratio | note | source |
| --- | --- | --- | --- | --- | --- |
"""


def scene(upper: Any, lower: Any = "glass") -> dict[str, Any]:
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane",
              "profile": {"kind": "parabola", "radius": "10 mm"}}  # fmt: skip
    experiment = {"kind": "load", "force": "1 N"}
    return {"title": "x", "bodies": bodies, "material": {"upper": upper, "lower": lower}, "experiment": experiment}


def message(upper: Any) -> str:
    with pytest.raises(SceneError) as caught:
        read_scene(scene(upper))
    return str(caught.value)


def test_steel_on_glass_is_hertzs_and_keeps_its_numbers() -> None:
    done = contact1d.run(scene("steel"), figures=False)
    modulus = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
    found = done.results["contact_radius"].si
    assert found is not None
    assert abs(found.value - math.cbrt(0.75 * 0.01 / modulus)) <= found.uncertainty
    kept = tomllib.loads((done.folder / "scene.toml").read_text(encoding="utf-8"))
    assert kept["material"]["upper"] == {"youngs_modulus": 210e9, "poisson_ratio": 0.3}


@pytest.mark.parametrize(
    ("name", "same"),
    [("Stainless Steel", "stainless_steel"), ("rubber", "natural-rubber"), ("pdms", "PDMS"), ("sapphire", "alumina")],
)
def test_names_are_read_as_they_are_meant(name: str, same: str) -> None:
    assert read_scene(scene(name)) == read_scene(scene(same))


@pytest.mark.parametrize("name", MATERIALS)
def test_every_material_is_one_of_a_scene_and_has_a_source(name: str) -> None:
    read = read_scene(scene(name)).material
    assert read is not None
    assert read.upper is not None
    assert read.upper.youngs_modulus == float(si_value(MATERIALS[name]["youngs_modulus"], "Pa")[0])
    assert SOFTEST < read.upper.youngs_modulus < STIFFEST
    assert 0.0 < read.upper.poisson_ratio <= 0.5
    assert len(MATERIALS[name]["source"]) > 10
    assert read_scene(tomllib.loads(str(read_scene(scene(name))))).material == read


@pytest.mark.parametrize(
    ("upper", "words"),
    [
        ("stele", 'did you mean "steel"? names: steel, stainless_steel, aluminium'),
        ("kryptonite", 'name such as "steel", or "rigid"; names: steel, stainless_steel'),
        ("210 GPa", 'must be a table with youngs_modulus, poisson_ratio, yield_strength, or a name such as "steel"'),
        (5, "material.upper = 5: must be a table with youngs_modulus, poisson_ratio, yield_strength, or a name"),
    ],
)
def test_a_name_that_is_none_is_one_sentence(upper: Any, words: str) -> None:
    printed = message(upper)
    assert words in printed
    assert "\n" not in printed


def test_a_contact_and_a_change_take_names_too() -> None:
    contact = read_contact({"radius": "10 mm", "upper": "rubber", "lower": "rigid", "load": "1 mN"})
    assert contact.contact_modulus == pytest.approx(2e6 / 0.75, rel=1e-12)  # round-off
    changed = read_scene(scene("steel")).with_({"material.upper": "diamond"})
    assert changed == read_scene(scene("diamond"))
    assert changed == read_scene(scene("steel"), ["material.upper=diamond"])


def test_the_command_lists_them() -> None:
    done = CliRunner().invoke(app, ["materials"])
    assert done.exit_code == 0
    for line, (name, one) in zip(done.output.splitlines(), MATERIALS.items(), strict=True):
        assert line.startswith(name)
        assert all(str(one[key]) in line for key in ("youngs_modulus", "poisson_ratio", "source"))


def test_the_page_is_what_the_table_says() -> None:
    rows = (
        f"| `{name}` | {', '.join(one.get('aliases', ()))} | {one['youngs_modulus']} | {one['poisson_ratio']} | "
        f"{one.get('note', '')} | {one['source']} |\n"
        for name, one in MATERIALS.items()
    )
    page = HEAD + "".join(rows).replace("<", "\\<")
    if os.environ.get("WRITE_DOCS"):
        PAGE.write_text(page, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page
