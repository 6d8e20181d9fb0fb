"""Claim: without an effect a deck has none of its lines, and otherwise the same; headers agree with their texts.

What a fragment adds is in `lammps_inputs/fragments`; its header names what it needs and what it defines.
"""

import re
from collections import Counter
from collections.abc import Iterable
from typing import Any

import pytest

from tests.decks.test_run_folder import PAIR, SCENES, STICKY, STUCK
from tests.decks.written import Written, written
from tests.scenes import ROOT

FRAGMENTS = ROOT / "lammps_inputs" / "fragments"
PATH = {"kind": "path", "displacements": [0.0, 0.05]}
DRAG, GUIDE = "variable        damping_coefficient index …", "variable        guide_x index …"
NUMBER = re.compile(r"(?<= )-?\d\S*")


def lines(name: str) -> list[str]:
    """Commands of a fragment."""
    return [line for line in (FRAGMENTS / f"{name}.lmp").read_text(encoding="utf-8").splitlines() if line[0] != "#"]


def header(name: str, *keys: str) -> set[str]:
    """Names in lines of a fragment's header, explanations in brackets left out."""
    text = (FRAGMENTS / f"{name}.lmp").read_text(encoding="utf-8")
    found = [re.findall(rf"^# {key}: (.*)$", text, re.MULTILINE)[0] for key in keys]
    return {word for line in found for word in re.sub(r"\(.*?\)", "", line).split()} - {"-"}


@pytest.mark.parametrize(
    "name", sorted(path.relative_to(FRAGMENTS).with_suffix("").as_posix() for path in FRAGMENTS.rglob("*.lmp"))
)
def test_a_fragments_header_agrees_with_its_text(name: str) -> None:
    """Four lines at the top; what it needs is used and not defined in it, and what it defines its commands define."""
    text = (FRAGMENTS / f"{name}.lmp").read_text(encoding="utf-8")
    assert re.match("# Purpose: .+\n# Formula: .+\n# Needs: .+\n# Defines: .+\n", text)
    assert text.isascii()  # LAMMPS warns of anything else
    commands = "\n".join(lines(name)).replace("&\n", " ")
    found = re.findall(r'(?:^|then +")(variable|group|fix|compute)\s+(\w+)\s+(\w+)', commands, re.MULTILINE)
    defined = {identity for _, identity, style in found if style != "delete"}
    read = {name for pair in re.findall(r"\$\{(\w+)\}|\bv_(\w+)", commands) for name in pair} - {""}
    assert header(name, "Needs") == read - defined
    assert header(name, "Defines") | (header(name, "Redefines") if "# Redefines" in text else set()) == defined


def head(deck: Written) -> Counter[str]:
    """Lines before the schedule, numbers left out, without the one that lists the effects."""
    whole = deck.text.partition("\n# phase ")[0].splitlines()
    return Counter(NUMBER.sub("…", line) for line in whole if line and not line.startswith("# effects: "))


@pytest.mark.parametrize(
    ("tables", "effect", "fragments", "instead"),
    [
        (STICKY | {"experiment": PATH}, "neighbours", ["neighbours", "neighbour_springs"], []),
        (SCENES["path"], "horizontal", ["horizontal"], [GUIDE]),
        (SCENES["load_thermal"], "noise", ["noise"], [DRAG, *lines("damping")]),
        (STUCK | {"experiment": PATH}, "adhesion", ["adhesion"], []),
        (
            SCENES["path"] | {"bodies": SCENES["path"]["bodies"] | {"bulk_stiffness_tangential": 1.4}},
            "horizontal",
            ["horizontal", "far", "far_springs"],
            [GUIDE],
        ),
    ],
)  # fmt: skip
def test_without_an_effect_its_lines_and_variables_are_gone_and_no_others(
    tables: dict[str, Any], effect: str, fragments: list[str], instead: Iterable[str]
) -> None:
    more, fewer = (head(written({"title": "one"} | one)) for one in (tables, tables | {effect: None}))
    own = {NUMBER.sub("…", line) for name in fragments for line in lines(name)}
    removed = {line for line in more - fewer if line[0] != "#"} - own
    assert {line.split()[1] for line in removed} == set().union(*(header(name, "Needs") for name in fragments)) - {
        "plate_displacement", "bulk_bond_coefficient",
    }  # fmt: skip
    added = {line for line in fewer - more if line[0] != "#"}
    assert added == {NUMBER.sub("…", line) for line in instead}


def test_no_attraction_in_the_table_without_attraction() -> None:
    """Nor in its header; the deck's head differs in numbers only."""
    attracting = SCENES["path"] | {"title": "one"}
    both, alone = (written(attracting | {"interaction": one}) for one in (PAIR, {"repulsion": PAIR["repulsion"]}))
    claims, _, rows = alone.files["interaction.table"].partition("DOUBLE_EXPONENTIAL")
    assert claims.count("exp(") == 1
    assert min(float(row.split()[3]) for row in rows.splitlines()[3:]) > 0.0
    assert head(alone) == head(both)
