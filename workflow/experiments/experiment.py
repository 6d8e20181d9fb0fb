"""An experiment: mostly a script that moves a contact and a reader of its states, also on the reduced model."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, partial
from typing import ClassVar, Generic, TypeVar, cast

from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.branch import Branch, SecondMaximumError
from contact1d.workflow.continuation.budget import budgeted, curve_errors, force_errors
from contact1d.workflow.continuation.context import ContactBranch, RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.load_control import LoadBranch
from contact1d.workflow.continuation.outcome import Agreement, Outcome, Reading, Result
from contact1d.workflow.continuation.planned import Plan, PlannedBranch
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.replayed import ReplayedBranch
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.continuation.trust import ThroughError, doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.model.settings import Settings, slower
from contact1d.workflow.scene import Kind, Scene
from contact1d.workflow.units import ENERGY

VAGUE = 0.1
"""What the energies of a run may leave open in its check of the energy at most."""
FINER_SPACING = "a smaller bodies.spacing at the same stiffness and energy per length"
"""What every radius gains from."""
RETRY_SHARES = (1 / 4, 1 / 16)
"""Parts of the increments that are tried where bodies went through each other: a body that moves by much of its
particles' distance from the opposite ones, or by which their force changes much, lets the minimiser put one beyond.
Where pairs snap together a minimiser moves particles by more than their distance whatever the increment: a relaxation
then goes downhill in short moves. In time it is a load applied at once that drives a plate past its equilibrium, and
what a snap sets free that drives a particle through its opposite: loads then come in such parts, with drag."""


K = TypeVar("K", bound=Kind)


class Experiment(ABC, Generic[K]):
    """One kind of experiment; K is its table in a scene.

    Attributes:
        main_results: names of the results that an error is judged by, as far as a scene has them.
        branches: phases whose branch of the curve has another name than they.
        is_statistical: whether results are means, the errors of which follow from their scatter.
        curve_is_result: whether the forces of curve.csv are results that the tolerance holds for.
    """

    main_results: ClassVar[tuple[str, ...]]
    is_statistical: ClassVar[bool] = False
    curve_is_result: ClassVar[bool] = False
    branches: ClassVar[Mapping[str, str]] = {}

    def given(self, scene: Scene) -> K:
        """What a scene says of it."""
        return cast("K", scene.experiment)

    @abstractmethod
    def run(self, context: RunContext) -> Outcome:
        """Run it.

        Raises:
            UntrustedError: the result can't be trusted.
            EngineError: LAMMPS failed.
        """

    @abstractmethod
    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The schedule of a deck that is written and not run: known for a path, expected where a run would search."""

    def reduction(self, scene: Scene, settings: Settings) -> Reduction | None:
        """The experiment on the reduced model of a scene; None where it has no states at rest."""
        return None

    def advice(self, scene: Scene) -> str:
        """What makes the uncertainty of a result smaller."""
        if scene.method == "dynamic":
            return 'Use method = "quasistatic"'
        if not scene.interaction:
            return f"Use {FINER_SPACING}"
        return f'Use "auto" for interaction.cutoff and bodies.particles; for a radius also {FINER_SPACING}'

    def branch(self, phase: str) -> str:
        """The branch name of a phase in curve.csv."""
        name = phase.partition("_")[0]
        return self.branches.get(name, name)


