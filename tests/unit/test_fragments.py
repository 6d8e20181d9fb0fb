"""Fragments: each header agrees with its text, and a deck whose parts do not fit together is refused."""

from __future__ import annotations

import re
import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

import contact1d.workflow.deck.fragments as fragments_module
from contact1d import Scene
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects import EFFECTS, Contribution
from contact1d.workflow.deck.effects.neighbours import neighbours
from contact1d.workflow.deck.fragments import DeckError, fragment
from contact1d.workflow.deck.steps import Displace, Hold, Phase, UnderLoad
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import EFFECTS as SCENE_EFFECTS

MakeScene = Callable[..., Scene]

ROOT = Path(__file__).parents[2] / "lammps_inputs" / "fragments"
NAMES = sorted(path.relative_to(ROOT).with_suffix("").as_posix() for path in ROOT.rglob("*.lmp"))
DEFINITION = re.compile(r'(?:^|then +")(variable|group|fix|compute)\s+(\w+)\s+(\w+)', re.MULTILINE)


def text_of(name: str) -> str:
    return (ROOT / f"{name}.lmp").read_text(encoding="utf-8")


def commands_of(name: str) -> str:
    """The text without comments, continued lines joined."""
    lines = [line for line in text_of(name).splitlines() if not line.lstrip().startswith("#")]
    return "\n".join(lines).replace("&\n", " ") + "\n"


def header_of(name: str, key: str) -> set[str]:
    """Words of one header line, explanations in brackets left out."""
    lines = [line for line in text_of(name).splitlines() if line.startswith(f"# {key}: ")]
    assert len(lines) == 1 or (key == "Redefines" and not lines), f"{name} has {len(lines)} lines {key}"
    return {word for line in lines for word in re.sub(r"\(.*?\)", "", line.split(": ", 1)[1]).split()} - {"-"}


@pytest.mark.parametrize("name", NAMES)
def test_header_has_four_lines_at_the_top(name: str) -> None:
    keys = [line.split(":")[0].removeprefix("# ") for line in text_of(name).splitlines() if line.startswith("#")]
    assert [key for key in keys if key in ("Purpose", "Formula", "Needs", "Defines")] == [
        "Purpose", "Formula", "Needs", "Defines",
    ]  # fmt: skip
    assert text_of(name).startswith("# Purpose: ")
    assert text_of(name).endswith("\n")
    assert text_of(name).isascii()  # LAMMPS warns of anything else


@pytest.mark.parametrize("name", NAMES)
def test_header_agrees_with_the_text(name: str) -> None:
    """What it needs is used and not defined in it; what it defines is what its commands define."""
    commands = commands_of(name)
    read = set(re.findall(r"\$\{(\w+)\}", commands)) | set(re.findall(r"\bv_(\w+)", commands))
    defined = [found[1] for found in DEFINITION.findall(commands) if found[2] != "delete"]
    assert header_of(name, "Needs") == read - set(defined)
    assert set(defined) == header_of(name, "Defines") | header_of(name, "Redefines")
    assert [word for word, count in Counter(defined).items() if count > 1] == []
    assert set(fragment(name).needs) == header_of(name, "Needs")
    assert set(fragment(name).defines) == header_of(name, "Defines")
    assert set(fragment(name).redefines) == header_of(name, "Redefines")


@pytest.mark.parametrize("name", NAMES)
def test_fixes_and_computes_are_named_after_their_fragment(name: str) -> None:
    """`<effect>_<role>`; a step may redefine an effect's."""
    owner = name.split("/")[-1].replace("standing_plane", "rigid_plane")
    for end in ("_opposite", "_energy", "_alone"):  # a part, or another kind, of what has the name before
        owner = owner.removesuffix(end)
    for kind, identity, _ in DEFINITION.findall(commands_of(name)):
        if kind in ("fix", "compute") and identity not in header_of(name, "Redefines"):
            assert identity.startswith(f"{owner}_")


def test_every_effect_is_a_table_and_a_fragment() -> None:
    """Scene table = effect = fragment, in the same order."""
    assert tuple(EFFECTS) == SCENE_EFFECTS
    for name in EFFECTS:
        assert name in NAMES


