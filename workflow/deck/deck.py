"""A scene and its schedule as one flat LAMMPS deck; pure text, nothing runs here.

A deck is a head (bodies, effects, method) and a schedule: phases, each a loop over rows. A row moves or loads the plate
and measures. Python runs the very same text, row by row, so that it can choose the next row by what it measured; the
deck that it leaves behind holds the rows of the schedule that the search ended with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TypeVar

from contact1d.workflow.deck.effects import Contribution, contributions
from contact1d.workflow.deck.fragments import DeckError, Fragment, fragment
from contact1d.workflow.deck.parts import bins, moving, own_units, standing
from contact1d.workflow.deck.steps import STEPS, UNITS, Displace, Hold, Phase, Row
from contact1d.workflow.deck.units import DeckUnits, units_for
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

AnyRow = TypeVar("AnyRow", bound=Row)
NUMBERS_PER_LINE = 6


@dataclass(frozen=True)
class Deck:
    """The deck of one scene with its settings; `text` of a schedule is in.lammps."""

    scene: Scene
    settings: Settings

    @cached_property
    def units(self) -> DeckUnits:
        """Those in which the text and system.data are written."""
        return units_for(self.scene)

    @cached_property
    def written(self) -> tuple[Scene, Settings]:
        """Scene and settings in these units."""
        return self.units.scene(self.scene), self.units.settings(self.settings)

    @property
    def stepped(self) -> bool:
        """Whether nothing has to come to rest, so that all rows of a phase are steps of one run."""
        return self.scene.is_stepped

    @cached_property
    def parts(self) -> tuple[Contribution, ...]:
        """What bodies, lower body, effects and method bring, in deck order."""
        scene, settings = self.written
        brought = [*contributions(scene, settings), *(standing if scene.stands else moving)(scene, settings)]
        if self.units.are_own:
            brought.append(own_units(self.units))
        if scene.interaction is not None:
            brought += bins(scene, settings, brought)
        return tuple(sorted(brought, key=lambda part: part.stage))

    @cached_property
    def head(self) -> str:
        """Everything before the schedule.

        Raises:
            DeckError: if fragments and variables do not fit together.
        """
        atom_style = next((part.atom_style for part in self.parts if part.atom_style), "bond")
        styles = [f"pair_style      {part.pair_style}\n" for part in self.parts if part.pair_style]
        bonds = "" if self.scene.stands else "bond_style      harmonic\n"
        styles = [f"atom_style      {atom_style}\n", *styles, bonds]
        blocks = [_block("start", {}) + "".join(styles)]
        for part in self.parts:
            for index, name in enumerate(part.fragments):
                blocks.append(_block(name, part.variables if index == 0 else {}))
        blocks.append(_block(self._output, {}))
        self._check()
        # LAMMPS looks for triple quotes even in comments.
        title = "# {}\n# effects: {}; {}\n".format(
            self.scene.title.replace('"', "'"), ", ".join(self.scene.effects) or "none", self.scene.method
        )
        return title + "\n" + "\n".join(blocks)

    def begin(self, phase: str, fragments: Sequence[str] = ()) -> str:
        """What comes before a phase's rows."""
        return f"variable        row_phase index {phase}\n" + _commands(fragments)

    def row(self, kind: type[Row]) -> str:
        """One row up to its measurement: move or load, then measure."""
        return _commands((*self._before(kind), self._step(kind), *self._measuring, self._line))

    def as_listed(self, row: AnyRow) -> AnyRow:
        """A row that is a step, with its numbers as LAMMPS has those of a list: to 15 digits."""
        numbers = {field.name: getattr(row, field.name) for field in fields(row)}
        read = {
            name: self.units.from_deck(float(f"{self.units.to_deck(value, UNITS[name]):.15g}"), UNITS[name])
            for name, value in numbers.items()
        }
        return replace(row, **read)

    def in_one_run(self, rows: Sequence[Row]) -> str:
        """All rows, each a place of the plate, in one run."""
        columns = zip(*(row.texts(self.units.to_deck) for row in rows), strict=True)
        # A column is one word on one line, as LAMMPS has it.
        given = {name: f"[{','.join(texts)}]" for name, texts in zip(rows[0].columns(), columns, strict=True)}
        given["row_count"] = str(len(rows))
        before = "".join(f"variable        {name} index {value}\n" for name, value in given.items())
        after = "".join(f"variable        {name} delete\n" for name in given)
        return before + _commands((self._step(type(rows[0])),)) + after

    @property
    def row_end(self) -> str:
        """The end of every measurement."""
        return _commands(self._measured)

    def values(self, row: Row) -> str:
        """The variables of one row."""
        texts = row.texts(self.units.to_deck)
        return "".join(f"variable        {c} index {v}\n" for c, v in zip(row.columns(), texts, strict=True))

    def forget(self, kind: type[Row]) -> str:
        """Delete the variables of a row, as `next` does after the last one."""
        return "".join(f"variable        {c} delete\n" for c in kind.columns())

    def state(self, first: bool) -> str:
        """Write the state that the last row left."""
        append = f"variable        state_append index {'no' if first else 'yes'}\n"
        written = _commands((*self._measuring, self._state, *self._measured))
        return append + written + "variable        state_append delete\n"

    def text(self, phases: Sequence[Phase]) -> str:
        """in.lammps: the head and a loop for each phase.

        Raises:
            DeckError: if fragments and variables do not fit together, in the head or on the way through the phases.
        """
        passed = [phase for phase in phases if phase.rows]
        self._check_schedule(passed)
        blocks = [self.head]
        first = True
        for phase in passed:
            blocks.append(self._loop(phase) + (self.state(first) if phase.state else ""))
            first = first and not phase.state
        return "\n".join(blocks)

    @property
    def _output(self) -> str:
        if not self.stepped:
            return "output"
        return "output_swept_in_units" if self.units.are_own else "output_swept"

    def _before(self, kind: type[Row]) -> tuple[str, ...]:
        return ("steps/again",) if kind is Hold and self.scene.adhesion is not None else ()

    def _step(self, kind: type[Row]) -> str:
        if self.stepped and kind is Displace:
            return "steps/sweep"
        return "steps/displace_gently" if kind is Displace and self.settings.gentle else f"steps/{kind.step}"

    @property
    def _line(self) -> str:
        return "steps/line_in_units" if self.units.are_own else "steps/line"

    @property
    def _state(self) -> str:
        return "steps/state_in_units" if self.units.are_own else "steps/state"

    @property
    def _measuring(self) -> tuple[str, ...]:
        if self.stepped:
            return ()
        measure = "steps/measuring" if self.scene.cantilever is None else "steps/measuring_energy"
        return (*(name for part in self.parts for name in part.step_begin), measure)

    @property
    def _measured(self) -> tuple[str, ...]:
        if self.stepped:
            return ()
        return ("steps/measured", *(name for part in self.parts for name in part.step_end))

    def _loop(self, phase: Phase) -> str:
        title = f"# phase {phase.name}: {len(phase.rows)} rows\n{self.begin(phase.name, phase.begin)}"
        if self.stepped:
            return f"{title}{self.in_one_run(phase.rows)}variable        row_phase delete\n"
        kind = type(phase.rows[0])
        values = zip(*(row.texts(self.units.to_deck) for row in phase.rows), strict=True)
        lists = "".join(_index(name, texts) for name, texts in zip(kind.columns(), values, strict=True))
        return (
            f"{title}{lists}"
            f"label           {phase.name}\n{self.row(kind)}{self.row_end}"
            f"next            {' '.join(kind.columns())}\njump            SELF {phase.name}\n"
            "variable        row_phase delete\n"
        )

    def _check(self) -> dict[str, str]:
        """Return who defines each name of the head.

        Every variable is defined once, before it is needed, and used; every ID is defined once; there is one
        `pair_style` at most, and no group has two integrators.
        """
        for slot in ("pair_style", "atom_style"):
            styles = [part.name for part in self.parts if getattr(part, slot)]
            if len(styles) > 1:
                raise DeckError(f"each brings a {slot}, of which a deck has one: {', '.join(styles)}")
        moved = [part.integrates for part in self.parts if part.integrates]
        doubly = sorted({group for group in moved if moved.count(group) > 1})
        if doubly:
            raise DeckError(f"integrated twice: {', '.join(doubly)}")
        owners: dict[str, str] = {}
        needed = {name for kind in STEPS for name in fragment(self._step(kind)).needs}
        needed |= {name for step in (self._line, self._state) for name in fragment(step).needs}
        for part in self.parts:
            for name in part.variables:
                _own(owners, name, f"[{part.name}]")
            for piece in map(fragment, part.fragments):
                _pass(owners, piece)
                needed |= set(piece.needs)
        unused = {name for part in self.parts for name in part.variables} - needed
        if unused:
            raise DeckError(f"defined but not used: {', '.join(sorted(unused))}")
        return owners

    def _check_schedule(self, phases: Sequence[Phase]) -> None:
        """Go through the phases as LAMMPS does: what a step needs is defined by then, what it redefines, too."""
        owners = self._check()
        for phase in phases:
            kind = type(phase.rows[0])
            given = dict.fromkeys(("row_phase", *kind.columns(), *(("row_count",) if self.stepped else ())), "the row")
            last = (self._state,) if phase.state else ()
            kept = {"state_append": "the state"} if phase.state else {}
            row = (self._step(kind),) if self.stepped else (
                *self._before(kind), self._step(kind), *self._measuring, self._line, *self._measured,
            )  # fmt: skip
            here = owners | given | kept
            for name in (*phase.begin, *row, *row, *last):
                _pass(here, fragment(name))
            owners = {name: owner for name, owner in here.items() if name not in given and name not in kept}


