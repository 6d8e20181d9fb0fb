"""docs/scene.md lists every key of a scene: it is made from the tables themselves, so it cannot drift.

Renew it with WRITE_DOCS=1 pytest tests/unit/test_scene_reference.py.
"""

from __future__ import annotations

import os
from pathlib import Path

from contact1d.workflow import scene as scenes
from contact1d.workflow.scene import effects, tables
from contact1d.workflow.scene.kinds import Cycles
from contact1d.workflow.scene.quantities import Table, keys_of
from contact1d.workflow.scene.schema import described
from contact1d.workflow.scene.si_text import example, in_words

PAGE = Path(__file__).parents[2] / "docs" / "scene.md"
HEAD = """# Every key of a scene

Made from the tables of `workflow/scene`. Units: LU length, FU force, MU mass, TU = √(MU·LU/FU), k_BT in FU·LU.
A table that is absent adds nothing to the deck; tables that contradict each other are reported with a suggested fix.
Above the first table stands `title = "…"`, one line of text, required.

Instead of a number in model units, any quantity may be text with a unit of the same dimension: `radius = "10 mm"`,
also in lists, after `--set` and in `with_`. LU, FU and MU are then those of `[material]`: `length_unit`, `force_unit`,
`mass_unit`. Where these are absent, and no number without a unit other than 0 needs them, they are 1 m, 1 N and 1 kg,
and TU is 1 s; the scene in the run folder states them. A temperature may be in K or °C, and is stored as k_BT.

| in model units | what | as text, for example |
| --- | --- | --- |
"""
RESULTS = """
# What results.json holds

Every quantity is `{"value", "uncertainty", "unit"}`; where LU and FU are known it has `si`, the same in SI. A
pressure also has its `state`. A `value` is `null` where the uncertainty is more than half of it
([with exceptions](uncertainty.md)); the warning `unknown` names it. Beside:

| key | what |
| --- | --- |
"""
BESIDE = {
    "`theory`": 'every closed form that applies, a list of `{"name", "source", "applies", "values"}`: its name (Hertz, '
    "Sneddon, JKR …), its reference, why it holds here, and for each result that it predicts "
    '`{"value", "unit", "si", "deviation"}`, the deviation being the run\'s value over it minus 1',
    "`validity`": 'numbers of the contact and the limits of the theory, a list of `{"name", "quantity", "value", '
    '"limit", "holds"}`; one that does not hold has a warning of its name',
    "`units`": "one LU and one FU in SI, where they are known",
    "`reduction`": "the reduction of the numbers; `image_…` is a length of the one-dimensional image, not of the body",
    "`scene`, `experiment`, `method`, `effects`": "what ran",
    "`status`, `warnings`": '`done` or `failed`; limitations of the numbers, each `{"name", "message"}`',
    "`accuracy`": "the tolerance of the final settings, and how often it was lowered",
    "`timing`, `versions`": "seconds (`total_s` of the run, `lammps_s` of it in LAMMPS, `rows_s` of that for the load "
    "steps, without setup and files of states) and steps; versions of the software",
}
TABLES = {
    "bodies": scenes.Bodies,
    "bodies.profile, kind parabola": scenes.Parabola,
    "bodies.profile, kind circle": scenes.Circle,
    "bodies.profile, kind ellipsoid": scenes.Ellipsoid,
    "bodies.profile, kind cone": scenes.Cone,
    "bodies.profile, kind flat_punch": scenes.FlatPunch,
    "bodies.profile, kind power": scenes.Power,
    "bodies.profile, kind table": scenes.Measured,
    "interaction": effects.Interaction,
    "interaction.repulsion, interaction.attraction": effects.Exponential,
    "neighbours": effects.Neighbours,
    "horizontal": effects.Horizontal,
    "adhesion": effects.Adhesion,
    "adhesion.rate": effects.Rate,
    "viscoelasticity": effects.Viscoelasticity,
    "viscoelasticity.terms, each": effects.Term,
    "friction": effects.Friction,
    "damping": scenes.Damping,
    "noise": effects.Noise,
    "plate": scenes.Plate,
    "cantilever": effects.Cantilever,
    "material": scenes.Material,
    "material.upper, material.lower": scenes.Elastic,
    "accuracy": tables.Accuracy,
    "output": tables.Output,
    "experiment, kind load": scenes.Load,
    "experiment, kind path": scenes.Path,
    "experiment.displacements, as a table": scenes.Span,
    "experiment, kind pull_off": scenes.PullOff,
    "experiment, kind slide": scenes.Slide,
    "experiment, kind tangential": scenes.Tangential,
    "experiment.cycles": Cycles,
    "experiment, kind hold": scenes.Hold,
    "experiment, kind history": scenes.History,
    "experiment, kind impact": scenes.Impact,
}


SHOWN = ("LU", "FU", "FU/LU", "FU·LU", "FU/LU²", "MU", "TU", "LU/TU", "FU·TU/LU")
"""Units of the model in the page's first table."""


def written(default: object) -> str:
    """A default as it stands in a scene file; words without their quotes."""
    return str(default).lower() if isinstance(default, bool) else str(default)


def head() -> str:
    rows = [f'| {unit} | {in_words(unit).partition(", such as")[0]} | `"{example(unit)}"` |' for unit in SHOWN]
    return HEAD + "\n".join(rows) + "\n"


def section(name: str, table: type[Table]) -> str:
    lines = [f"\n## [{name}]\n", (table.__doc__ or "").strip().splitlines()[0] + "\n"]
    keys = keys_of(table)
    if keys:
        lines.append("| key | what | must be | absent |\n| --- | --- | --- | --- |")
    for word, key in keys.items():
        info = table.model_fields[key.field]
        default = "required" if info.is_required() else "none" if info.default is None else f"`{written(info.default)}`"
        what = key.description.replace("|", "\\|")
        lines.append(f"| `{word}` | {what} | {described(key.allowed)} | {default} |")
    return "\n".join(lines) + "\n"


def test_the_page_of_all_keys_is_what_the_tables_say() -> None:
    page = head() + "".join(section(name, table) for name, table in TABLES.items())
    page += RESULTS + "".join(f"| {key} | {what} |\n" for key, what in BESIDE.items())
    if os.environ.get("WRITE_DOCS"):
        PAGE.write_text(page, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page


def test_every_table_of_a_scene_is_on_the_page() -> None:
    named = {name.split(",")[0].split(".")[0] for name in TABLES}
    assert named | {"title"} == set(keys_of(scenes.Scene))
