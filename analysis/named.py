"""A dictionary whose values are attributes, too, for the eye and for completion."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")


class Named(dict[str, T]):
    """A dictionary whose values are also attributes: `curve.force` is `curve["force"]`."""

    def __missing__(self, name: str) -> T:
        """Raise KeyError with the names that there are; a missing name has no default value."""
        raise KeyError(f"there is no {name}, there are {', '.join(self) or 'none'}")

    def __getattr__(self, name: str) -> T:
        """Return the value of that name. Raises AttributeError without one.

        Attributes of a dict have priority: a value named `items` or `keys` is reached by its key only.
        """
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self) -> list[str]:
        """Return the names for completion in an editor: those of the attributes of a dict, then those of the values."""
        return [*super().__dir__(), *self]
