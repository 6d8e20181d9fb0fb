"""The closed forms beside the results of a run: every one that applies, with the deviation of each result from it.

results.json has them as `theory`: a list of {"name", "source", "applies", "values"}; of each result in `values` the
closed form's "value" and "unit", with known units "si", and "deviation", the run's value over it minus 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from contact1d.workflow.body.adhesive_forms import ADHESIVE
from contact1d.workflow.body.closed_form import Case, ClosedForm
from contact1d.workflow.body.indenters import INDENTERS
from contact1d.workflow.body.sheared import SHEARED
from contact1d.workflow.body.tabor_forms import BY_TABOR
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity, Scales, scale_of

FORMS: tuple[ClosedForm, ...] = (*INDENTERS, *ADHESIVE, *BY_TABOR, *SHEARED)
"""Every closed form that a run is laid beside; which of them applies each says itself."""


SHOWN = 6
"""Places of a deviation in percent: below that it is round-off."""


def applying(case: Case) -> list[ClosedForm]:
    """The closed forms that hold for a case."""
    return [form for form in FORMS if form.applies(case)]


def theory(scene: Scene, quantities: Mapping[str, Quantity], scales: Scales | None) -> list[dict[str, Any]]:
    """What results.json has as `theory`; `quantities` of the body, `scales` of the run."""
    case = Case(scene, quantities)
    return [_entry(form, case, scales) for form in applying(case)]


def _entry(form: ClosedForm, case: Case, scales: Scales | None) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, value in form.values(case).items():
        if name not in case.quantities:
            continue
        ours = case.quantities[name]
        values[name] = {"value": value, "unit": ours.unit}
        if scales is not None:
            si = scales.in_si(value, 0.0, ours.unit)
            values[name]["si"] = {"value": si["value"], "unit": si["unit"]}
        values[name]["deviation"] = ours.value / value - 1.0 if value else None
    return {"name": form.name, "source": form.source, "applies": form.applies(case), "values": values}


def in_words(results: Mapping[str, Any], name: str) -> Iterator[str]:
    """What each closed form says of a result, and how far the result is from it: `Hertz 110.37 µm (+0.001 %)`."""
    for form in results.get("theory", ()):
        if said := form["values"].get(name):
            number = f"{said['value']:.5g} {said['unit']}"
            if "si" in said:
                factor, unit = scale_of(said["si"]["value"], said["si"]["unit"])
                number = f"{said['si']['value'] * factor:.5g} {unit}"
            off = "" if said["deviation"] is None else f" ({round(100.0 * said['deviation'], SHOWN) + 0.0:+.2g} %)"
            yield f"{form['name']} {number}{off}"
