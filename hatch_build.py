"""A step of hatchling's build: an editable install is refused where the links of src/contact1d are not there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

LINKED = ("analysis", "lammps_inputs", "potentials", "workflow")
"""Folders that src/contact1d has as symbolic links."""


class LinksAreThere(BuildHookInterface[Any]):
    """Only an editable install imports through the links; a wheel is built of the folders themselves."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Abort an editable install of a checkout where src/contact1d lacks one of its four linked folders.

        Nothing is checked for a wheel or a source distribution; `build_data` is not changed.
        """
        missing = [name for name in LINKED if not (Path(self.root) / "src" / "contact1d" / name).is_dir()]
        if version == "editable" and missing:
            self.app.abort(
                f"src/contact1d/{missing[0]} must be a symbolic link to {missing[0]}/, and this copy has none: "
                "check the repository out with `git clone -c core.symlinks=true`, or install with `pip install .`"
            )
