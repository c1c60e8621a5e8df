"""Runs the command line of this tree in a process that is killed at a given moment.

    python tests/_dying.py never FOLDER convert ...    prints file operations and processor time at its end
    python tests/_dying.py 17 FOLDER convert ...       killed at the 17th file operation in FOLDER
    python tests/_dying.py 0.35s FOLDER convert ...    killed after 0.35 s of processor time

Modules that load slowly are imported before, so that the kill falls into the work.
"""

import json
import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

from _boot import load_package  # noqa: E402

load_package()
FILE_EVENTS = (
    *("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir"),
    *("os.listdir", "os.scandir", "os.link"),
)


class FileOperations:
    """Counts the operations on files in a folder; kills the process at one of them."""

    def __init__(self, folder: str, last: int | None) -> None:
        self.folder, self.last, self.count = folder, last, 0

    def __call__(self, event: str, given: tuple[Any, ...]) -> None:
        """Audit hook of Python."""
        if event in FILE_EVENTS and any(self.is_inside(one) for one in given[:2]):
            self.count += 1
            if self.count == self.last:
                os.kill(os.getpid(), signal.SIGKILL)

    def is_inside(self, one: object) -> bool:
        """Whether a call's argument is a path in the folder."""
        return isinstance(one, str | os.PathLike) and os.fspath(one).startswith(self.folder)


def main() -> int:
    """Run the command line until its end, or until it is killed."""
    when, folder, *words = sys.argv[1:]
    import bpy  # noqa: F401
    import keymark.operators.bridge.result_files  # noqa: F401
    from keymark.operators.cli.commands import convert  # noqa: F401
    from keymark.operators.cli.main import main as run

    operations = FileOperations(folder, int(when) if when.isdigit() else None)
    sys.addaudithook(operations)
    begun = time.process_time()
    if when.endswith("s"):  # the timer ends the process as a kill does: nothing catches it
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, float(when.removesuffix("s")))
    status = run(words)
    signal.setitimer(signal.ITIMER_PROF, 0.0)
    print(json.dumps({"operations": operations.count, "cpu_s": time.process_time() - begun}))
    return status


if __name__ == "__main__":
    sys.exit(main())
