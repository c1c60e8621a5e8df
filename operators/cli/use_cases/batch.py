"""`keymark batch`."""

import argparse
import errno
import os
import re
from collections.abc import Sequence
from contextlib import suppress
from difflib import get_close_matches
from functools import partial
from pathlib import Path

from ....core.errors import ConversionError, InputError
from ....core.files.fields import listed
from ....core.shoot.finding.open_shoot import open_shoot
from ....core.shoot.finding.take_names import check_output
from ....core.shoot.shoot import Shoot, ShootTake, part_of
from ....core.take.conversion_settings import HIGHEST_FLOOR_M, ConversionSettings
from ..batch.batch_outcomes import Tally
from ..batch.machine_resources import machine_bytes, processors
from ..batch.protocol import Job
from ..batch.worker_pool import Supervisor
from ..batch.worker_process import LONGEST_SILENCE_S, WorkerProcess, worker_words
from ..console import Console, arguments_console
from ..library_search_path import requested_libraries
from ..require_blender import require_blender
from ..usage import UsageError

WORKER_BYTES = 1.5 * 2**30
"""What a worker may need; the default number of jobs leaves each so much."""
MOST_JOBS = 1000
MOST_PARTS = 10**6
NAMED = 5
"""So many failed takes are named in the last line."""


def batch_command(arguments: argparse.Namespace) -> None:
    """Convert the takes that the command line names, and say what became of each.

    Raises:
        InputError: The shoot or the folder for the results is unusable; nothing was written.
        ConversionError: A take has failed, or no worker starts.
        KeyboardInterrupt: The batch was interrupted; its text says how far it has come.
    """
    shoot, takes, farther = _plan(arguments)
    require_blender("writing motion.blend needs")
    output: Path = arguments.output
    try:
        output.mkdir(parents=True, exist_ok=True)
        if not os.access(output, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, "no permission")
    except OSError as error:
        raise InputError(f"{output}: cannot be written ({error.strerror}); name a folder that can") from error
    jobs = [Job(take, output / take.name, farther, arguments.again, arguments.debug) for take in takes]
    with arguments_console(arguments) as console:
        _convert(shoot, jobs, arguments, console)


def _convert(shoot: Shoot, jobs: Sequence[Job], arguments: argparse.Namespace, console: Console) -> None:
    tally = Tally(shoot, arguments.output, jobs, console)
    start = partial(WorkerProcess.started, worker_words(), arguments.debug, LONGEST_SILENCE_S)
    try:
        Supervisor(jobs, start, tally).run(min(_workers(arguments.jobs), max(len(jobs), 1)))
        tally.finish()
    except KeyboardInterrupt:
        with suppress(KeyboardInterrupt):  # whoever is in such a hurry can do without a summary
            tally.finish()
        counts = tally.counts
        ready = counts["converted"] + counts["unchanged"]
        wrong = f", {counts['failed']} failed" if counts["failed"] else ""
        raise KeyboardInterrupt(
            f"interrupted; {ready} of {len(jobs)} takes are converted{wrong}; the same command goes on"
        ) from None
    except ConversionError:
        tally.finish()
        raise
    console.finish(tally.to_dict(), tally.text())
    failed = [outcome.take for outcome in tally.outcomes if outcome.error is not None]
    if failed and arguments.failed_takes == "fail":
        where = f"; {tally.files[-1]} says why" if tally.files else ""
        raise ConversionError(f"{len(failed)} of {len(jobs)} takes failed: {listed(failed, NAMED)}{where}")
    if tally.wrong:
        raise ConversionError(tally.wrong[0])


def _plan(arguments: argparse.Namespace) -> tuple[Shoot, list[ShootTake], ConversionSettings]:
    """The whole shoot, the takes of it to convert, and how those that say nothing are converted.

    Raises:
        UsageError: An option is unusable.
        InputError: The shoot is unusable, or there is no such library.
    """
    part, parts = _part(arguments.part)
    if arguments.jobs is not None and not 1 <= arguments.jobs <= MOST_JOBS:
        raise UsageError(f"--jobs is {arguments.jobs}; a number from 1 to {MOST_JOBS} is valid")
    if arguments.floor is not None and not abs(arguments.floor) <= HIGHEST_FLOOR_M:
        raise UsageError(f"--floor is {arguments.floor:g}; a height within {HIGHEST_FLOOR_M:g} m is valid")
    if arguments.library is not None:
        requested_libraries(arguments.library)
    shoot = open_shoot(arguments.shoot, without=arguments.output)
    check_output(shoot, arguments.output)
    takes = _named(shoot, arguments.take) if arguments.take else shoot.takes
    farther = ConversionSettings(
        library=arguments.library,
        floor_m=arguments.floor,
        method=arguments.method,
        pictures=False if arguments.no_report else None,
    )
    return shoot, part_of(takes, part, parts), farther


def _part(text: str | None) -> tuple[int, int]:
    if text is None:
        return 1, 1
    found = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text.strip(), re.ASCII)
    part, parts = (int(number) for number in found.groups()) if found else (0, 0)
    if not 1 <= part <= parts <= MOST_PARTS:
        raise UsageError(f"--part is {text}; K/N is valid with K from 1 to N, as in 2/5")
    return part, parts


def _named(shoot: Shoot, names: Sequence[str]) -> list[ShootTake]:
    by_name = {take.name: take for take in shoot.takes}
    for name in names:
        if name.rstrip("/") not in by_name:
            close = get_close_matches(name[:200], list(by_name)[:1000], n=1)
            hint = f" (is {close[0]} meant?)" if close else ""
            raise UsageError(f"--take is {name}{hint}; {shoot.path} has {listed(by_name, NAMED)}")
    wanted = {name.rstrip("/") for name in names}
    return [take for take in shoot.takes if take.name in wanted]


def _workers(wanted: int | None) -> int:
    if wanted is not None:
        return wanted
    memory = machine_bytes()
    fitting = MOST_JOBS if memory is None else int(memory // WORKER_BYTES)
    return max(1, min(processors(), fitting))
