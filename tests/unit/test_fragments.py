"""Claim: a deck whose fragments do not fit together, or whose headers do not agree with their texts, is refused."""

import shutil
from pathlib import Path
from typing import Any

import pytest

import contact1d.workflow.deck.fragments as fragments
from tests.decks.written import written
from tests.scenes import ROOT, chains

FRAGMENTS = ROOT / "lammps_inputs" / "fragments"
TABLES: dict[str, Any] = chains(
    100.0, bodies={"particles": 20}, neighbours={"stiffness": 0.3}, damping={"coefficient": "auto"}, plate={},
    noise={"temperature": 1e-4, "seed": 1}, experiment={"kind": "load", "force": 0.1},
)  # fmt: skip
SKIN = "interaction_skin"


@pytest.mark.parametrize(
    ("name", "changes", "told"),
    [
        ("noise", {"# Formula: ": "# "}, "fragment noise: the header has no line '# Formula: …'"),
        ("interaction", {f"# Needs: {SKIN}": "# Needs: -"}, f"fragment interaction: uses {SKIN}"),
        ("interaction", {f"{SKIN}\n": f"{SKIN} spare\n"}, "fragment interaction: its header needs spare"),
        ("interaction", {SKIN: "spare"}, "used but not defined: spare, in interaction"),
        ("interaction", {f"# Needs: {SKIN}": "# Needs: -", f"${{{SKIN}}}": "1"}, f"defined but not used: {SKIN}"),
        ("neighbour_springs", {"# Defines: -\n": "# Defines: lower (group)\n"}, "defined twice: lower"),
        (
            "steps/load",
            {"# Needs: ": "# Needs: spare ", "${row_steps}": "$(v_row_steps+v_spare)"},
            "not defined: spare",
        ),
        (
            "steps/load",
            {"# Redefines: plate_load (fix)\n": "", "# Defines: -": "# Defines: plate_load (fix)"},
            "defined twice: plate_load, by plate and by steps/load",
        ),
    ],
)
def test_fragments_that_do_not_fit_are_refused(
    name: str, changes: dict[str, str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The program reads a copy in which one fragment is changed."""
    shutil.copytree(FRAGMENTS, tmp_path / "fragments")
    path = tmp_path / "fragments" / f"{name}.lmp"
    text = path.read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    monkeypatch.setattr(fragments, "files", lambda _: tmp_path)
    fragments.fragment.cache_clear()
    with pytest.raises(fragments.DeckError) as caught:
        written(TABLES)
    fragments.fragment.cache_clear()
    assert told in str(caught.value)
