"""A scene as TOML text that reads back as an equal scene, so that a run folder can carry what really ran."""

from __future__ import annotations

from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.tables import Scene


def scene_to_toml(scene: Scene) -> str:
    """The whole `scene` as TOML, with defaults written out: one [table] each, what is inside a table inline."""
    blocks: list[list[str]] = [[]]
    for name, value in scene.model_dump(by_alias=True, exclude_none=True).items():
        if isinstance(value, dict):
            blocks.append([f"[{name}]", *(f"{key} = {as_toml(item)}" for key, item in value.items())])
        else:
            blocks[0].append(f"{name} = {as_toml(value)}")
    return "\n\n".join("\n".join(block) for block in blocks) + "\n"
