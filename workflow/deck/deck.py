"""A scene and its schedule as one flat LAMMPS deck; pure text, nothing runs here.

A deck is a head (bodies, effects, method) and a schedule: phases, each a loop over rows. A row is a load step: it moves
or loads the plate and measures. Python runs the same text row by row, so that the next row can depend on what was
measured; the deck that is kept has the rows of the schedule with which the search ended.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.deck.effects import Contribution, contributions
from contact1d.workflow.deck.fragments import DeckError, Fragment, block, commands, deleted, fragment, indexed, listed
from contact1d.workflow.deck.parts import bins, free_to_move, rigidly_mounted, unit_conversion
from contact1d.workflow.deck.steps import (
    APPENDED,
    NEW,
    STEPS,
    UNITS,
    Displace,
    Hold,
    Phase,
    Row,
    appended,
    skipped,
)
from contact1d.workflow.deck.units import DeckUnits, units_for
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


@dataclass(frozen=True)
class Deck:
    """The deck of one scene with its settings; `text` of a schedule is in.lammps."""

    scene: Scene
    settings: Settings

    @cached_property
    def units(self) -> DeckUnits:
        """The units of length [LU] and force [FU] in which the deck's text and system.data are written; cached."""
        return units_for(self.scene)

    @cached_property
    def written(self) -> tuple[Scene, Settings]:
        """(scene, settings) in the units of the deck; the original ones where these are those of the scene; cached."""
        return self.units.scene(self.scene), self.units.settings(self.settings)

    @cached_property
    def stepped(self) -> bool:
        """Whether no particle has to relax, so that all rows of a phase are steps of one LAMMPS run; cached.

        That is in a quasi-static scene on a rigid plane without [neighbours].
        """
        return self.scene.is_stepped

    @cached_property
    def parts(self) -> tuple[Contribution, ...]:
        """The parts (fragments, variables) of bodies, lower body, effects, method and units, sorted by stage; cached.

        With an interaction also that of larger bins, where the box needs them. Numbers are in units of the deck.

        Raises:
            SettingsError: the box of an interaction has too many bins for LAMMPS.
        """
        scene, settings = self.written
        mounting = rigidly_mounted if scene.stands else free_to_move
        parts = [*contributions(scene, settings), *mounting(scene, settings)]
        if self.units.are_rescaled:
            parts.append(unit_conversion(self.units))
        if scene.interaction:
            parts += bins(scene, settings, parts)
        return tuple(sorted(parts, key=lambda part: part.stage))

    @cached_property
    def head(self) -> str:
        """The LAMMPS text before the schedule, with a title as comment, in units of the deck; cached.

        Raises:
            DeckError: fragments and variables do not fit together.
            SettingsError: the box of an interaction has too many bins for LAMMPS.
        """
        stands = self.scene.stands
        slots = {
            "atom_style": next(
                (part.atom_style for part in self.parts if part.atom_style), "atomic" if stands else "bond"
            ),
            "pair_style": next((part.pair_style for part in self.parts if part.pair_style), ""),
            "bond_style": "" if stands else "harmonic",
        }
        styles = "".join(f"{slot:<16}{style}\n" for slot, style in slots.items() if style)
        blocks = [block("start", {}) + styles]
        for part in self.parts:
            for index, name in enumerate((*part.fragments, *part.springs)):
                blocks.append(block(name, part.variables if index == 0 else {}))
        blocks += [block(name, {}) for name in self._output]
        self._check()
        # LAMMPS looks for triple quotes even in comments.
        title = "# {}\n# effects: {}; {}\n".format(
            self.scene.title.replace('"', "'"), ", ".join(self.scene.effects) or "none", self.scene.method
        )
        return title + "\n" + "\n".join(blocks)

    def begin(self, phase: str, fragments: Sequence[str] = ()) -> str:
        """Return the LAMMPS commands before the rows of a phase: its name as variable row_phase, and `fragments`.

        `fragments`: names of files in `lammps_inputs/fragments`, of which the commands are taken, in order.
        """
        return indexed({"row_phase": phase}) + commands(fragments)

    def row(self, kind: type[Row]) -> str:
        """Return the LAMMPS commands of one row of a kind: motion, measurement, line of curve.txt, and kept state.

        A state is kept only with `[output]`. The commands that end a measurement are left out. The variables of the row
        must be defined before. Where rows are steps of one run (`stepped`), the commands are those of the whole run.
        """
        return commands(self._row(kind))

    def as_read(self, columns: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
        """Return numbers of load steps as LAMMPS reads them from a list: to 15 significant digits in units of the deck.

        Args:
            columns: arrays, (m,), by the name of a field of a row, "displacement" for instance, in units of the scene,
                as the returned ones, which are new arrays by the same names.

        Raises:
            KeyError: no field with a unit has this name.
        """
        return {
            name: np.asarray(
                [
                    self.units.from_deck(float(f"{self.units.to_deck(value, UNITS[name]):.15g}"), UNITS[name])
                    for value in column.tolist()
                ]
            )
            for name, column in columns.items()
        }

    def in_one_run(self, rows: Sequence[Row], skips: Sequence[int] = ()) -> str:
        """Return the LAMMPS commands of rows that are positions of the plate, all in one run.

        The text defines the variables of the rows, in units of the deck, before the run, and deletes them after it.

        Args:
            rows: all of one kind, one at least, with numbers in units of the scene.
            skips: 1 for each row whose state is not written, 0 for the others; by default all are written. It has no
                effect without `[output]`, where no states are kept.
        """
        columns = zip(*(row.texts(self.units.to_deck) for row in rows), strict=True)
        # A column is one word on one line, as LAMMPS has it.
        given = {name: f"[{','.join(texts)}]" for name, texts in zip(rows[0].columns(), columns, strict=True)}
        given["row_count"] = str(len(rows))
        if self.keeps:
            given["row_skip"] = f"[{','.join(map(str, skips or [0] * len(rows)))}]"
        return indexed(given) + self.row(type(rows[0])) + deleted(given)

    def values(self, row: Row, first: bool) -> str:
        """Return LAMMPS text that defines the variables of one row, in units of the deck.

        With `[output]`, unless rows are steps of one run (`stepped`), row_append is among them: "no", which begins the
        file of states, if no state has been written before (`first`), else "yes", which appends.
        """
        texts = (*row.texts(self.units.to_deck), NEW if first else APPENDED)
        return indexed(dict(zip(self._columns(type(row)), texts, strict=False)))

    def row_end(self, kind: type[Row]) -> str:
        """Return the LAMMPS commands after the measurement of a row of a kind, and those that delete its variables.

        Where rows are steps of one run (`stepped`), only the latter.
        """
        return commands(self._measured) + deleted(self._columns(kind))

    def state(self, first: bool) -> str:
        """Return the LAMMPS commands that write the state of the last row to states.lammpstrj.

        They begin and end a measurement of their own. "" where the state is written already: rows are steps of one run
        (`stepped`), and the scene has `[output]`.

        `first`: whether no state has been written before, so that the file is begun anew.
        """
        if self.stepped and self.keeps:
            return ""
        append = "row_append" if self.keeps else "state_append"
        written = commands((*self._measuring, self._state, *self._measured))
        return indexed({append: NEW if first else APPENDED}) + written + deleted([append])

    def text(self, phases: Sequence[Phase]) -> str:
        """Return in.lammps: the head and a loop for each phase; phases without rows are left out.

        Raises:
            DeckError: fragments and variables do not fit together, in the head or in a phase.
            SettingsError: the box of an interaction has too many bins for LAMMPS.
        """
        schedule = [phase for phase in phases if phase.rows]
        self._check_schedule(schedule)
        return f"{self.head}\n{self.schedule(schedule)}"

    def schedule(self, phases: Sequence[Phase]) -> str:
        """Return the LAMMPS text of loops over the rows of phases, with the states that phases write at their ends.

        Each phase must have rows; "" without phases. Of rows that are steps of one run there is one run for each phase
        in place of the loop. Whether the names of fragments and variables fit together is not checked.
        """
        blocks, first = list[str](), True
        for phase in phases:
            loop = self._loop(phase, first)
            first = first and not (self.keeps and {*appended(phase, self.stepped, first)} & {NEW, APPENDED})
            blocks.append(loop + (self.state(first) if phase.state else ""))
            first = first and not phase.state
        return "\n".join(blocks)

    @property
    def keeps(self) -> bool:
        """Whether states of the whole loading history are kept: the scene has `[output]`."""
        return self.scene.output is not None

    @property
    def _output(self) -> tuple[str, ...]:
        """The names of the fragments at the end of the head that set up the output, in order.

        ("output",); where rows are steps of one run (`stepped`) "output_swept", with `[output]` also "output_states",
        both with "_in_units" behind them where the deck has other units than the scene, and "set_up".
        """
        if not self.stepped:
            return ("output",)
        return (self._named("output_swept"), *[self._named("output_states")] * self.keeps, "set_up")

    def _named(self, fragment: str) -> str:
        """Return the name of a fragment, with "_in_units" behind it where the deck has other units than the scene."""
        return f"{fragment}_in_units" if self.units.are_rescaled else fragment

    def _columns(self, kind: type[Row]) -> tuple[str, ...]:
        """Return the names of the LAMMPS variables that each row of a kind has, in order.

        "row_append" is the last one with `[output]`, unless rows are steps of one run (`stepped`).
        """
        return (*kind.columns(), *["row_append"] * (self.keeps and not self.stepped))

    def _row(self, kind: type[Row]) -> tuple[str, ...]:
        """Return the names of the fragments of a row of this kind, in order: motion, measurement, line of curve, state.

        Without those after the measurement; the state only with `[output]`. A displacement by short moves, or of pairs
        that snap in, has a fragment of its own; a `Hold` with adhesion begins with one that restores the contact. Where
        rows are steps of one run (`stepped`): with `[output]` "steps/keep", then "steps/sweep" or that of the kind.
        """
        step, kept = kind.step, [self._state] * self.keeps
        if kind is Displace and not self.stepped:
            step += "_gently" * self.settings.gentle or "_snapping" * self.settings.snaps
        if self.stepped:
            return (*["steps/keep"] * self.keeps, "steps/sweep" if kind is Displace else f"steps/{step}")
        again = ["steps/again"] * (kind is Hold and self.scene.work_of_adhesion > 0.0)
        return (*again, f"steps/{step}", *self._measuring, self._named("steps/line"), *kept)

    @property
    def _state(self) -> str:
        """The name of the fragment that writes a state: of each row with `[output]`, else of the last row of a phase.

        It converts to LU and FU where the deck has other units.
        """
        return self._named("steps/kept" if self.keeps else "steps/state")

    @property
    def _measuring(self) -> tuple[str, ...]:
        """The names of the fragments of a measurement, in order; () where rows are steps of one run (`stepped`).

        With an interaction springs are off in it, and set anew after it.
        """
        if self.stepped:
            return ()
        measure = "steps/measuring_energy" if self.scene.cantilever else "steps/measuring"
        begin = [name for part in self.parts for name in part.step_begin]
        return (*begin, measure, *(name for part in self.parts for name in part.springs if self.scene.interaction))

    @property
    def _measured(self) -> tuple[str, ...]:
        """The names of the fragments after a measurement, in order; () where rows are steps of one run (`stepped`)."""
        if self.stepped:
            return ()
        return ("steps/measured", *(name for part in self.parts for name in part.step_end))

    def _loop(self, phase: Phase, first: bool) -> str:
        """Return the LAMMPS text of a phase: its variables and a loop over its rows, or one run of all.

        There must be one row at least. The state at the end of the phase is not part of it. `first`: whether no state
        has been written before.
        """
        title = f"# phase {phase.name}: {len(phase.rows)} rows\n{self.begin(phase.name, phase.begin)}"
        if self.stepped:
            return f"{title}{self.in_one_run(phase.rows, skipped(phase))}variable        row_phase delete\n"
        kind = type(phase.rows[0])
        names, kept = self._columns(kind), appended(phase, self.stepped, first)
        values = zip(
            *((*row.texts(self.units.to_deck), word) for row, word in zip(phase.rows, kept, strict=True)), strict=True
        )
        lists = "".join(listed(name, texts) for name, texts in zip(names, values, strict=False))
        return (
            f"{title}{lists}"
            f"label           {phase.name}\n{self.row(kind)}{commands(self._measured)}"
            f"next            {' '.join(names)}\njump            SELF {phase.name}\n"
            "variable        row_phase delete\n"
        )

    def _check(self) -> dict[str, str]:
        """Return what defines each name of the head, by the name: a fragment, or a part in brackets, as "[plate]".

        Every variable is defined once, before it is needed, and used; every ID is defined once; there is one
        `pair_style` and one `atom_style` at most, and no group has two integrators.

        Raises:
            DeckError: one of these does not hold.
        """
        for slot in ("pair_style", "atom_style"):
            styles = [part.name for part in self.parts if getattr(part, slot)]
            if len(styles) > 1:
                raise DeckError(f"each brings a {slot}, of which a deck has one: {', '.join(styles)}")
        groups = [part.integrates for part in self.parts if part.integrates]
        doubly = sorted({group for group in groups if groups.count(group) > 1})
        if doubly:
            raise DeckError(f"integrated twice: {', '.join(doubly)}")
        owners: dict[str, str] = {}
        steps = [self._named("steps/line"), self._state, *(name for kind in STEPS for name in self._row(kind))]
        needed = {name for step in steps for name in fragment(step).needs}
        for part in self.parts:
            for name in part.variables:
                _define(owners, name, f"[{part.name}]")
            for piece in map(fragment, (*part.fragments, *part.springs)):
                _add(owners, piece)
                needed |= set(piece.needs)
        for name in self._output:
            _add(owners, fragment(name))
        unused = {name for part in self.parts for name in part.variables} - needed
        if unused:
            raise DeckError(f"defined but not used: {', '.join(sorted(unused))}")
        return owners

    def _check_schedule(self, phases: Sequence[Phase]) -> None:
        """Check that names are defined before a fragment of the schedule needs or redefines them; nothing is returned.

        `phases`: each with rows.

        Raises:
            DeckError: one is not, or a name is defined twice; or the head does not fit together.
        """
        owners = self._check()
        for phase in phases:
            kind = type(phase.rows[0])
            in_one_run = ("row_count", *(("row_skip",) if self.keeps else ())) if self.stepped else ()
            given = dict.fromkeys(("row_phase", *self._columns(kind), *in_one_run), "the row")
            written = phase.state and not (self.stepped and self.keeps)
            last = (self._state,) if written else ()
            kept = {"state_append": "the state"} if written and not self.keeps else {}
            row = (*self._row(kind), *self._measured)
            defined = owners | given | kept
            for name in (*phase.begin, *row, *row, *last):
                _add(defined, fragment(name))
            owners = {name: owner for name, owner in defined.items() if name not in given and name not in kept}


def _define(owners: dict[str, str], name: str, owner: str) -> None:
    """Add the owner of a name to `owners`, in place; no change where the name has this owner already.

    Raises:
        DeckError: the name has another owner.
    """
    if owners.setdefault(name, owner) != owner:
        raise DeckError(f"defined twice: {name}, by {owners[name]} and by {owner}")


def _add(owners: dict[str, str], piece: Fragment) -> None:
    """Add the names that a fragment defines to `owners`, in place.

    Raises:
        DeckError: it needs or redefines an undefined name, or defines one that has another owner.
    """
    missing = sorted({*piece.needs, *piece.redefines} - owners.keys())
    if missing:
        raise DeckError(f"used but not defined: {', '.join(missing)}, in {piece.name}")
    for name in piece.defines:
        _define(owners, name, piece.name)
