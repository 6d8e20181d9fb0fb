"""A scene and its schedule as one flat LAMMPS deck; pure text, nothing runs here.

A deck is a head (bodies, effects, method) and a schedule: phases, each a loop over rows. A row moves or loads the plate
and measures. Python runs the very same text, row by row, so that it can choose the next row by what it measured; the
deck that it leaves behind holds the rows of the schedule that the search ended with.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from contact1d.workflow.deck.effects import Contribution, Stage, contributions
from contact1d.workflow.deck.effects.base import number
from contact1d.workflow.deck.fragments import DeckError, Fragment, fragment
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

PLANE_DEPTH = 1e3
"""Distance of the wall's origin below the plane over the deepest expected displacement."""
MINIMISER_ITERATIONS = 20_000
RELAXATION = 0.1
"""First step of a relaxation over the time step of a run in time: ten times as much is 0.5/ω_max."""
STEP_COLUMNS = {
    "displace": ("row_displacement",),
    "displace_dynamic": ("row_displacement", "row_steps"),
    "load": ("row_load", "row_steps"),
    "hold": ("row_start", "row_load", "row_damping", "row_drag", "row_rest", "row_parted", "row_through", "row_steps"),
}
"""What a row of each kind of step prescribes, in order."""
NUMBERS_PER_LINE = 6


@dataclass(frozen=True)
class Phase:
    """A named part of a schedule.

    Attributes:
        name: what happens, one word.
        step: the kind of its rows, a key of STEP_COLUMNS.
        rows: the values of each row, in the order of STEP_COLUMNS.
        state: whether every atom's place and force are written after the last row.
        begin: fragments that come before the first row.
    """

    name: str
    step: str
    rows: tuple[tuple[float, ...], ...]
    state: bool = False
    begin: tuple[str, ...] = ()


