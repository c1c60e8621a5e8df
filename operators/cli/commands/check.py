"""`keymark check`: look through a shoot before it is converted."""

import argparse
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import cache
from pathlib import Path
from typing import Any

from ....core.errors import MOST_NAMED, ConversionError, describe_unexpected, pluralize
from ....core.files.fields import listed
from ....core.files.paths import absolute_path
from ....core.progress import Job, Progress, run
from ....core.shoot.check.take_check import FAILS, LOOK, READY, TakeCheck, check_take, flag_outliers
from ....core.shoot.discovery import Shoot, ShootTake, open_shoot
from ....core.take.conversion_settings import ConversionSettings
from ....core.take.evidence import KEYPOINTS
from ..console import Console, argument, command, terminal_columns, wrapped
from ..conversion.blender_files import requested_libraries
from ..conversion.character_result import CharacterChecks
from ..options import SHOOT_HELP, SHOOT_OPTIONS, given_settings, jobs_option

MOST_JOBS = 64
STAGE = "Looking at the takes"
STOPS = "!"
"""Before a problem that stops the conversion."""
FEWEST_IN_COMMON = 3
"""Number of takes from which on a sentence that they share is printed once."""
SEPARATOR = "  "
NARROWEST_NAME = 12


@command(
    argument("shoot SHOOT", f"{SHOOT_HELP}, or one take", type=Path),
    jobs_option(MOST_JOBS, "look at N takes at a time"),
    *SHOOT_OPTIONS,
)
def check_command(arguments: argparse.Namespace, console: Console) -> None:
    """Reads everything a batch would read, samples frames of every clip, and writes nothing.

    It says for each take whether it would convert, what it would be held against, how well its markers and
    keypoints are seen, and what is likely to go wrong.
    """
    defaults = given_settings(arguments)
    shoot = open_shoot(arguments.shoot)
    characters = CharacterChecks(shoot, arguments.debug)
    job = _check_takes(shoot, defaults, characters, arguments.jobs or 1, arguments.debug)
    checks = run(job, console.progress)
    console.finish(check_summary(checks), check_text(shoot, checks, terminal_columns()))
    failing = sum(check.status == FAILS for check in checks)
    if failing:
        raise ConversionError(f"{failing} of {pluralize(len(checks), 'take')} would not convert")


def _check_takes(
    shoot: Shoot, defaults: ConversionSettings, characters: CharacterChecks, jobs: int, debug: bool
) -> Job[list[TakeCheck]]:
    """Check all takes, several at a time in threads: decoders release the interpreter lock."""
    find_libraries = cache(requested_libraries)

    def checked(take: ShootTake) -> TakeCheck:
        try:
            return check_take(take, find_libraries, defaults, characters.check)
        except Exception as error:  # it is a problem of this take and does not stop the others
            if debug:
                raise
            what = describe_unexpected(error)
            problem = f"{take.path}: the check failed unexpectedly ({what}); --debug shows where"
            return TakeCheck(take.name, (problem,), ())

    yield Progress(STAGE, 0.0)
    pool = ThreadPoolExecutor(jobs)
    try:
        running = [pool.submit(checked, take) for take in shoot.takes]
        for done, task in enumerate(as_completed(running), 1):
            task.result()
            yield Progress(STAGE, done / len(running))
    finally:
        pool.shutdown(cancel_futures=True)
    return flag_outliers([task.result() for task in running])


def check_summary(checks: Sequence[TakeCheck]) -> dict[str, Any]:
    """The checks as an object for `--json`."""
    counts = Counter(check.status for check in checks)
    return {
        "takes": [_take(check) for check in checks],
        "counts": {word: counts[word] for word in (READY, LOOK, FAILS)},
    }


def check_text(shoot: Shoot, checks: Sequence[TakeCheck], columns: int | None = None) -> str:
    """The checks as text for people; what several takes share, as an error in a shoot, is said once."""
    shared: dict[str, list[str]] = {}
    for check in checks:
        for sentence in _marked(check):
            shared.setdefault(sentence, []).append(check.name)
    shared = {sentence: takes for sentence, takes in shared.items() if len(takes) >= FEWEST_IN_COMMON}
    lines = _table(shoot, checks, shared, columns)
    together: dict[tuple[str, ...], list[str]] = {}
    for sentence, takes in shared.items():
        together.setdefault(tuple(takes), []).append(sentence)
    for those, sentences in together.items():
        where = f"{len(those)} takes ({listed(those, MOST_NAMED)})"
        lines += ["", f"In {'all takes' if len(those) == len(checks) else where}:"]
        lines += [line for sentence in sentences for line in wrapped(sentence, 2, columns)]
    held: dict[tuple[str, ...], list[str]] = {}
    for check in checks:
        if check.evidence and check.status != FAILS:
            held.setdefault(check.evidence, []).append(check.name)
    lines.append("")
    for kinds, names in held.items():
        *most, last = (kind.replace("_", " ") for kind in kinds)
        words = f"Held against {', '.join(most)} and {last}" if most else f"Held against {last}"
        which = f": {pluralize(len(names), 'take')} ({listed(names, MOST_NAMED)})" if len(held) > 1 else ""
        lines += wrapped(f"{words}{which}.", 0, columns)
    counts = Counter(check.status for check in checks)
    why = f" ({STOPS} says why)" if counts[FAILS] else ""
    last = f"{counts[READY]} ready, {counts[LOOK]} to look at, {counts[FAILS]} that would not convert{why}."
    return "\n".join([*lines, *wrapped(f"{pluralize(len(checks), 'take')}: {last}", 0, columns)])


