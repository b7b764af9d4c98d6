"""Runs a program with limits on time and memory and classifies how it ended."""

import os
import resource
import signal
import subprocess
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path

LONGEST_S = 20.0
MOST_KB = 4 * 1024 * 1024
BROKEN_OFF = ("the run broke off: ", "stopped before its end")
BUGS = ("unexpected failure", "bad_alloc", "internal check", "AddressSanitizer", "runtime error", "std::")


@dataclass
class Outcome:
    status: int  # < 0: minus the signal
    seconds: float
    peak_kb: int
    error: str
    fault: str  # "": as it should be


def fault_of(status: int, out_of_time: bool, peak_kb: int, error: str) -> str:
    if out_of_time:
        return "hang"
    if status < 0:
        return f"crash ({signal.Signals(-status).name})"
    for words in BUGS:
        if words in error:
            return f"failure ({words})"
    if peak_kb > MOST_KB:
        return "memory"
    if status not in (0, 1, 2, 3):
        return f"exit status {status}"
    lines = [line for line in error.splitlines() if line.startswith("vinerow: ")]
    if status == 2 and len(lines) != 1:
        return "exit status 2 without one sentence"
    if status == 3 and not any(words in error for words in BROKEN_OFF):
        return "exit status 3 without a reason"
    return ""


def limit_bytes(sanitized: bool) -> int:
    """Limit on the address space; 0: none, because a sanitizer's shadow memory takes terabytes of it."""
    return 0 if sanitized else 3 * MOST_KB * 512


class Alarm:
    """Kills a process group when its time is over."""

    def __init__(self, process: int, sanitized: bool) -> None:
        # Time of the processor would be fairer, but a program that waits hangs as well.
        self.late, self.process = threading.Event(), process
        self.timer = threading.Timer(LONGEST_S * (8 if sanitized else 1), self._stop)

    def _stop(self) -> None:
        self.late.set()
        os.killpg(self.process, signal.SIGKILL)

    def __enter__(self) -> "Alarm":
        self.timer.start()
        return self

    def __exit__(self, *_) -> None:
        self.timer.cancel()


def watch(command: list[str], folder: Path, sanitized: bool) -> Outcome:
    """Runs the program as a new process in `folder`."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if most := limit_bytes(sanitized):
            resource.setrlimit(resource.RLIMIT_AS, (most, most))

    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors,
            start_new_session=True, preexec_fn=limit)
        with Alarm(process.pid, sanitized) as alarm:
            _, waited, usage = os.wait4(process.pid, 0)
        process.returncode = status = os.waitstatus_to_exitcode(waited)
        errors.seek(0)
        error = errors.read(1 << 20).decode("utf-8", "replace")
    fault = fault_of(status, alarm.late.is_set(), usage.ru_maxrss, error)
    return Outcome(status, usage.ru_utime + usage.ru_stime, usage.ru_maxrss, error, fault)


class ForkServer:
    """The same by tests/hostile/fork_server.cpp, which is started once."""

    def __init__(self, server: Path, sanitized: bool) -> None:
        self.sanitized = sanitized
        self.errors = tempfile.NamedTemporaryFile()
        environment = {**os.environ, "VINEROW_FORK_ERRORS": self.errors.name, "LD_BIND_NOW": "1"}
        if most := limit_bytes(sanitized):
            environment["VINEROW_FORK_BYTES"] = str(most)
        self.process = subprocess.Popen([server], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def watch(self, words: list[str], folder: Path) -> Outcome:
        self.process.stdin.write("\t".join([str(folder), *words]) + "\n")
        self.process.stdin.flush()
        with Alarm(int(self.process.stdout.readline()), self.sanitized) as alarm:
            waited, seconds, peak_kb = self.process.stdout.readline().split()
        status = os.waitstatus_to_exitcode(int(waited))
        with open(self.errors.name, "rb") as file:
            error = file.read(1 << 20).decode("utf-8", "replace")
        fault = fault_of(status, alarm.late.is_set(), int(peak_kb), error)
        return Outcome(status, float(seconds), int(peak_kb), error, fault)

    def close(self) -> None:
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait()
        self.errors.close()
