"""Processor time and memory of a process."""

import resource
import time
from collections.abc import Callable
from pathlib import Path

STATUS = Path("/proc/self/status")


def processor_time(work: Callable[[], object]) -> float:
    """Processor time of a call [s]."""
    start = time.process_time()
    work()
    return time.process_time() - start


def peak_memory_mb() -> float:
    """Peak resident memory of this process [MB of 2^20 bytes]."""
    if STATUS.is_file():  # elsewhere a process may inherit the peak of the one that started it
        for line in STATUS.read_text(encoding="ascii").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
