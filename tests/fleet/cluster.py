# SPDX-FileCopyrightText: 2026 the steerid authors
# SPDX-License-Identifier: Apache-2.0

"""A Slurm cluster of its own: a controller and two nodes on 127.0.0.1, with their state in a folder of the test's.

For tests only: auth/none and cred/none accept whoever asks.
"""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("slurmctld", "slurmd", "sbatch", "sinfo", "squeue")
NODES = ("n1", "n2")

CONFIG = """
ClusterName=steerid
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={controller}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=2,batch_sched_delay=1,sched_min_interval=100000,bf_interval=2
SlurmdParameters=config_overrides
SlurmdTimeout=5
SlurmctldTimeout=30
KillWait=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
{nodes}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing_programs():
    return [program for program in PROGRAMS if not program_path(program)]


def program_path(program):
    return shutil.which(program) or shutil.which(program, path="/usr/sbin:/sbin")


def free_ports(count):
    """Ports that nobody listens at; all are held until the last is found, so that they differ."""
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_for(what, condition, seconds):
    """What `condition` gives as soon as it is true; the time is a limit for a machine under load."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.2)
    raise AssertionError(f"{what}: did not come about within {seconds} s")


class Cluster:
    """Started on entry, and gone with every process of its jobs on exit."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.servers = {}
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def __enter__(self):
        controller, *ports = free_ports(1 + len(NODES))
        lines = [f"NodeName={node} NodeHostname=localhost NodeAddr=127.0.0.1 Port={port} CPUs=2 RealMemory=100"
                 for node, port in zip(NODES, ports)]
        for name in ["state", *(f"spool.{node}" for node in NODES)]:
            (self.folder / name).mkdir(parents=True)
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            controller=controller, user=getpass.getuser(), folder=self.folder, nodes="\n".join(lines)), encoding="utf-8")
        try:
            self.start("slurmctld", "slurmctld", "-D")
            for node in NODES:
                self.start(node, "slurmd", "-D", "-N", node)
            wait_for("both nodes idle", lambda: self.states() == {node: "idle" for node in NODES}, 60)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for server in self.servers.values():
            server.kill()
            server.wait()
        for process in self.processes():
            kill(process)

    def start(self, name, program, *options):
        self.servers[name] = subprocess.Popen(
            [program_path(program), *options, "-f", self.folder / "slurm.conf"],
            env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def run(self, *command, **environment):
        return subprocess.run([str(word) for word in command], env={**self.environment, **environment}, check=True,
                              capture_output=True, text=True, timeout=60).stdout

    def states(self):
        """State of each node, such as idle, mixed or down; empty while the controller does not answer."""
        try:
            lines = self.run("sinfo", "-h", "-N", "-o", "%N %T").splitlines()
        except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
            return {}
        return {node: state.rstrip("*~#!%$@^-") for node, state in (line.split() for line in lines)}

    def kill_server(self, node):
        """Ends the node's slurmd. What runs there goes on."""
        server = self.servers.pop(node)
        server.kill()
        server.wait()

    def processes(self, **wanted):
        """Numbers of the processes that belong to this cluster's jobs and have `wanted` in their environment."""
        marks = {f"{name}={value}".encode() for name, value in wanted.items()}
        marks.add(f"SLURM_CONF={self.folder / 'slurm.conf'}".encode())
        found = []
        for environment in pathlib.Path("/proc").glob("[0-9]*/environ"):
            number = int(environment.parent.name)
            try:
                has = set(environment.read_bytes().split(b"\0"))
            except OSError:
                continue  # it is another user's, or has ended
            if marks <= has and number != os.getpid():
                found.append(number)
        return found


def kill(process):
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        pass
