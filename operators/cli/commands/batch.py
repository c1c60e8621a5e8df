"""`keymark batch`: convert every take of a shoot, several at a time.

Takes that are converted already are skipped by the worker processes (`conversion/convert_take`).
"""

import argparse
import errno
import os
import re
from contextlib import suppress
from difflib import get_close_matches
from pathlib import Path

from ....core.errors import ConversionError, InputError
from ....core.files.fields import listed
from ....core.report.batch_page import current_record
from ....core.shoot.discovery import Shoot, ShootTake, check_output, open_shoot
from ....core.take.conversion_settings import ConversionSettings
from ..batch.machine_resources import usual_workers
from ..batch.outcomes import BatchOutcomes
from ..batch.worker_pool import WorkerPool
from ..batch.worker_process import HEARTBEAT_TIMEOUT_S, Job, worker_command_line
from ..console import Console, UsageError, argument, command, require_blender
from ..options import HANDS, PICTURES, SHOOT_HELP, SHOOT_OPTIONS, given_settings, jobs_option, output

MOST_JOBS = 1000
MOST_NAMED = 5


@command(
    argument("shoot SHOOT", SHOOT_HELP, type=Path),
    *output("DIR", "folder for all results, new or old"),
    jobs_option(
        MOST_JOBS,
        "convert N takes at a time, each in a process of its own; by default one for each processor, at "
        "most one for each 1.5 GB of memory",
    ),
    argument("--part K/N", "convert the K-th of N shares of the takes only, as one of N machines"),
    argument(
        "--take NAME",
        "convert this take only, named by its way from SHOOT; may be given several times",
        action="append",
    ),
    argument("--again", "convert takes anew that are converted already"),
    *SHOOT_OPTIONS,
    PICTURES,
    HANDS,
    argument(
        "--failed-takes",
        "what the exit status says where takes have failed: 1 with fail, 0 with pass, so that a "
        "farm goes on to the tasks that wait for this one; merge then names them (default: %(default)s)",
        choices=("fail", "pass"),
        default="fail",
    ),
)
def batch_command(arguments: argparse.Namespace, console: Console) -> None:
    """Converts every take below a folder, or those of a list, each into DIR under its way from SHOOT.

    Takes that were converted before from the same input and settings are skipped, so that a batch that
    was interrupted goes on when it is called again. A take that fails stops no other. DIR/summary.html
    shows what came out. Exit status: 0 all takes are converted, 1 some failed, 2 the shoot is unusable,
    130 interrupted.
    """
    shoot, takes, defaults = _plan(arguments)
    require_blender("writing motion.blend needs")
    output: Path = arguments.output
    try:
        output.mkdir(parents=True, exist_ok=True)
        if not os.access(output, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, "no permission")
    except OSError as error:
        raise InputError(f"{output}: cannot be written ({error.strerror}); name a folder that can") from error
    jobs = [Job(take, output / take.name, defaults, arguments.again, arguments.debug) for take in takes]
    outcomes = BatchOutcomes(shoot, output, jobs, console)
    pool = WorkerPool(jobs, worker_command_line(), outcomes, HEARTBEAT_TIMEOUT_S, arguments.debug)
    try:
        pool.run(arguments.jobs or usual_workers(MOST_JOBS))
        outcomes.finish()
    except KeyboardInterrupt:
        with suppress(KeyboardInterrupt):  # a second interrupt skips the summary
            outcomes.finish()
        counts = outcomes.counts
        ready = counts["converted"] + counts["unchanged"]
        failures = f", {counts['failed']} failed" if counts["failed"] else ""
        raise KeyboardInterrupt(
            f"interrupted; {ready} of {len(jobs)} takes are converted{failures}; the same command goes on"
        ) from None
    except ConversionError:
        outcomes.finish()
        raise
    console.finish(outcomes.to_dict(), outcomes.text())
    for outcome in outcomes.own_outcomes:
        record = current_record(outcome)
        console.warn([f"{outcome.take}: {warning}" for warning in (record.warnings if record else ())])
    failed = [outcome.take for outcome in outcomes.own_outcomes if outcome.error is not None]
    if failed and arguments.failed_takes == "fail":
        where = f"; {outcomes.files[-1]} says why" if outcomes.files else ""
        raise ConversionError(
            f"{len(failed)} of {len(jobs)} takes failed: {listed(failed, MOST_NAMED)}{where}"
        )
    if outcomes.write_errors:
        raise ConversionError(next(iter(outcomes.write_errors)))


def _plan(arguments: argparse.Namespace) -> tuple[Shoot, list[ShootTake], ConversionSettings]:
    found = re.fullmatch(
        r"(\d{1,7})/(\d{1,7})", ("1/1" if arguments.part is None else arguments.part).strip(), re.ASCII
    )
    part, parts = (int(number) for number in found.groups()) if found else (0, 0)
    if not 1 <= part <= parts <= 10**6:
        raise UsageError(f"--part is {arguments.part}; K/N is valid with K from 1 to N, as in 2/5")
    defaults = given_settings(arguments)
    if defaults.library is not None:
        from ..conversion.blender_files import (
            requested_libraries,  # a batch that asks for none needs no SciPy
        )

        requested_libraries(defaults.library)
    shoot = open_shoot(arguments.shoot, excluded=arguments.output)
    check_output(shoot, arguments.output)
    wanted = {name.rstrip("/") for name in arguments.take or ()}
    by_name = {take.name: take for take in shoot.takes}
    for name in arguments.take or ():
        if name.rstrip("/") not in by_name:
            close = get_close_matches(name[:200], list(by_name)[:1000], n=1)
            hint = f" (is {close[0]} meant?)" if close else ""
            raise UsageError(f"--take is {name}{hint}; {shoot.path} has {listed(by_name, MOST_NAMED)}")
    takes = [take for take in shoot.takes if not wanted or take.name in wanted]
    return shoot, takes[part - 1 :: parts], defaults
