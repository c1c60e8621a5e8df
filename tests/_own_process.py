"""The end of a script that uses Rigify, in a process of its own.

A process that has used Rigify may hang when it ends as usual.
"""

import os
import sys
import traceback
from collections.abc import Callable
from typing import NoReturn


def make_and_end(make: Callable[[str], None]) -> NoReturn:
    """Let `make` write the file that the command line names last, and end the process at once.

    The exit status is 0, or 1 after an exception, which is printed.
    """
    status = 0
    try:
        make(sys.argv[-1])
    except Exception:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
