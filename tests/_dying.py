"""Runs the command line of this very tree in a process that dies when it is told to.

    python tests/_dying.py never FOLDER convert ...    says at its end what it took
    python tests/_dying.py 17 FOLDER convert ...       killed at the 17th thing it does to files in FOLDER
    python tests/_dying.py 0.35s FOLDER convert ...    killed after so much of a processor's time

All that takes long to load is loaded before, so that deaths fall into the work.
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
TOUCHED = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.listdir", "os.scandir", "os.link")


class Touches:
    """Counts what is done to files in a folder; ends the process at one of them."""

    def __init__(self, folder: str, last: int | None) -> None:
        self.folder, self.last, self.count = folder, last, 0

    def __call__(self, event: str, given: tuple[Any, ...]) -> None:
        """Be told of everything Python does."""
        if event in TOUCHED and any(self.is_inside(one) for one in given[:2]):
            self.count += 1
            if self.count == self.last:
                os.kill(os.getpid(), signal.SIGKILL)

    def is_inside(self, one: object) -> bool:
        """Whether a call's argument is a path in the folder."""
        return isinstance(one, str | os.PathLike) and os.fspath(one).startswith(self.folder)


def main() -> int:
    """Run, or die."""
    when, folder, *words = sys.argv[1:]
    import bpy  # noqa: F401
    import keymark.operators.bridge.result_files  # noqa: F401
    from keymark.operators.cli.main import main as run
    from keymark.operators.cli.use_cases import convert  # noqa: F401

    touches = Touches(folder, int(when) if when.isdigit() else None)
    sys.addaudithook(touches)
    begun = time.process_time()
    if when.endswith("s"):  # what it counts ends the process as a kill does: nothing catches it
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, float(when.removesuffix("s")))
    status = run(words)
    signal.setitimer(signal.ITIMER_PROF, 0.0)
    print(json.dumps({"touches": touches.count, "cpu_s": time.process_time() - begun}))
    return status


if __name__ == "__main__":
    sys.exit(main())
