"""`keymark merge`: gather the motions of a batch in one asset library."""

import argparse
import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ....core.errors import ConversionError, InputError, pluralize
from ....core.files.digest import content_digest
from ....core.files.fields import listed
from ....core.files.paths import absolute_path
from ....core.progress import Progress
from ....core.retarget.retarget_record import RECORD_FILE as RETARGET
from ....core.retarget.retarget_record import read_retarget_record
from ....core.shoot.outcomes import Result, find_results, read_failures
from ....core.take.conversion_record import CHARACTER_BLEND, MOTION
from ....core.take.motion import read_motion
from ..blender_silence import blender_silence
from ..console import Console, argument, command, require_blender, terminal_columns, wrapped
from ..options import output

if TYPE_CHECKING:
    from ...bridge.assets import MotionAsset

SUFFIX = ".blend"
LONGEST_NAME_BYTES = 63
"""Of a data-block's name in Blender 4.5; later versions allow more."""
LONGEST_TAG_BYTES = 63
LONGEST_DESCRIPTION = 1000
MOST_NAMED = 5
STAGE = "Gathering the motions"


@command(
    argument("results DIR", "folder of results, as batch writes it", type=Path),
    *output("FILE", "the .blend to write, new or old"),
    argument("--name NAME", "what the shoot is called; by default DIR's name"),
)
def merge_command(arguments: argparse.Namespace, console: Console) -> None:
    """Gathers the motions found below DIR in one .blend to add to Blender's asset libraries.

    Catalogs are by shoot and folder: each motion is an Action, which any actor of Keymark's can be given, and
    an actor to drag into a scene. Exit status: 0 all takes are in it, 1 some have failed or are damaged and
    the others are in it, 2 there are none.
    """
    require_blender("an asset library needs")
    console.stage("Looking for results")
    sound, damaged = find_results(arguments.results)
    _check_output(arguments.output, sound)
    damaged |= {failure.take: failure.error for failure in read_failures(arguments.results)}
    name = arguments.name or absolute_path(arguments.results).name
    gathering = MotionGathering(sound, damaged, name, console)
    console.stage(STAGE)
    with blender_silence(arguments.debug):
        from ...bridge.asset_catalogs import NAME
        from ...bridge.assets import write_motion_library

        write_motion_library(arguments.output, gathering.assets())
    files = [str(arguments.output), str(arguments.output.parent / NAME)]
    counts, problems = gathering.counts, gathering.problems
    heading = pluralize(counts["motions"], "motion")
    if counts["character_actions"]:
        heading += f" and {pluralize(counts['character_actions'], 'Action')} of characters"
    lines = [f"{heading}:", *(f"  {file}" for file in files)]
    lines += ["Takes that are not in it, or as they were before:"] * bool(problems)
    for take in sorted(problems):
        lines += wrapped(f"{take}: {problems[take]}", 2, terminal_columns())
    console.finish({**counts, "wrong": problems, "files": files}, "\n".join(lines))
    if problems:
        named = listed(sorted(problems), MOST_NAMED)
        raise ConversionError(f"{arguments.output} lacks takes or holds earlier results of them: {named}")


