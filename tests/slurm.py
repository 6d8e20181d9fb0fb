"""A real Slurm on this machine, for as long as a test lasts: daemons that listen on 127.0.0.1 only.

Its nodes, one or more, are names: each has a daemon of its own, and all are this machine.
"""

import getpass
import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

PATIENCE = 60.0
"""Seconds in which all must be there; they take about one."""
FAREWELL = 5.0
"""Seconds that a daemon has to end by itself."""
CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
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
PartitionName=local Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=2 State=UNKNOWN\n"


@contextmanager
def slurm(folder: Path, nodes: int = 1) -> Iterator[dict[str, str]]:
    """Start it; gives the environment in which sbatch finds it. What runs in it when the block ends is killed."""
    names = [f"node{number}" for number in range(1, nodes + 1)]
    for name in ("state", *names):
        (folder / name).mkdir(parents=True)
    host = socket.gethostname().split(".")[0]
    controller, *ports = _free_ports(1 + nodes)
    text = CONFIGURATION.format(host=host, folder=folder, user=getpass.getuser(), controller=controller)
    text += "".join(NODE.format(name=name, host=host, port=port) for name, port in zip(names, ports, strict=True))
    (folder / "slurm.conf").write_text(text)
    path = os.environ["PATH"] + os.pathsep + "/usr/sbin"
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": path}
    try:
        subprocess.run(["slurmctld", "-c"], env=environment, check=True)
        for name in names:
            subprocess.run(["slurmd", "-N", name], env=environment, check=True)
        until = time.monotonic() + PATIENCE
        while set(_states(environment)) != {"idle"}:
            assert time.monotonic() < until, (folder / "slurmctld.log").read_text()[-2000:]
            time.sleep(0.2)
        yield environment
    finally:
        subprocess.run(["scancel", "--full", "-u", getpass.getuser()], env=environment, check=False)
        for name in (*names, "slurmctld"):
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


def _states(environment: dict[str, str]) -> list[str]:
    asked = ["sinfo", "--noheader", "--Node", "--format=%T"]
    return subprocess.run(asked, env=environment, capture_output=True, text=True, check=False).stdout.split()


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
