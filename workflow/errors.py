"""What the program raises for a person to read: each a `Contact1dError` that says what is wrong and what to do."""

from __future__ import annotations

from pathlib import Path


class Contact1dError(Exception):
    """Every error that is about a scene, a folder or a run, and not a mistake in a program."""


class FolderError(Contact1dError, RuntimeError):
    """A folder that no run may be written into, or that no run can be read from."""


class RunError(Contact1dError, RuntimeError):
    """A run that gave no numbers.

    Attributes:
        message: why.
        folder: the run folder.
        kept: whether the run began, so that its files are there, and its results.json says the same.
    """

    def __init__(self, message: str, folder: Path, kept: bool = True) -> None:
        """Keep them; they are arguments, so that the error can be pickled."""
        super().__init__(message, folder, kept)
        self.message, self.folder, self.kept = message, folder, kept

    def __str__(self) -> str:
        """Return the message, and where the files are or would have been."""
        return f"{self.message}\n{'files kept in' if self.kept else 'run folder:'} {self.folder}"