@pytest.fixture
def fakes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the fragments which a test may change; the program reads it instead."""
    folder = tmp_path / "fragments"
    shutil.copytree(ROOT, folder)
    monkeypatch.setattr(fragments_module, "files", lambda _: tmp_path)
    fragment.cache_clear()
    yield folder
    fragment.cache_clear()


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize("key", ["Purpose", "Formula", "Needs", "Defines"])
def test_a_header_line_that_is_missing_raises(fakes: Path, key: str) -> None:
    change(fakes / "noise.lmp", f"# {key}: ", "# ")
    with pytest.raises(DeckError, match=f"fragment noise: the header has no line '# {key}: …'"):
        fragment("noise")


def test_a_fragment_that_uses_what_it_does_not_declare_raises(fakes: Path) -> None:
    change(fakes / "damping.lmp", "# Needs: damping_coefficient", "# Needs: -")
    with pytest.raises(DeckError, match="fragment damping: uses damping_coefficient"):
        fragment("damping")


def test_a_fragment_that_needs_what_it_does_not_use_raises(fakes: Path) -> None:
    change(fakes / "damping.lmp", "# Needs: damping_coefficient", "# Needs: damping_coefficient time_step")
    with pytest.raises(DeckError, match="fragment damping: its header needs time_step"):
        fragment("damping")


def with_part(monkeypatch: pytest.MonkeyPatch, part: Callable[[Scene, object], Contribution]) -> None:
    monkeypatch.setitem(EFFECTS, "neighbours", part)


def test_a_variable_used_but_not_defined_raises(make_scene: MakeScene, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = make_scene(neighbours={"stiffness": 0.3})
    deck = Deck(scene, settings_for(scene))
    with_part(monkeypatch, lambda s, t: replace(neighbours(s, t), variables={}))
    with pytest.raises(DeckError, match="used but not defined: neighbours_bond_coefficient"):
        deck.head  # noqa: B018 (rendering it is the test)


def test_a_variable_defined_but_not_used_raises(make_scene: MakeScene, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = make_scene(neighbours={"stiffness": 0.3})
    deck = Deck(scene, settings_for(scene))
    more = {"neighbours_bond_coefficient": "0.15", "neighbours_spare": "1"}
    with_part(monkeypatch, lambda s, t: replace(neighbours(s, t), variables=more))
    with pytest.raises(DeckError, match="defined but not used: neighbours_spare"):
        deck.head  # noqa: B018 (rendering it is the test)


def test_a_variable_defined_twice_raises(make_scene: MakeScene, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = make_scene(neighbours={"stiffness": 0.3})
    deck = Deck(scene, settings_for(scene))
    more = {"neighbours_bond_coefficient": "0.15", "interaction_skin": "1"}
    with_part(monkeypatch, lambda s, t: replace(neighbours(s, t), variables=more))
    with pytest.raises(DeckError, match="defined twice: interaction_skin"):
        deck.head  # noqa: B018 (rendering it is the test)


def test_an_id_defined_twice_raises(make_scene: MakeScene, fakes: Path) -> None:
    """Two fragments that define one group: with the real text, LAMMPS would silently go on."""
    change(fakes / "neighbours.lmp", "# Defines: -\n", "# Defines: lower (group)\ngroup           lower type 1\n")
    scene = make_scene(neighbours={"stiffness": 0.3})
    with pytest.raises(DeckError, match="defined twice: lower"):
        Deck(scene, settings_for(scene)).head  # noqa: B018 (rendering it is the test)


def test_two_pair_styles_raise(make_scene: MakeScene, monkeypatch: pytest.MonkeyPatch) -> None:
    """The later one would silently take the place of the first."""
    scene = make_scene(neighbours={"stiffness": 0.3})
    with_part(monkeypatch, lambda s, t: replace(neighbours(s, t), pair_style="zero 1.0"))
    with pytest.raises(DeckError, match="a pair_style, of which a deck has one: interaction, neighbours"):
        Deck(scene, settings_for(scene)).head  # noqa: B018 (rendering it is the test)


def test_a_step_that_needs_what_the_head_does_not_define_raises(make_scene: MakeScene) -> None:
    """A plate is held by its force, which only [plate] knows."""
    scene = make_scene()
    hold = Phase("loading", (Hold(1, 0.1, 0.1, 0.1, 0.1, -1.0, 1.0, 10),))
    with pytest.raises(DeckError, match="used but not defined: damping_viscous, plate_force, plate_load,"):
        Deck(scene, settings_for(scene)).text((hold,))


def test_a_step_that_redefines_without_a_word_raises(make_scene: MakeScene, fakes: Path) -> None:
    change(fakes / "steps/load.lmp", "# Redefines: plate_load (fix)\n", "")
    change(fakes / "steps/load.lmp", "# Defines: -", "# Defines: plate_load (fix)")
    scene = make_scene(damping={"coefficient": "auto"}, plate={}, experiment={"kind": "load", "force": 0.1})
    with pytest.raises(DeckError, match="defined twice: plate_load, by plate and by steps/load"):
        Deck(scene, settings_for(scene)).text((Phase("loading", (UnderLoad(0.1, 10),)),))


def test_a_phase_without_rows_is_left_out(make_scene: MakeScene) -> None:
    scene = make_scene()
    deck = Deck(scene, settings_for(scene))
    rows = Phase("loading", (Displace(0.0),))
    assert deck.text((rows, Phase("separating", ()))) == deck.text((rows,))
