"""Claim: a material's name stands for its numbers, wherever a body's elasticity does; each number has its source.

docs/materials.md is made from the table. Renew it with WRITE_DOCS=1 pytest tests/unit/test_materials.py.
"""

import os
import tomllib
from typing import Any

import pytest

import contact1d
from contact1d import Scene, SceneError, read_scene
from tests.command import contact1d as command
from tests.scenes import ROOT, STEEL_ON_GLASS

PAGE = ROOT / "docs" / "materials.md"
MATERIALS = tomllib.loads((ROOT / "workflow" / "scene" / "materials.toml").read_text(encoding="utf-8"))
HEAD = """# Named materials

`upper = "steel"` in `[material]` of a scene, or in a file of `contact1d identify`, stands for Young's modulus and
Poisson's ratio of this table; `contact1d materials` prints both and their source. `scene.toml` in the run folder has
the numbers in place of the name. Capital letters make no difference, and `_` and `-` count as spaces.

The values are typical ones at room temperature, of isotropic bodies. Metals and glasses differ from them by some
percent, plastics by up to a third, rubbers by a factor of several: measure the modulus of your material, and write
`upper = { youngs_modulus = "3 MPa", poisson_ratio = 0.5 }`.

| name | also | Young's modulus | Poisson's ratio | note | source |
| --- | --- | --- | --- | --- | --- |
"""


def scene(upper: Any) -> Scene:
    return read_scene(STEEL_ON_GLASS).with_({"material.upper": upper, "material.lower": "glass"})


def test_a_scene_keeps_the_numbers_of_its_names() -> None:
    kept = tomllib.loads(str(scene("steel")))
    assert kept["material"]["upper"] == {"youngs_modulus": 210e9, "poisson_ratio": 0.3}


@pytest.mark.parametrize(
    ("name", "same"), [("Stainless Steel", "stainless_steel"), ("natural-rubber", "rubber"), ("sapphire", "alumina")]
)
def test_names_are_read_as_they_are_meant_wherever_a_body_is(name: str, same: str) -> None:
    assert scene(name) == scene(same) == read_scene(scene("steel"), [f"material.upper={name}"])
    ball = contact1d.sphere("10 mm", upper=name, lower="glass").scene("load", force="1 N")
    assert ball.material == scene(same).material


def test_every_material_is_one_of_a_scene_and_has_a_source() -> None:
    for name, entry in MATERIALS.items():
        numbers = {key: entry[key] for key in ("youngs_modulus", "poisson_ratio")}
        assert scene(name) == scene(numbers), name
        upper = scene(name).tables["material"]["upper"]
        assert 1e4 < upper["youngs_modulus"] < 1.3e12, name
        assert 0.0 < upper["poisson_ratio"] <= 0.5, name
        assert len(entry["source"]) > 10, name


@pytest.mark.parametrize(
    ("upper", "words"),
    [
        ("stele", 'did you mean "steel"? names: steel, stainless_steel, aluminium'),
        (5, "material.upper = 5: must be a table with youngs_modulus, poisson_ratio, yield_strength, or a name"),
    ],
)
def test_a_name_that_is_none_is_one_sentence(upper: Any, words: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene(upper)
    (problem,) = caught.value.problems
    assert words in str(problem)


def test_the_command_lists_them() -> None:
    done = command("materials")
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