class Scripted(Experiment[K]):
    """A script over a branch, and a reader of the resulting trace."""

    def is_sampled(self, scene: Scene) -> bool:
        """Whether the load steps are known beforehand, so that what lies between them is an error."""
        return False

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """What the script does on the reduced model; on a rigid plane these are the load steps that run."""
        if scene.method == "dynamic":
            return self.expected(scene, settings)
        case = self.reduction(scene, settings)
        return Plan.of(Deck(scene, settings), case.driven(case.model)).phases

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The schedule of a motion, as far as it is known."""
        raise NotImplementedError

    @abstractmethod
    def script(self, branch: Driver, scene: Scene) -> None:
        """Move a contact, as often to and fro as it takes: each turn begins a leg of the trace."""

    @abstractmethod
    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Results of the states that the script has passed."""

    def tables(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Mapping[str, tuple[float, ...]]]:
        """Columns of further files, by the names of these."""
        return {}

    def finish(self, outcome: Outcome, scene: Scene, settings: Settings) -> Outcome:
        """What the experiment adds to its outcome, or refuses of it."""
        return outcome

    def run(self, context: RunContext) -> Outcome:
        """Run the script on LAMMPS; the reader's results with their error budget."""
        scene, settings = context.deck.scene, context.deck.settings
        case = self.reduction(scene, settings)
        branch, trace = self._driven(context, case)
        # An error of the force changes its sign within half a range: it moves where a flat maximum lies.
        errors = force_errors(scene, settings, branch.states, branch.marked.values(), branch.unbalance)
        slower = self._slower(context, case, trace)
        length = 0.5 * settings.forces.range
        results = budgeted(case, trace, errors, self.is_sampled(scene), length, repeated=slower)
        warnings = doubts(scene, settings, tuple(branch.states))
        tables = self.tables(trace, scene, settings)
        states, moves = tuple(branch.states), case.moves
        doubt = max((one.share for one in results.values() if one.unit == ENERGY and one.size), default=0.0)
        checks = branch.checks(case, min(doubt, VAGUE)) | consistency.asked(scene, self.asked(trace, scene), states)
        checks |= self.energy(case, states, results)
        rows = curve_errors(case, trace, errors.common, slower)
        outcome = Outcome(
            results, states, branch.marked, branch.phases, warnings, {}, rows, tables, moves=moves, consistency=checks
        )
        return self.finish(outcome, scene, settings)

    def asked(self, trace: Trace, scene: Scene) -> Sequence[tuple[float, float]]:
        """Forces [FU] that the scene asks for, each with that of the state that has it."""
        return ()

    def energy(self, case: Reduction, states: Sequence[State], results: Mapping[str, Result]) -> dict[str, Agreement]:
        """The check of the energy of a motion; that of load steps on a plane needs no more than these."""
        return {}

    def _driven(self, context: RunContext, case: Reduction) -> tuple[ContactBranch, Trace]:
        """The script on a new contact, and its trace."""
        scene = context.deck.scene
        with branch_of(context, lambda: case.lattice) as branch:
            self.script(branch, scene)
            branch.finish()
        return branch, branch.trace()

    def _slower(self, context: RunContext, case: Reduction, trace: Trace) -> dict[str, list[Trace]]:
        """A motion once more in longer timesteps, and slower where inertia or drag is the program's choice."""
        if context.deck.scene.method != "dynamic" or not trace.time.any():
            return {}
        found = []
        for scene, settings in slower(context.deck.scene, context.deck.settings):
            with context.aside(Deck(scene, settings)) as other:
                found.append(self._driven(other, case)[1])
        return {"time": found}

    @lru_cache(maxsize=1)  # noqa: B019  # what chose the spacing has worked out the lattices of the run
    def reduction(self, scene: Scene, settings: Settings) -> Reduction:
        """Script and reader on the reduced model of a scene."""
        script, read = partial(self.script, scene=scene), partial(self.read, scene=scene, settings=settings)
        return Reduction(scene, settings, script, read, self.reduction)


def branch_of(context: RunContext, meanwhile: Callable[[], object]) -> Branch | LoadBranch | PlannedBranch:
    """A new contact: under load control in time, planned on a rigid plane of a law that is known, else searched for."""
    scene = context.deck.scene
    if scene.method == "dynamic" and scene.experiment.compression is not None:
        return LoadBranch(context, meanwhile)
    if scene.is_stepped and (scene.is_modelled or scene.experiment.way_is_given):
        return PlannedBranch(context, meanwhile)
    return (ReplayedBranch if context.deck.settings.snaps else Branch)(context, meanwhile)


def in_smaller_steps(run: Callable[[RunContext], Outcome]) -> Callable[[RunContext], Outcome]:
    """The same run, which restarts in smaller steps where the bodies went through each other.

    The context's deck is then the one with these steps: it is what in.lammps must hold.

    Raises:
        ThroughError: they do so in the smallest steps, too, so that it is the load and not the path.
    """

    def tried(context: RunContext) -> Outcome:
        try:
            return run(context)
        except SecondMaximumError:
            context.progress.note("the tensile force rises again after its first maximum: searching the full range")
            context.through = True
            return run(context)

    def searched(context: RunContext) -> Outcome:
        deck = context.deck
        try:
            return tried(context)
        except ThroughError as error:
            # Under noise it is the noise that drives particles through, and a motion is not begun anew.
            if deck.scene.noise or deck.scene.experiment.motion_is_result or not context.retries:
                raise
            latest = error
        for part in RETRY_SHARES:
            context.progress.note(f"the bodies went through each other: restarting with steps scaled by {part:g}")
            context.deck = Deck(deck.scene, deck.settings.in_smaller_steps(part))
            try:
                return tried(context)
            except ThroughError as error:
                latest = error
        context.deck = deck
        smaller = f"Steps {1 / RETRY_SHARES[-1]:g} times smaller did not help"
        raise ThroughError(f"{latest.message}. {smaller}", latest.advice, latest.changes)

    return searched