def _table(
    shoot: Shoot, checks: Sequence[TakeCheck], shared: Iterable[str], columns: int | None
) -> list[str]:
    folder = absolute_path(shoot.folder).name
    names = [folder if check.name == "." else check.name for check in checks]
    markers = list(dict.fromkeys(readout.name for check in checks for readout in check.markers))
    keypoints = (KEYPOINTS,) if any(check.keypoints for check in checks) else ()
    titles = ("", "take", "frames", "size", "rate", "keyframes", *keypoints, *markers)
    rows = [
        (check.status, name, *_cells(check, keypoints, markers))
        for check, name in zip(checks, names, strict=True)
    ]
    widths = [max(map(len, column)) for column in zip(titles, *rows, strict=True)]
    if columns is not None:
        figures = sum(width + len(SEPARATOR) for width in (widths[0], *widths[2:]))
        widths[1] = max(min(widths[1], columns - figures), NARROWEST_NAME)
    said_once = set(shared)
    lines = _aligned(titles, widths)
    for check, row in zip(checks, rows, strict=True):
        lines += _aligned(row, widths)
        own = [sentence for sentence in _marked(check) if sentence not in said_once]
        lines += [line for sentence in own for line in wrapped(sentence, widths[0] + 2, columns)]
    return lines


def _marked(check: TakeCheck) -> tuple[str, ...]:
    stopping = [f"{STOPS} {sentence}" for sentence in check.problems]
    return (*stopping, *(f"- {sentence}" for sentence in check.warnings))


def _cells(check: TakeCheck, keypoints: Sequence[str], markers: Sequence[str]) -> tuple[str, ...]:
    size = "-" if check.size is None else f"{check.size[0]}x{check.size[1]}"
    rate = "-" if check.fps is None else f"{check.fps:.4g}"
    frames = "-" if check.frames is None else str(check.frames)
    posed = str(check.keyframes) if check.library is None else f"{check.keyframes}+{check.library}"
    seen = {readout.name: f"{100 * readout.found // readout.sampled}%" for readout in check.markers}
    # How often the performer is seen, and how far from posed joints, of the best source of keypoints.
    best = max(check.keypoints, key=lambda readout: readout.seen_frames, default=None)
    if best is not None:
        apart = "" if best.error_px is None else f" {best.error_px:.0f}px"
        seen[KEYPOINTS] = f"{100.0 * best.seen_frames:.0f}%{apart}"
    return (frames, size, rate, posed, *(seen.get(name, "-") for name in (*keypoints, *markers)))


def _aligned(cells: Sequence[str], widths: Sequence[int]) -> list[str]:
    """A row with words to the left and numbers to the right; two lines where the name is too long."""
    first, name, *rest = cells
    numbers = [f"{cell:>{width}}" for cell, width in zip(rest, widths[2:], strict=True)]
    words = f"{first:{widths[0]}}"
    if len(name) > widths[1]:
        whole = SEPARATOR.join([words, name])
        return [whole, SEPARATOR.join([" " * widths[0], " " * widths[1], *numbers]).rstrip()]
    return [SEPARATOR.join([words, f"{name:{widths[1]}}", *numbers]).rstrip()]


def _take(check: TakeCheck) -> dict[str, Any]:
    return {
        "take": check.name,
        "status": check.status,
        "problems": list(check.problems),
        "warnings": list(check.warnings),
        "size": None if check.size is None else list(check.size),
        "fps": check.fps,
        "frames": check.frames,
        "keyframes": check.keyframes,
        "library": check.library,
        "evidence": list(check.evidence),
        "keypoints": [
            vars(readout)
            | {name: round(getattr(readout, name), 4) for name in ("seen_frames", "seen_points")}
            | {"error_px": None if readout.error_px is None else round(readout.error_px, 2)}
            for readout in check.keypoints
        ],
        "markers": {
            readout.name: {
                "found": readout.found,
                "sampled": readout.sampled,
                "area_px": round(readout.area_px, 1),
                "distinctness": round(readout.distinctness, 3),
            }
            for readout in check.markers
        },
    }
