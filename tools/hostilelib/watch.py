"""Runs a program under a limit of time and memory and says what is wrong with how it ended."""

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


def fault_of(status: int, out_of_time: bool, peak_kb: int, error: str, sanitized: bool) -> str:
    if out_of_time:
        return "hang"
    if status < 0:
        return f"crash ({signal.Signals(-status).name})"
    for words in BUGS:
        if words in error:
            return f"failure ({words})"
    if peak_kb > MOST_KB and not sanitized:
        return "memory"
    if status not in (0, 1, 2, 3):
        return f"exit status {status}"
    lines = [line for line in error.splitlines() if line.startswith("vinerow: ")]
    if status == 2 and len(lines) != 1:
        return "exit status 2 without one sentence"
    if status == 3 and not any(words in error for words in BROKEN_OFF):
        return "exit status 3 without a reason"
    return ""


def watch(command: list[str], folder: Path, sanitized: bool) -> Outcome:
    """`folder` is where the program runs."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if not sanitized:  # shadow memory takes terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (3 * MOST_KB * 512, 3 * MOST_KB * 512))

    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors,
            start_new_session=True, preexec_fn=limit)
        late = threading.Event()

        def stop() -> None:
            late.set()
            os.killpg(process.pid, signal.SIGKILL)

        # Time of the processor would be fairer, but a program that waits hangs as well.
        timer = threading.Timer(LONGEST_S * (8 if sanitized else 1), stop)
        timer.start()
        _, waited, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = status = os.waitstatus_to_exitcode(waited)
        errors.seek(0)
        error = errors.read(1 << 20).decode("utf-8", "replace")
    fault = fault_of(status, late.is_set(), usage.ru_maxrss, error, sanitized)
    return Outcome(status, usage.ru_utime + usage.ru_stime, usage.ru_maxrss, error, fault)
