"""A deck under the hand: its contact opened in a folder, so that single particles can be moved and read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments.running.contact import Contact
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for

TIME_LIMIT = 7200.0
"""Of LAMMPS [s], far above what anything takes: what hangs has failed."""
LAW = {
    "repulsion": {"amplitude": 0.18, "range": 0.13},
    "attraction": {"amplitude": 0.09, "range": 0.26},
}
"""The paper's kind of contact: ranges near the spacing, so that particles feel several opposite ones."""
BODIES = {
    "particles": 12,
    "spacing": 1.0,
    "profile": {"kind": "parabola", "radius": 40.0},
    "bulk_stiffness": 0.83,
}


@contextmanager
def contact_of(tables: dict[str, Any], folder: Path, **settings: Any) -> Iterator[Contact]:
    """The contact of a scene, at displacement 0; `settings` in place of the chosen ones."""
    scene = scene_from_dict({"title": folder.name} | tables)
    deck = Deck(scene, replace(settings_for(scene), **settings))
    folder.mkdir(parents=True, exist_ok=True)
    write_system(deck, folder)
    with RunContext(deck, folder, Silent(), TIME_LIMIT).contact() as contact:
        yield contact
