"""What kind of machine this is, for a record: processors and system, and no names."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path

CPUINFO = Path("/proc/cpuinfo")


def machine(cpuinfo: Path = CPUINFO) -> str:
    """Return "x86_64 with 2 processors (AMD EPYC) under Linux"; the family where the system tells it."""
    kind = family(cpuinfo)
    return (
        f"{platform.machine()} with {os.cpu_count()} processors{f' ({kind})' if kind else ''} under {platform.system()}"
    )


def family(cpuinfo: Path = CPUINFO) -> str:
    """Maker and line of the processor, the words before the first number; "" where nothing tells it."""
    try:
        found = re.search(r"^model name\s*:\s*(.*)$", cpuinfo.read_text(encoding="utf-8"), re.MULTILINE)
    except OSError:
        return ""
    words = re.sub(r"\((R|TM)\)", "", found[1]).split() if found else []
    end = next((i for i, word in enumerate(words) if any(map(str.isdigit, word))), len(words))
    return " ".join(words[:end])
