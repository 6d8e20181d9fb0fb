"""What a run keeps besides its results."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Discriminator, Field, Tag

from contact1d.workflow.scene.quantities import Table, Unit

StateCount = Annotated[int, Ge(2), Le(1_000_000), Unit("1")]


def _number_or_all(value: object) -> str:
    return "all" if isinstance(value, str) else "number"


Kept = Annotated[
    Annotated[StateCount, Tag("number")] | Annotated[Literal["all"], Tag("all")], Discriminator(_number_or_all)
]


class Output(Table):
    """What is kept besides the results."""

    states: Kept = Field(
        description="how many states of the whole way states.lammpstrj holds, each with all atoms' places and the "
        'force of the opposite body on them: so many, evenly among the rows of curve.csv, or "all" of these; without '
        "this table it has the reported states only"
    )
