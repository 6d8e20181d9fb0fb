"""What work costs: processor time and memory of this process and of its workers, whatever else the machine does."""

import os
import re
import time
from pathlib import Path


def children() -> list[int]:
    """Process ids of this process's children: LAMMPS."""
    return [int(pid) for task in Path("/proc/self/task").glob("*/children") for pid in task.read_text().split()]


def spent() -> float:
    """Processor time so far [s], the children's included; of differences, since a child's count begins with it."""
    return time.process_time() + sum(map(_of, children()))


def _of(pid: int) -> float:
    """By the clock that Linux has for each process, clock_getcpuclockid(3); 0 for one that has ended."""
    try:
        return time.clock_gettime((~pid << 3) | 2)
    except OSError:
        return 0.0


def peak_memory() -> int:
    """Largest resident memory so far of this process and of each child [bytes]."""
    statuses = (Path(f"/proc/{pid}/status").read_text() for pid in (os.getpid(), *children()))
    return sum(1024 * int(found[1]) for text in statuses if (found := re.search(r"VmHWM:\s+(\d+) kB", text)))
