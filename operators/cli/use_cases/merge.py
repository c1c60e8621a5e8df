"""`keymark merge`: the motions of a batch as one asset library."""

import argparse
import os
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import ConversionError, InputError
from ....core.files.digest import content_digest
from ....core.files.fields import listed
from ....core.progress import Progress
from ....core.shoot.outcomes.failures import Failure, read_failures
from ....core.shoot.outcomes.results import Result, Results, find_results
from ....core.take.motion import Motion
from ....core.take.motion_file import read_motion
from ....core.take.shoot_file import whole_way
from ..blender_silence import blender_silence
from ..console import Console, arguments_console
from ..conversion.convert_take import MOTION
from ..line_wrapping import broken, terminal_columns
from ..require_blender import require_blender

if TYPE_CHECKING:
    from ...bridge.assets.motions import MotionAsset

ENDING = ".blend"
LONGEST_NAME = 63
"""Bytes of a data-block's name in Blender 4.5; later ones hold more."""
LONGEST_TAG = 63
LONGEST_DESCRIPTION = 1000
NAMED = 5
"""So many takes are named in the last line."""
STAGE = "Gathering the motions"


def merge_command(arguments: argparse.Namespace) -> None:
    """Gather all results below a folder in one .blend of Action assets.

    Raises:
        InputError: There are no results, or the .blend cannot lie where it is asked for.
        ConversionError: Some results are damaged, or takes have failed; all others have been gathered.
    """
    require_blender("an asset library needs")
    with arguments_console(arguments) as console:
        console.stage("Looking for results")
        found = find_results(arguments.results)
        _check_place(arguments.output, found)
        name = arguments.name or whole_way(arguments.results).name
        gathering = Gathering(found, read_failures(arguments.results), name, console)
        console.stage(STAGE)
        with blender_silence(arguments.debug):
            from ...bridge.assets.catalogs import NAME
            from ...bridge.assets.motions import write_motion_library

            write_motion_library(arguments.output, gathering.assets())
        files = [str(arguments.output), str(arguments.output.parent / NAME)]
        wrong = gathering.wrong
        result = {"motions": gathering.count, "wrong": wrong, "files": files}
        console.finish(result, _text(gathering.count, files, wrong))
    if wrong:
        raise ConversionError(
            f"{arguments.output} lacks takes or holds earlier results of them: {listed(sorted(wrong), NAMED)}"
        )


class Gathering:
    """Results on their way into a library; those that turn out to be damaged are remembered."""

    def __init__(self, found: Results, failures: Sequence[Failure], shoot: str, console: Console) -> None:
        self.wrong = dict(found.damaged)
        """Of each take that the library lacks, or has of an earlier input, why, in a sentence."""
        self.wrong |= {failure.take: failure.error for failure in failures}
        self.count = 0
        """How many are in the library."""
        self._found, self._shoot, self._console = found, shoot, console

    def assets(self) -> "Iterator[MotionAsset]":
        """Every motion that is sound, one at a time: together they may not fit into memory.

        Raises:
            ConversionError: There is none.
        """
        from ...bridge.assets.motions import MotionAsset

        names: set[str] = set()
        for index, result in enumerate(self._found.sound):
            self._console.progress(Progress(STAGE, index / len(self._found.sound)))
            try:
                motion = _motion(result)
            except InputError as error:
                self.wrong[result.name] = str(error)
                continue
            name = asset_name(result.name, names)
            names.add(name)
            self.count += 1
            catalog = "/".join(catalog_part(part) for part in (self._shoot, *result.name.split("/")[:-1]))
            yield MotionAsset(name, catalog, description(result), tags(result), motion)
        if not names:
            raise ConversionError(f"none of the results can be used: {_listed(self.wrong)}")


def asset_name(take: str, taken: Collection[str]) -> str:
    """A name for a take's Action that no other has and Blender does not cut.

    The end of a long one stays, for there takes differ.
    """
    whole = " ".join(take.split("/"))
    for number in range(1, len(taken) + 2):
        ending = "" if number == 1 else f" {number}"
        name = whole
        while len(f"{name}{ending}".encode()) > LONGEST_NAME:
            name = f"…{name.lstrip('…')[1:]}"
        if f"{name}{ending}" not in taken:
            break
    return f"{name}{ending}"


def catalog_part(name: str) -> str:
    """A folder's name as a catalog may be called: slashes and colons mean something else there."""
    return "".join("-" if letter in ":/\\" or not letter.isprintable() else letter for letter in name)


def description(result: Result) -> str:
    """What an asset browser says of a motion, with what a person should know of it."""
    record = result.record
    last = record.frame_start + record.frames - 1
    sentences = [
        f"Take {result.name}: {record.frames} frames at {record.fps:g} per second, {record.frame_start} to "
        f"{last}"
    ]
    if record.confidence is not None:
        weakest = "" if record.weakest is None else f", {record.weakest:.0%} where it is weakest"
        sentences.append(f"Confidence {record.confidence:.0%}{weakest}")
    text = " ".join(f"{sentence.rstrip('.')}." for sentence in (*sentences, *record.notes))
    return text if len(text) <= LONGEST_DESCRIPTION else f"{text[: LONGEST_DESCRIPTION - 3]}..."


def tags(result: Result) -> tuple[str, ...]:
    """By what an asset browser finds a motion."""
    library = () if result.record.library is None else (result.record.library,)
    return tuple(
        tag.encode()[:LONGEST_TAG].decode(errors="ignore")
        for tag in ("keymark", result.record.method, *library)
    )


def _motion(result: Result) -> Motion:
    """The motion of a result, as it was when the record was written.

    Raises:
        InputError: It is missing, unusable, or another.
    """
    file = result.folder / MOTION
    if content_digest(file) != result.record.files.get(MOTION):
        raise InputError(f"{file}: is not the file that the conversion wrote")
    return read_motion(file)


def _check_place(output: Path, found: Results) -> None:
    if output.suffix.lower() != ENDING:
        raise InputError(f"{output}: is no name of a .blend; it must end in {ENDING}, as in library.blend")
    if output.is_dir():
        raise InputError(f"{output}: is a folder; it must be a file to write, as in library.blend")
    place = Path(os.path.realpath(output))
    for result in found.sound:
        if Path(os.path.realpath(result.folder)) in place.parents:
            raise InputError(
                f"{output}: lies in the results of the take {result.name}; name a file outside of them"
            )


def _text(count: int, files: Sequence[str], wrong: dict[str, str]) -> str:
    lines = ["1 motion:" if count == 1 else f"{count} motions:", *(f"  {file}" for file in files)]
    if wrong:
        lines.append("Takes that are not in it, or as they were before:")
    for name in sorted(wrong):
        lines += broken(f"{name}: {wrong[name]}", 2, terminal_columns())
    return "\n".join(lines)


def _listed(wrong: dict[str, str]) -> str:
    """The reasons, the first few of many."""
    reasons = [wrong[name] for name in sorted(wrong)]
    more = [f"{len(reasons) - NAMED} more"] if len(reasons) > NAMED else []
    return "; ".join([*reasons[:NAMED], *more])
