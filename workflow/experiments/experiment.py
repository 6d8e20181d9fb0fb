"""An experiment: mostly a script that moves a contact and a reader of its states, also on the reduced model."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, partial
from typing import ClassVar, Generic, TypeVar, cast

from contact1d.workflow.continuation.branch import Branch, SecondMaximumError
from contact1d.workflow.continuation.budget import budgeted, curve_errors, force_errors
from contact1d.workflow.continuation.context import ContactBranch, RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.load_control import LoadBranch
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.planned import Plan, PlannedBranch
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.replayed import ReplayedBranch
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.continuation.trust import doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.errors import ThroughError
from contact1d.workflow.model.settings import Settings, slower
from contact1d.workflow.scene import Kind, Scene
from contact1d.workflow.units import ENERGY

K = TypeVar("K", bound=Kind)


class Experiment(ABC, Generic[K]):
    """One kind of experiment; K is its table in a scene.

    Attributes:
        main_results: names of the results whose uncertainty must meet the tolerance, as far as a scene has them.
        branches: names of the branches of the curve, by the phases that are named otherwise.
        is_statistical: whether results are means, the errors of which follow from their scatter.
        curve_is_result: whether the forces of curve.csv are results that the tolerance holds for.
        curve_has_times: whether curve.csv has the time of each state [TU] since the start of the run.
    """

    main_results: ClassVar[tuple[str, ...]]
    is_statistical: ClassVar[bool] = False
    curve_is_result: ClassVar[bool] = False
    curve_has_times: ClassVar[bool] = False
    branches: ClassVar[Mapping[str, str]] = {}

    def given(self, scene: Scene) -> K:
        """Return `scene.experiment`, the experiment's table, as it is: its type is not checked."""
        return cast("K", scene.experiment)

    @abstractmethod
    def run(self, context: RunContext) -> Outcome:
        """Run the experiment in LAMMPS, in the folder of the context; return its outcome: results, states, schedule.

        Raises:
            UntrustedError: bodies pass through each other or do not come to rest, or the contact reaches the end of a
                chain or does not sustain a force of the scene.
            EngineError: LAMMPS failed.
        """

    @abstractmethod
    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the schedule of a deck that is written and not run: phases of load steps, in order.

        It is exact of prescribed load steps, as of a path; of a search it is that of the reduced model, in time an
        expected one.
        """

    def reduction(self, scene: Scene, settings: Settings) -> Reduction | None:
        """Return the experiment on the reduced model of a scene, which predicts its results without LAMMPS.

        Here None, as of a slide, which has no states at rest; all other experiments return a `Reduction`.
        """
        return None

    def advice(self, scene: Scene) -> str:
        """Return which keys of the scene reduce the uncertainty of a result, as a sentence without a full stop.

        Here another method for a dynamic scene, a smaller spacing without [interaction], else "auto" for cutoff and
        particles; a subclass may give other advice.
        """
        if scene.method == "dynamic":
            return 'Use method = "quasistatic"'
        if not scene.interaction:
            return f"Use {finer_spacing(scene)}"
        return f'Use "auto" for interaction.cutoff and bodies.particles; for a radius also {finer_spacing(scene)}'

    def branch(self, phase: str) -> str:
        """Return the name of the branch in curve.csv to which a phase belongs.

        The number of the phase is left out, "loading" of "loading_2", and `branches` may give another name, "unloading"
        of "pulling".
        """
        name = phase.partition("_")[0]
        return self.branches.get(name, name)


class Scripted(Experiment[K]):
    """A script over a branch, and a reader of the resulting trace."""

    def is_sampled(self, scene: Scene) -> bool:
        """Return whether the load steps are known beforehand, so that results have a sampling error.

        Here True where the scene gives the history, as of an impact; a pull-off at a velocity has one, too.
        """
        return scene.experiment.history_is_given

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the phases of load steps of the script on the reduced model, on a rigid plane the ones that run.

        For method "dynamic" they are those of `expected`, a motion as far as it is known before the run.

        Raises:
            NotImplementedError: method "dynamic", of an experiment that has no motion.
        """
        if scene.method == "dynamic":
            return self.expected(scene, settings)
        case = self.reduction(scene, settings)
        return Plan.of(Deck(scene, settings), case.driven(case.model)).phases

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the phases of load steps of a motion in time, as far as they are known before the run.

        Here it raises NotImplementedError; load, pull-off, hold and impact have such phases.
        """
        raise NotImplementedError

    @abstractmethod
    def script(self, branch: Driver, scene: Scene) -> None:
        """Load and unload the contact of a driver, LAMMPS or the reduced model, to which states are added.

        Each turn of the loading begins a leg of the trace. States to be reported are marked by a name.
        """

    @abstractmethod
    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of a trace by name, in units of the scene, with the errors that the reader determines.

        Other errors are found by perturbing the trace. A result that the states do not give is left out.
        """

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with the warnings, columns, tables and checks of the experiment alone; here unchanged.

        A pull-off refuses results that contradict its states (UntrustedError). `case`, `trace`: the experiment on the
        reduced model, and the trace of all states in LAMMPS.
        """
        return outcome

    def run(self, context: RunContext) -> Outcome:
        """Run the script on LAMMPS and return the results with their error budget, states, warnings and checks.

        A motion in time is run once or twice more, in longer timesteps and with more mass, for the error that is due to
        these.

        Raises:
            UntrustedError: bodies pass through each other or do not come to rest, or the contact reaches the end of a
                chain or does not sustain a force of the scene.
            EngineError: LAMMPS failed.
        """
        scene, settings = context.inputs
        case = self.reduction(scene, settings)
        branch, trace = self._driven(context, case)
        states, phases = tuple(branch.states), branch.contact.phases
        # An error of the force changes its sign within half a range: it moves where a flat maximum lies.
        errors = force_errors(scene, settings, states, branch.marked.values(), branch.unbalance)
        slower = self._slower(context, case, trace)
        length = 0.5 * settings.forces.range
        results = budgeted(case, trace, errors, self.is_sampled(scene), length, repeated=slower)
        warnings = doubts(scene, settings, states)
        columns = {"time": tuple(trace.time.tolist())} if self.curve_has_times else {}
        energies = (result for result in results.values() if result.unit == ENERGY and result.size)
        doubt = min(max((energy.share for energy in energies), default=0.0), 0.1)  # more would check nothing
        checks, rows = branch.checks(case, doubt), curve_errors(case, trace, errors.common, slower)
        outcome = Outcome(
            results, states, branch.marked, phases, warnings, columns, rows, moves=case.moves, consistency=checks
        )
        return self.finish(outcome, case, trace)

    def _driven(self, context: RunContext, case: Reduction) -> tuple[ContactBranch, Trace]:
        """Run the script on a new contact in LAMMPS, which is closed at the end; return its driver and its trace.

        `case`: the reduction of the same scene, whose other lattices are prepared while LAMMPS starts.
        """
        scene = context.deck.scene
        with driver_of(context, lambda: case.lattice) as branch:
            self.script(branch.driver, scene)
            branch.finish()
        return branch, branch.trace()

    def _slower(self, context: RunContext, case: Reduction, trace: Trace) -> dict[str, list[Trace]]:
        """Return {"time": traces of repetitions of a motion}; {} where states are no motion in time.

        The first is in longer timesteps; the second, with larger masses and drags, is there only where the program
        chose some of these. Each is run in LAMMPS in a temporary folder.
        """
        if context.deck.scene.method != "dynamic" or not trace.time.any():
            return {}
        traces = []
        for scene, settings in slower(*context.inputs):
            with context.aside(Deck(scene, settings)) as repeat:
                traces.append(self._driven(repeat, case)[1])
        return {"time": traces}

    @lru_cache(maxsize=1)  # noqa: B019  # what chose the spacing has worked out the lattices of the run
    def reduction(self, scene: Scene, settings: Settings) -> Reduction:
        """Return the experiment on the reduced model of a scene: script, reader and settings; nothing is computed yet.

        Only the latest one, of all experiments, is cached.
        """
        script, read = partial(self.script, scene=scene), partial(self.read, scene=scene, settings=settings)
        return Reduction(scene, settings, script, read, self.reduction)


def finer_spacing(scene: Scene, size: str = "") -> str:
    """Return "a smaller bodies.spacing" and the keys of a scene that must change in proportion, as part of a sentence.

    These are a given `bodies.bulk_stiffness` and the amplitudes of [interaction], where the scene has them. `size`:
    text on how small, after "spacing".
    """
    keys = ["bodies.bulk_stiffness"] * (scene.bodies.bulk_stiffness != "auto")
    keys += ["the amplitudes of [interaction]"] * (scene.interaction is not None)
    return f"a smaller bodies.spacing{size}" + (f", with {' and '.join(keys)} in proportion to it" if keys else "")


def driver_of(context: RunContext, meanwhile: Callable[[], object]) -> Branch | LoadBranch | PlannedBranch:
    """Return a new driver of a contact in LAMMPS, to be opened by `with`.

    Under a prescribed force in time it is load control; on a rigid plane without relaxation, with effects that the
    reduced model has or a prescribed history, the load steps are planned; else displacements are prescribed, and those
    of a force or of the force maximum are searched for, with a repeated schedule where pairs snap. `meanwhile` is
    called while LAMMPS starts.
    """
    scene = context.deck.scene
    if scene.method == "dynamic" and scene.experiment.compression is not None:
        return LoadBranch(context, meanwhile)
    if scene.is_stepped and (scene.is_modelled or scene.experiment.history_is_given):
        return PlannedBranch(context, meanwhile)
    return (ReplayedBranch if context.deck.settings.snaps else Branch)(context, meanwhile)


def in_smaller_steps(
    run: Callable[[RunContext], Outcome], shares: Sequence[float] = (1 / 4, 1 / 16)
) -> Callable[[RunContext], Outcome]:
    """Return a function that runs an experiment, and restarts it in smaller steps if bodies pass through each other.

    A body that moves by much of its particles' distance from the opposite ones, or by which their force changes much,
    lets the minimiser put one beyond. Where pairs snap together a minimiser moves particles by more than their distance
    whatever the increment: a relaxation then goes downhill in short moves. In time it is a load applied at once that
    drives a plate past its equilibrium, and the energy of a snap that drives a particle through its opposite: loads
    then come in such parts, with drag. The function changes the deck of its context to that of the smaller steps.

    Args:
        run: the experiment.
        shares: the smaller increments over those of the settings, in the order in which they are tried.

    Raises:
        ThroughError: by the returned function: they do so in the smallest steps, too; at once with noise, in a slide,
            or where the context allows no retries.
    """

    def tried(context: RunContext) -> Outcome:
        """Run the experiment and return its outcome; where the tension has a second maximum, run it again.

        The second run is over the full range of the tension, for which `context.through` is set to True.
        """
        try:
            return run(context)
        except SecondMaximumError:
            context.progress.note("the tensile force rises again after its first maximum: searching the full range")
            context.through = True
            return run(context)

    def searched(context: RunContext) -> Outcome:
        """Run the experiment, in ever smaller steps until no body passes through the other, and return its outcome.

        `context.deck` is then that with the smaller steps; it is the first one again where this fails.

        Raises:
            ThroughError: in the smallest steps, too; at once with noise, in a slide, or where retries are off.
        """
        deck = context.deck
        try:
            return tried(context)
        except ThroughError as error:
            # Under noise it is the noise that drives particles through, and a motion is not begun anew.
            if deck.scene.noise or deck.scene.experiment.motion_is_result or not context.retries:
                raise
            latest = error
        for part in shares:
            context.progress.note(f"the bodies went through each other: restarting with steps scaled by {part:g}")
            context.deck = Deck(deck.scene, deck.settings.in_smaller_steps(part))
            try:
                return tried(context)
            except ThroughError as error:
                latest = error
        context.deck = deck
        smaller = f"Steps {1 / shares[-1]:g} times smaller did not help"
        raise ThroughError(f"{latest.message}. {smaller}", latest.advice, latest.changes)

    return searched
