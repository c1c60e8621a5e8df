"""Memory and processors of the machine; as a script, a worker of a batch in plain Python."""

import importlib.util
import os
import sys
from contextlib import suppress
from pathlib import Path


def resident_bytes() -> int | None:
    """Resident memory of this process, or else its peak; None where the system tells neither."""
    with suppress(OSError, ValueError, IndexError):
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")
    try:
        import resource
    except ImportError:  # Windows
        return None
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else most * 1024


def usual_workers(most: int) -> int:
    """A worker for each processor that this process may use, as far as each gets the memory it may need."""
    memory = [most * 1.5 * 2**30]
    with suppress(OSError, ValueError, AttributeError):
        memory.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    with suppress(OSError, ValueError):  # of a Linux container; the word max stands for no limit
        memory.append(int(Path("/sys/fs/cgroup/memory.max").read_text(encoding="ascii")))
    fitting = int(min(size for size in memory if size > 0) // (1.5 * 2**30))
    own = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min(own, fitting))


ROOT = Path(__file__).resolve().parents[3]
PACKAGE = "keymark"


def main() -> int:
    """Run the command `worker`; returns the exit status."""
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    sys.modules[PACKAGE] = package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    status: int = importlib.import_module(f"{PACKAGE}.operators.cli.main").main(["worker"])
    return status


if __name__ == "__main__":
    sys.exit(main())