class MotionGathering:
    """Yields the assets of sound results one by one, and collects the problems of the others."""

    def __init__(
        self, sound: Sequence[Result], problems: dict[str, str], shoot: str, console: Console
    ) -> None:
        self.problems = problems
        """The problem of each take that the library lacks or has of an earlier input, in a sentence."""
        self.counts = {"motions": 0, "character_actions": 0}
        self._sound, self._shoot, self._console = sound, shoot, console

    def assets(self) -> "Iterator[MotionAsset]":
        """Yield the asset of every sound motion, one at a time: together they may not fit into memory."""
        names: set[str] = set()
        for index, result in enumerate(self._sound):
            self._console.progress(Progress(STAGE, index / len(self._sound)))
            try:
                yield from self._assets_of(result, names)
            except InputError as error:
                self.problems[result.name] = str(error)
        if not names:
            reasons = [self.problems[name] for name in sorted(self.problems)]
            more = [f"{len(reasons) - MOST_NAMED} more"] * (len(reasons) > MOST_NAMED)
            first = "; ".join([*reasons[:MOST_NAMED], *more])
            raise ConversionError(f"none of the results can be used: {first}")

    def _assets_of(self, result: Result, names: set[str]) -> "Iterator[MotionAsset]":
        """The assets of a motion and, if it has one, of its character; InputError where one is unusable."""
        from ...bridge.assets import MotionAsset, load_character_action

        record, about = result.record, description(result)
        motion = read_motion(_as_written(result, MOTION))
        # Slashes and colons have a meaning in a catalog's path.
        parts = (re.sub(r"[:/\\]", "-", part) for part in (self._shoot, *result.name.split("/")[:-1]))
        catalog = "/".join("".join(one if one.isprintable() else "-" for one in part) for part in parts)
        marks = _short_tags("keymark", record.method, record.library)
        self.counts["motions"] += 1
        yield MotionAsset(asset_name(result.name, names), catalog, about, marks, motion)
        if CHARACTER_BLEND not in record.files:
            return
        made = read_retarget_record(_as_written(result, RETARGET).parent)
        action = load_character_action(
            result.folder / CHARACTER_BLEND, made.action, record.files[CHARACTER_BLEND]
        )
        name = asset_name(f"{result.name} {made.character.object}", names)
        self.counts["character_actions"] += 1
        about = shortened(f"For the character '{made.character.object}' of {made.character.file}. {about}")
        marks += _short_tags(made.character.object, made.map.preset)
        yield MotionAsset(name, catalog, about, marks, motion, action)


def _as_written(result: Result, name: str) -> Path:
    file = result.folder / name
    if content_digest(file) != result.record.files.get(name):
        raise InputError(f"{file}: is not the file that the conversion wrote")
    return file


def asset_name(take: str, names: set[str]) -> str:
    """A name for a take's Action, added to the names: a number makes it unique, and its end fits Blender."""
    for number in range(1, len(names) + 2):
        suffix = "" if number == 1 else f" {number}"
        name = " ".join(take.split("/"))
        while len(f"{name}{suffix}".encode()) > LONGEST_NAME_BYTES:
            name = f"…{name.lstrip('…')[1:]}"
        if f"{name}{suffix}" not in names:
            break
    names.add(f"{name}{suffix}")
    return f"{name}{suffix}"


def description(result: Result) -> str:
    """The description of a motion in an asset browser: frames, confidence and notes."""
    record = result.record
    last = record.frame_start + record.frames - 1
    sentences = [
        f"Take {result.name}: {record.frames} frames at {record.fps:g} per second, {record.frame_start} to "
        f"{last}"
    ]
    if record.evidence is not None:
        sentences.append(f"Held against {record.evidence.words}")
    if record.confidence is not None:
        weakest = "" if record.weakest is None else f", {record.weakest:.0%} where it is weakest"
        sentences.append(f"Confidence {record.confidence:.0%}{weakest}")
    return shortened(" ".join(f"{sentence.rstrip('.')}." for sentence in (*sentences, *record.notes)))


def shortened(text: str) -> str:
    """A description that an asset browser has room for."""
    return text if len(text) <= LONGEST_DESCRIPTION else f"{text[: LONGEST_DESCRIPTION - 3]}..."


def _short_tags(*words: str | None) -> tuple[str, ...]:
    return tuple(
        word.encode()[:LONGEST_TAG_BYTES].decode(errors="ignore") for word in words if word is not None
    )


def _check_output(output: Path, sound: Sequence[Result]) -> None:
    if output.suffix.lower() != SUFFIX:
        raise InputError(f"{output}: is no name of a .blend; it must end in {SUFFIX}, as in library.blend")
    if output.is_dir():
        raise InputError(f"{output}: is a folder; it must be a file to write, as in library.blend")
    real = Path(os.path.realpath(output))
    for result in sound:
        if Path(os.path.realpath(result.folder)) in real.parents:
            raise InputError(
                f"{output}: lies in the results of the take {result.name}; name a file outside of them"
            )