@dataclass(frozen=True)
class Deck:
    """The deck of one scene with its settings; `text` of a schedule is in.lammps."""

    scene: Scene
    settings: Settings

    @cached_property
    def parts(self) -> tuple[Contribution, ...]:
        """What bodies, lower body, effects and method bring, in deck order."""
        scene = self.scene
        brought = [self._bodies(), *contributions(scene, self.settings), self._guide(), self._method()]
        if scene.bodies.lower == "rigid_plane":
            brought.append(self._plane())
        return tuple(sorted(brought, key=lambda part: part.stage))

    @cached_property
    def head(self) -> str:
        """Everything before the schedule.

        Raises:
            DeckError: if fragments and variables do not fit together.
        """
        styles = [f"pair_style      {part.pair_style}\n" for part in self.parts if part.pair_style]
        blocks = [_block("start", {}) + "".join(styles) + "bond_style      harmonic\n"]
        for part in self.parts:
            for index, name in enumerate(part.fragments):
                blocks.append(_block(name, part.variables if index == 0 else {}))
        blocks.append(_block("output", {}))
        self._check()
        # LAMMPS looks for triple quotes even in comments.
        title = "# {}\n# effects: {}; {}\n".format(
            self.scene.title.replace('"', "'"), ", ".join(self.scene.effects) or "none", self.scene.method
        )
        return title + "\n" + "\n".join(blocks)

    def begin(self, phase: str, fragments: Sequence[str] = ()) -> str:
        """What comes before a phase's rows."""
        return f"variable        row_phase index {phase}\n" + "".join(fragment(name).commands for name in fragments)

    def row(self, step: str) -> str:
        """One row up to its measurement: move or load, then measure."""
        return fragment(f"steps/{step}").commands + self._measuring + fragment("steps/line").commands

    @property
    def _measuring(self) -> str:
        begin = "".join(fragment(name).commands for part in self.parts for name in part.step_begin)
        return begin + fragment("steps/measuring").commands

    @property
    def row_end(self) -> str:
        """The end of every measurement."""
        end = "".join(fragment(name).commands for part in self.parts for name in part.step_end)
        return fragment("steps/measured").commands + end

    def values(self, step: str, row: Sequence[float]) -> str:
        """The variables of one row."""
        columns = STEP_COLUMNS[step]
        return "".join(f"variable        {c} index {_text(v)}\n" for c, v in zip(columns, row, strict=True))

    def forget(self, step: str) -> str:
        """Delete the variables of a row, as `next` does after the last one."""
        return "".join(f"variable        {c} delete\n" for c in STEP_COLUMNS[step])

    def state(self, first: bool) -> str:
        """Write the state that the last row left."""
        append = f"variable        state_append index {'no' if first else 'yes'}\n"
        written = self._measuring + fragment("steps/state").commands + self.row_end
        return append + written + "variable        state_append delete\n"

    def text(self, phases: Sequence[Phase]) -> str:
        """in.lammps: the head and a loop for each phase."""
        blocks = [self.head]
        first = True
        for phase in phases:
            blocks.append(self._loop(phase) + (self.state(first) if phase.state else ""))
            first = first and not phase.state
        return "\n".join(blocks)

    def _loop(self, phase: Phase) -> str:
        columns = STEP_COLUMNS[phase.step]
        lists = "".join(_index(name, [row[i] for row in phase.rows]) for i, name in enumerate(columns))
        return (
            f"# phase {phase.name}: {len(phase.rows)} rows\n{self.begin(phase.name, phase.begin)}{lists}"
            f"label           {phase.name}\n{self.row(phase.step)}{self.row_end}"
            f"next            {' '.join(columns)}\njump            SELF {phase.name}\n"
            "variable        row_phase delete\n"
        )

    def _check(self) -> None:
        """Every variable is defined once, and used; every ID is defined once; no group has two integrators."""
        moved = [part.integrates for part in self.parts if part.integrates]
        doubly = sorted({group for group in moved if moved.count(group) > 1})
        if doubly:
            raise DeckError(f"integrated twice: {', '.join(doubly)}")
        used: list[Fragment] = [fragment(name) for part in self.parts for name in part.fragments]
        given = [name for part in self.parts for name in part.variables]
        defined = given + [name for piece in used for name in piece.defines]
        twice = sorted({name for name in defined if defined.count(name) > 1})
        if twice:
            raise DeckError(f"defined twice: {', '.join(twice)}")
        needed = {name for piece in used for name in piece.needs}
        steps = {f"steps/{step}" for step in STEP_COLUMNS}
        needed_later = {name for step in steps for name in fragment(step).needs}
        if needed - set(defined):
            raise DeckError(f"used but not defined: {', '.join(sorted(needed - set(defined)))}")
        unused = set(given) - needed - needed_later
        if unused:
            raise DeckError(f"defined but not used: {', '.join(sorted(unused))}")

    def _bodies(self) -> Contribution:
        coefficient = (
            min(self.settings.bulk_stiffness, self._tangential) if self.settings.far else self.settings.bulk_stiffness
        )
        return Contribution("bodies", Stage.BODIES, ("bodies",), {"bulk_bond_coefficient": number(coefficient / 2)})

    @property
    def _tangential(self) -> float:
        return self.scene.tangential_stiffness

    def _plane(self) -> Contribution:
        depth = PLANE_DEPTH * max(self.settings.largest_displacement, self.scene.bodies.spacing)
        variables = {
            "plane_position": number(-depth),
            "plane_reach": number(depth),
            "plane_half_stiffness": number(self.settings.plane_stiffness / 2),
            "plane_stiffness": number(self.settings.plane_stiffness),
        }
        return Contribution("rigid_plane", Stage.SPRINGS, ("rigid_plane",), variables)

    def _guide(self) -> Contribution:
        variables = {} if self.scene.horizontal is not None else {"guide_x": "0.0"}
        return Contribution("guide", Stage.GUIDE, ("guide",), variables)

    def _method(self) -> Contribution:
        if self.scene.method == "quasistatic":
            variables = {
                "force_tolerance": number(self.settings.force_tolerance),
                "minimiser_iterations": str(MINIMISER_ITERATIONS),
                "relaxation_step": number(RELAXATION * self.settings.time_step),
            }
            return Contribution("quasistatic", Stage.MOTION, ("quasistatic",), variables)
        variables = {"time_step": number(self.settings.time_step)}
        return Contribution("dynamic", Stage.MOTION, ("dynamic",), variables, integrates="particles")


def _block(name: str, variables: dict[str, str]) -> str:
    """A fragment with its header, below the variables that it needs."""
    lines = "".join(f"variable        {key} index {value}\n" for key, value in variables.items())
    piece = fragment(name)
    comments = piece.text[: len(piece.text) - len(piece.text.split("\n", 4)[4])]
    return comments + lines + piece.text[len(comments) :]


def _text(value: float) -> str:
    return str(value) if isinstance(value, int) else number(value)


def _index(name: str, values: Sequence[float]) -> str:
    """`variable … index` over several lines."""
    texts = [_text(value) for value in values]
    lines = [" ".join(texts[i : i + NUMBERS_PER_LINE]) for i in range(0, len(texts), NUMBERS_PER_LINE)]
    return f"variable        {name} index " + " &\n                ".join(lines) + "\n"