def _block(name: str, variables: dict[str, str]) -> str:
    """A fragment with its header, below the variables that it needs."""
    lines = "".join(f"variable        {key} index {value}\n" for key, value in variables.items())
    piece = fragment(name)
    header = 5 if piece.redefines else 4
    comments = piece.text[: len(piece.text) - len(piece.text.split("\n", header)[header])]
    return comments + lines + piece.text[len(comments) :]


def _commands(names: Sequence[str]) -> str:
    """The commands of fragments, one after the other."""
    return "".join(fragment(name).commands for name in names)


def _own(owners: dict[str, str], name: str, owner: str) -> None:
    """Note who defines a name. Raises DeckError where somebody else does already."""
    if owners.setdefault(name, owner) != owner:
        raise DeckError(f"defined twice: {name}, by {owners[name]} and by {owner}")


def _pass(owners: dict[str, str], piece: Fragment) -> None:
    """Note what a fragment defines. Raises DeckError where it needs or redefines what nothing before it has defined."""
    missing = sorted({*piece.needs, *piece.redefines} - owners.keys())
    if missing:
        raise DeckError(f"used but not defined: {', '.join(missing)}, in {piece.name}")
    for name in piece.defines:
        _own(owners, name, piece.name)


def _index(name: str, texts: Sequence[str]) -> str:
    """`variable … index` over several lines."""
    lines = [" ".join(texts[i : i + NUMBERS_PER_LINE]) for i in range(0, len(texts), NUMBERS_PER_LINE)]
    return f"variable        {name} index " + " &\n                ".join(lines) + "\n"
