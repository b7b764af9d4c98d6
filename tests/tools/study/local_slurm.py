"""A Slurm of its own on this machine: one controller, two nodes of two processors each, without systemd.

All lies in one folder and listens on loopback. Needs root and Debian's munge, slurmctld, slurmd and slurm-client.
"""

import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import threading
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel")
# Daemons stand in /usr/sbin, which is not in every PATH.
ENVIRONMENT = {**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}

CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000
ReturnToService=2
MaxArraySize={most_tasks}
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
SlurmdTimeout=5
SlurmctldTimeout=10
BatchStartTimeout=10
KillWait=5
MinJobAge=2
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
StateSaveLocation={folder}/controller
SlurmdSpoolDir={folder}/%n
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=2 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=2 State=UNKNOWN
PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def why_not():
    """Why there is no Slurm here; None where there can be one."""
    if os.geteuid() != 0:
        return "a Slurm of its own needs root"
    absent = [name for name in PROGRAMS if shutil.which(name, path=ENVIRONMENT["PATH"]) is None]
    return f"{', '.join(absent)} absent" if absent else None


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class LocalSlurm:
    def __init__(self, folder, most_tasks=1001):
        self.folder = pathlib.Path(folder)
        self.configuration = self.folder / "slurm.conf"
        self.environment = {**ENVIRONMENT, "SLURM_CONF": str(self.configuration)}
        for name in ("controller", "n1", "n2", "munge"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "munge").chmod(0o711)
        port, port1, port2 = free_ports(3)
        self.configuration.write_text(CONFIGURATION.format(host=socket.gethostname().split(".")[0], folder=self.folder, port=port, port1=port1,
                                                           port2=port2, most_tasks=most_tasks))
        (self.folder / "cgroup.conf").write_text("CgroupAutomount=yes\nIgnoreSystemd=yes\n")
        self.daemons = {}
        try:
            self._start_munge()
            self._start("slurmctld", "slurmctld", "-D", "-c", "-f", self.configuration)
            for node in ("n1", "n2"):
                self.start_node(node)
            self._wait(lambda: self.nodes().count("idle") == 2, "both nodes are idle")
        except BaseException:
            self.stop()
            raise

    def _start(self, name, *words, **more):
        with open(self.folder / f"{name}.out", "w") as log:
            self.daemons[name] = subprocess.Popen(list(map(str, words)), env={**self.environment, **more}, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def _start_munge(self):
        place = self.folder / "munge"
        (place / "key").write_bytes(os.urandom(1024))
        (place / "key").chmod(0o400)
        # --force: the folder may stand below one that others may write to, as /tmp.
        self._start("munged", "munged", "--foreground", "--force", f"--socket={place}/socket", f"--key-file={place}/key", f"--pid-file={place}/pid",
                    f"--log-file={place}/log", f"--seed-file={place}/seed")
        self._wait(lambda: (place / "socket").exists(), "munged answers")

    def start_node(self, node):
        # Steps inherit the mark, by which kill_node() finds them.
        self._start(node, "slurmd", "-D", "-N", node, "-f", self.configuration, VINEROW_NODE=node)

    def kill_node(self, node):
        """As a power cut: slurmd and all that it started."""
        self.daemons[node].kill()
        self.daemons[node].wait()
        for process in self.processes(node):
            with contextlib.suppress(ProcessLookupError):  # it may end by itself
                os.kill(process, signal.SIGKILL)

    def words_of(self, process):
        """Its command line; empty if it has ended."""
        try:
            return pathlib.Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")
        except FileNotFoundError:
            return []

    def processes(self, node):
        """All that the node's slurmd started."""
        found = []
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (folder / "environ").read_bytes().split(b"\0")
                is_step = (folder / "comm").read_text().strip() == "slurmstepd"
            except OSError:
                continue
            if f"SLURM_CONF={self.configuration}".encode() not in environment:
                continue
            if f"SLURMD_NODENAME={node}".encode() in environment or (is_step and f"VINEROW_NODE={node}".encode() in environment):
                found.append(int(folder.name))
        return found

    def nodes(self):
        return subprocess.run(["sinfo", "-h", "-N", "-o", "%T"], env=self.environment, capture_output=True, text=True).stdout.split()

    def queue(self):
        """States of all tasks that Slurm still knows."""
        return subprocess.run(["squeue", "-h", "-r", "-t", "all", "-o", "%T"], env=self.environment, capture_output=True, text=True).stdout.split()

    def jobs(self):
        """Numbers of the arrays that wait or run."""
        told = subprocess.run(["squeue", "-h", "-o", "%F"], env=self.environment, capture_output=True, text=True).stdout
        return sorted(set(told.split()))

    @contextlib.contextmanager
    def no_delay_after_a_failure(self):
        """Meanwhile tasks whose node failed begin at once; Slurm lets them wait for two minutes."""
        is_over = threading.Event()

        def release():
            while not is_over.wait(1):
                told = subprocess.run(["squeue", "-h", "-r", "-o", "%i %r"], env=self.environment, capture_output=True, text=True).stdout
                for task in (line.split()[0] for line in told.splitlines() if line.endswith("BeginTime")):
                    subprocess.run(["scontrol", "update", f"JobId={task}", "StartTime=now"], env=self.environment, capture_output=True)

        thread = threading.Thread(target=release)
        thread.start()
        try:
            yield
        finally:
            is_over.set()
            thread.join()

    def _wait(self, condition, words):
        until = time.monotonic() + 60
        while not condition():
            ended = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if ended or time.monotonic() > until:
                logs = "\n".join((self.folder / f"{name}.out").read_text()[-2000:] for name in self.daemons)
                raise RuntimeError(f"not so after a minute: {words} (ended: {ended})\n{logs}")
            time.sleep(0.1)

    def stop(self):
        if "slurmctld" in self.daemons:
            subprocess.run(["scancel", "--full", "-u", "root"], env=self.environment, capture_output=True)
        for daemon in reversed(self.daemons.values()):
            daemon.terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
