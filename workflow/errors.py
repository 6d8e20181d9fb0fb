"""What the program raises for a person to read: what is wrong, what is allowed, what to do.

An error carries its remedy: advice in words, and edits of the scene that the raising place knows to help. Whoever
reports it tries the first of these once (`workflow.runs.advised`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import ClassVar


@dataclass(frozen=True)
class SceneEdit:
    """Values by dotted keys, and effects that are left out."""

    values: Mapping[str, object] = field(default_factory=dict)
    without: tuple[str, ...] = ()


class Contact1dError(Exception):
    """Every error that is about a scene, a folder or a run, and not a mistake in a program.

    Attributes:
        exit_code: of a command that it ends: 2, the scene or the call is wrong; 3, the run failed.
        changes: edits of the scene that may help, the best one first.
    """

    exit_code: ClassVar[int] = 2

    def __init__(self, *arguments: object, changes: Iterable[SceneEdit] = ()) -> None:
        """Keep the changes beside the arguments; both survive pickling."""
        super().__init__(*arguments)
        self._changes = tuple(changes)

    @cached_property
    def message(self) -> str:
        """What is wrong, without where the files are."""
        return str(self)

    @property
    def changes(self) -> tuple[SceneEdit, ...]:
        """See above."""
        return self._changes


class FolderError(Contact1dError, RuntimeError):
    """A folder that no run may be written into, or that no run can be read from."""


class RunError(Contact1dError, RuntimeError):
    """A run that gave no numbers.

    Attributes:
        message: why.
        folder: the run folder.
        kept: whether the run began, so that its files are there, and its results.json says the same.
    """

    exit_code = 3

    def __init__(self, message: str, folder: Path, kept: bool = True) -> None:
        """Keep them; they are arguments, so that the error can be pickled."""
        super().__init__(message, folder, kept)
        self.message, self.folder, self.kept = message, folder, kept

    def __str__(self) -> str:
        """Return the message, and where the files are or would have been."""
        return f"{self.message}\n{'files kept in' if self.kept else 'run folder:'} {self.folder}"


class UntrustedError(Contact1dError, RuntimeError):
    """The run ended, but its result can't be trusted.

    Attributes:
        message: why.
        advice: what to do, where no change was tried; "" where the message says it.
    """

    exit_code = 3

    def __init__(self, message: str, advice: str = "", changes: Iterable[SceneEdit] = ()) -> None:
        """Keep all."""
        super().__init__(message, advice, changes=changes)
        self.message, self.advice = message, advice

    def __str__(self) -> str:
        """Return both, one behind the other."""
        return f"{self.message}: {self.advice}" if self.advice else self.message


class ThroughError(UntrustedError):
    """The bodies went through each other, which may be the path there and not the load (`in_smaller_steps`)."""


class ChainEndError(UntrustedError):
    """The contact is wider than its chain."""


class UnsteadyError(UntrustedError):
    """A slide without steady state: its distance is too short compared with the deflection of the cantilever."""


class OffEndError(UntrustedError):
    """A plate that slid off the lower body."""


class PartedError(UntrustedError):
    """Bodies that do not sustain a tensile force."""


class RestlessError(UntrustedError):
    """A plate that does not relax."""


class TensionError(UntrustedError):
    """A tensile force that the contact does not sustain; `most` is about its pull-off force [FU]."""

    HELD_SHARE = 0.9
    """Tensile force that is suggested, over the pull-off force."""

    def __init__(self, force: float, most: float) -> None:
        """The required force [FU] and the pull-off force; they are the arguments for pickling."""
        suggested = float(f"{-self.HELD_SHARE * most:.3g}")
        super().__init__(
            f"{force:.4g} FU is never reached: the pull-off force is about {most:.4g} FU",
            changes=[SceneEdit({"experiment.force": suggested})],
        )
        self.args = (force, most)
        self.most = most


class DigitsError(UntrustedError):
    """Forces below the round-off error of positions."""


class SettingsError(Contact1dError, ValueError):
    """A scene whose numbers, each allowed, give no computable system; the message says which and what to change."""
