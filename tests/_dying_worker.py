"""A worker that is killed in the middle of a take, before its files are complete.

Usage: _dying_worker.py FOLDER. Every file in FOLDER is one kill in the take that its name begins with: the
file is removed, and the process kills itself.
"""

import os
import signal
import sys
from pathlib import Path
from typing import Any

from _boot import load_package

load_package()

from keymark.operators.cli.conversion import convert_take  # noqa: E402
from keymark.operators.cli.main import main  # noqa: E402

write = convert_take.write_blender_files


def write_or_die(take: Any, motion: Any, place: Path, *rest: Any) -> None:
    """Write the scene, unless a kill is due."""
    assert (place / "motion.json").is_file()
    for due in Path(sys.argv[1]).glob(f"{take.name}*"):
        due.unlink()
        os.kill(os.getpid(), signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
    write(take, motion, place, *rest)


convert_take.write_blender_files = write_or_die
sys.exit(main(["worker"]))
