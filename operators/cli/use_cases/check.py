"""`keymark check`: look through a shoot before it is converted."""

import argparse
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import cache, partial

from ....core.errors import ConversionError, describe_unexpected
from ....core.progress import Job, Progress, run
from ....core.shoot.check.outlier_takes import flag_outliers
from ....core.shoot.check.take_check import TakeCheck, check_take
from ....core.shoot.discovery.find_takes import open_shoot
from ....core.shoot.shoot import Shoot, ShootTake
from ....core.take.conversion_settings import ConversionSettings
from ....core.text import pluralize
from ..console import arguments_console
from ..conversion.character_checks import CharacterChecks
from ..library_search_path import requested_libraries
from ..line_wrapping import terminal_columns
from ..usage import UsageError
from ..wanted_keyframes import wanted_keyframes
from .check_text import check_summary, check_text

MOST_JOBS = 64
STAGE = "Looking at the takes"


def check_command(arguments: argparse.Namespace) -> None:
    """Check the takes that the command line names, and list the problems of each.

    Raises:
        InputError: The shoot is unusable.
        UsageError: `--jobs` is out of range, or options contradict each other.
        ConversionError: A take would not convert.
    """
    jobs = 1 if arguments.jobs is None else arguments.jobs
    if not 1 <= jobs <= MOST_JOBS:
        raise UsageError(f"--jobs is {jobs}; a number from 1 to {MOST_JOBS} is valid")
    _, library = wanted_keyframes(arguments.keyframes, arguments.library)
    defaults = ConversionSettings(
        library=library,
        method=arguments.method,
        keypoints=tuple(filter(None, arguments.keypoints or ())) or None,
        evidence=arguments.evidence,
    )
    with arguments_console(arguments) as console:
        shoot = open_shoot(arguments.shoot)
        characters = CharacterChecks(shoot, arguments.debug)
        checks = run(_check_takes(shoot, defaults, characters, jobs, arguments.debug), console.progress)
        console.finish(check_summary(checks), check_text(shoot, checks, terminal_columns()))
    failing = sum(not check.converts for check in checks)
    if failing:
        raise ConversionError(f"{failing} of {pluralize(len(checks), 'take')} would not convert")


def _check_takes(
    shoot: Shoot, defaults: ConversionSettings, characters: CharacterChecks, jobs: int, debug: bool
) -> Job[list[TakeCheck]]:
    """Check all takes, several at a time in threads: decoders release the interpreter lock."""
    find_libraries = cache(requested_libraries)
    tasks = [partial(_check_one, take, find_libraries, characters, defaults, debug) for take in shoot.takes]
    checks: dict[int, TakeCheck] = {}
    yield Progress(STAGE, 0.0)
    for index, check in _in_threads(tasks, jobs):
        checks[index] = check
        yield Progress(STAGE, len(checks) / len(tasks))
    return flag_outliers([checks[index] for index in sorted(checks)])


def _check_one(
    take: ShootTake,
    find_libraries: Callable[[str], object],
    characters: CharacterChecks,
    defaults: ConversionSettings,
    debug: bool,
) -> TakeCheck:
    """Check one take; an unexpected error becomes a problem of this take and does not stop the others."""
    try:
        return check_take(take, find_libraries, defaults, characters.check)
    except Exception as error:
        if debug:
            raise
        what = describe_unexpected(error)
        problem = f"{take.path}: the check failed unexpectedly ({what}); --debug shows where"
        return TakeCheck(take.name, (problem,), ())


def _in_threads(tasks: Sequence[Callable[[], TakeCheck]], jobs: int) -> Iterator[tuple[int, TakeCheck]]:
    if jobs == 1:
        for index, task in enumerate(tasks):
            yield index, task()
        return
    pool = ThreadPoolExecutor(jobs)
    try:
        running = {pool.submit(task): index for index, task in enumerate(tasks)}
        for done in as_completed(running):
            yield running[done], done.result()
    finally:
        pool.shutdown(cancel_futures=True)
