"""A real Slurm of one node on this machine, for as long as a test lasts: two daemons that listen on 127.0.0.1 only."""

from __future__ import annotations

import getpass
import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

DAEMONS = ("slurmctld", "slurmd")
PATIENCE = 60.0
"""Seconds in which both must be there; they take about one."""
FAREWELL = 5.0
"""Seconds that a daemon has to end by itself."""
CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0,sched_min_interval=0
ReturnToService=2
MpiDefault=none
PlugStackConfig=/dev/null
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=local Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


@contextmanager
def slurm(folder: Path) -> Iterator[dict[str, str]]:
    """Start it; gives the environment in which sbatch finds it. What runs in it when the block ends is killed."""
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    host = socket.gethostname().split(".")[0]
    ports = _free_ports()
    text = CONFIGURATION.format(host=host, folder=folder, user=getpass.getuser(), controller=ports[0], node=ports[1])
    (folder / "slurm.conf").write_text(text)
    path = os.environ["PATH"] + os.pathsep + "/usr/sbin"
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": path}
    try:
        subprocess.run(["slurmctld", "-c"], env=environment, check=True)
        subprocess.run(["slurmd"], env=environment, check=True)
        until = time.monotonic() + PATIENCE
        while _state(environment) != "idle":
            assert time.monotonic() < until, (folder / "slurmctld.log").read_text()[-2000:]
            time.sleep(0.2)
        yield environment
    finally:
        subprocess.run(["scancel", "--full", "-u", getpass.getuser()], env=environment, check=False)
        for name in reversed(DAEMONS):
            with suppress(OSError, ValueError):
                _end(int((folder / f"{name}.pid").read_text()))


def _end(daemon: int) -> None:
    """Ask a daemon to end; one that waits for a job that was cancelled does not. Raises OSError once it is gone."""
    until = time.monotonic() + FAREWELL
    os.kill(daemon, signal.SIGTERM)
    while time.monotonic() < until:
        time.sleep(0.1)
        os.kill(daemon, 0)
    os.kill(daemon, signal.SIGKILL)


def _state(environment: dict[str, str]) -> str:
    asked = ["sinfo", "--noheader", "--format=%T"]
    return subprocess.run(asked, env=environment, capture_output=True, text=True, check=False).stdout.strip()


def _free_ports() -> tuple[int, int]:
    with socket.socket() as first, socket.socket() as second:
        first.bind(("127.0.0.1", 0))
        second.bind(("127.0.0.1", 0))
        return first.getsockname()[1], second.getsockname()[1]
