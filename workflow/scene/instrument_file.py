"""Line scans and maps in the files of instruments, as SurfaceTopography reads them (the extra `instruments`)."""

from __future__ import annotations

from pathlib import Path

ENDINGS = frozenset({
    ".al3d", ".datx", ".frt", ".gwy", ".h5", ".ibw", ".jpk", ".mat", ".mi", ".nc", ".nid", ".nms", ".opd", ".opdx",
    ".os3d", ".plu", ".plux", ".spm", ".sur", ".vk3", ".vk4", ".vk6", ".x3p", ".zon",
})  # fmt: skip
"""Endings of the files of instruments, which are not text."""


class ProfileFileError(ValueError):
    """A file that is no profile; the message has the error, and the line in a text file."""


def read_line(path: Path) -> tuple[list[float], list[float], str]:
    """Return (positions, heights, their unit, such as "µm") of the line along x through the highest point of a scan.

    Of a line scan it is the whole; positions are as in the file. An instrument's heights grow out of the sample, those
    of a profile away from the plane: their sign is changed.

    Raises:
        ProfileFileError: SurfaceTopography is not installed, or can't read the file, or the scan has no unit, or the
            line has gaps.
        ValueError: a map has no heights at all.
    """
    try:
        import numpy as np
        from SurfaceTopography import read_topography
    except ImportError:
        raise ProfileFileError(
            "is a file of an instrument, which SurfaceTopography reads: pip install contact1d[instruments], or export "
            "the line as text with columns x and z"
        ) from None
    try:
        scan = read_topography(str(path))
        x, *_, heights = scan.positions_and_heights()
    except Exception as error:
        reason = type(error).__name__  # its text may quote the file
        raise ProfileFileError(f"SurfaceTopography can't read it ({reason}); export the line as text") from None
    heights = np.ma.filled(heights, np.nan)
    if not scan.unit:
        raise ProfileFileError("has no unit; export the line as text, with units in the names: x [µm], z [nm]")
    if scan.dim == 2:
        row = np.unravel_index(np.nanargmax(heights), heights.shape)[1]
        x, heights = x[:, row], heights[:, row]
    if not np.isfinite(heights).all():
        raise ProfileFileError("has gaps in the line through its highest point; fill them, or export another line")
    return x.tolist(), (-heights).tolist(), str(scan.unit)
