"""Errors for the user: what is wrong, what is allowed, what to do.

An error has its suggested fix: advice in words, and edits of the scene that the raising function knows to help.
`workflow.runs.advised` tries the first of these once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import ClassVar


@dataclass(frozen=True)
class SceneEdit:
    """A change of a scene that may help.

    Attributes:
        values: new values by the dotted keys of the scene, as "experiment.force".
        without: names of sections to leave out, as "horizontal".
    """

    values: Mapping[str, object] = field(default_factory=dict)
    without: tuple[str, ...] = ()


class Contact1dError(Exception):
    """An error in a scene, a folder or a run, and not in a program.

    Attributes:
        exit_code: exit code of the command line: 2, the scene or the call is wrong; 3, the run failed.
        changes: edits of the scene that may help, the best one first.
    """

    exit_code: ClassVar[int] = 2

    def __init__(self, *arguments: object, changes: Iterable[SceneEdit] = ()) -> None:
        """Store `arguments` as `args`, and the changes as a tuple; both are kept by pickling."""
        super().__init__(*arguments)
        self._changes = tuple(changes)

    @cached_property
    def message(self) -> str:
        """What is wrong, as text: `str(self)`, cached at the first access.

        An error of a run, of a result that can't be trusted or of LAMMPS stores here its argument `message`, without
        folder, advice or phase.
        """
        return str(self)

    @property
    def changes(self) -> tuple[SceneEdit, ...]:
        """Edits of the scene that may help, the best one first; () where the error was raised without any."""
        return self._changes


class FolderError(Contact1dError, RuntimeError):
    """A folder into which no run may be written, or from which no run can be read."""


class RunError(Contact1dError, RuntimeError):
    """A run that gave no numbers.

    Attributes:
        message: why.
        folder: the run folder.
        kept: whether the run began: then its files are in the folder, and its results.json has the message.
    """

    exit_code = 3

    def __init__(self, message: str, folder: Path, kept: bool = True) -> None:
        """Store message, run folder and `kept` (files are in it) as attributes and in `args`, for pickling.

        There are no suggested edits: `changes` is ().
        """
        super().__init__(message, folder, kept)
        self.message, self.folder, self.kept = message, folder, kept

    def __str__(self) -> str:
        """Return two lines: the message; then "files kept in" (where `kept`) or "run folder:" with the run folder."""
        return f"{self.message}\n{'files kept in' if self.kept else 'run folder:'} {self.folder}"


class UntrustedError(Contact1dError, RuntimeError):
    """The run ended, but its result can't be trusted.

    Attributes:
        message: why.
        advice: what to do, where no change was tried; "" where the message says it.
    """

    exit_code = 3

    def __init__(self, message: str, advice: str = "", changes: Iterable[SceneEdit] = ()) -> None:
        """Store the message and the advice, both also in `args`, and the suggested edits of the scene as a tuple."""
        super().__init__(message, advice, changes=changes)
        self.message, self.advice = message, advice

    def __str__(self) -> str:
        """Return the message, or "message: advice" where the advice is not empty."""
        return f"{self.message}: {self.advice}" if self.advice else self.message


class ThroughError(UntrustedError):
    """The bodies went through each other, maybe due to load steps that are too large (`in_smaller_steps`)."""


class TensionError(UntrustedError):
    """A tensile force that the contact does not sustain, with the suggested fix, 0.9 of the pull-off force.

    Attributes:
        most: about the pull-off force [FU], positive.
    """

    def __init__(self, force: float, most: float) -> None:
        """Store the pull-off force `most` [FU], positive, and both arguments as `args`, for pickling.

        `force` is the required one [FU], tension negative. The message names both, to four digits; the advice is "".
        The one suggested edit sets experiment.force to −0.9 `most` [FU], to three digits.
        """
        suggested = float(f"{-0.9 * most:.3g}")  # a tensile force that the contact sustains
        super().__init__(
            f"{force:.4g} FU is never reached: the pull-off force is about {most:.4g} FU",
            changes=[SceneEdit({"experiment.force": suggested})],
        )
        self.args = (force, most)
        self.most = most


class SettingsError(Contact1dError, ValueError):
    """A scene whose numbers, each allowed, give no computable system; the message says which and what to change."""
