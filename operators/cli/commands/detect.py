"""`keymark detect`: find points of the body in clips."""

import argparse
import os
from contextlib import closing, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ....core.detect.closer_look import CloserLook
from ....core.detect.families.table import open_network
from ....core.detect.keypoint_file import write_keypoints
from ....core.detect.keypoints import People
from ....core.detect.pose_network import PoseNetwork
from ....core.detect.pose_tracking import find_people
from ....core.errors import ConversionError, InputError, KeymarkError, describe_unexpected, pluralize
from ....core.files.fields import listed
from ....core.files.kinds import read_field
from ....core.files.paths import VIDEOS
from ....core.progress import run, stretch
from ....core.shoot.discovery import ShootTake, find_takes, open_shoot
from ....core.take.description import KEYPOINT_FILE, TAKE_FILE, find_shoot_files, sidecar_file
from ....core.take.read_footage import open_footage
from ....core.take.take_file import FRAME_RATE, FRAME_START
from ....core.video.image_sequence import find_images
from ..console import Console, UsageError, argument, command, refuse_existing
from ..options import HANDS, output, setting_options

MOST_NAMED = 5


@dataclass(frozen=True)
class Footage:
    """A clip, and where its keypoints go."""

    name: str
    clip: Path
    fps: float | None
    frame_start: int
    output: Path


@command(
    argument(
        "target CLIP|TAKE|SHOOT",
        "a clip, a take, a folder of takes, or a list of them (JSON Lines, .jsonl)",
        type=Path,
    ),
    *setting_options("network"),
    *output(
        "FILE",
        "keypoint file of a single clip or take; by default keypoints.json in the take, or "
        "NAME.keypoints.json beside the clip",
        required=False,
        replace="replace keypoint files that are there",
    ),
    HANDS,
)
def detect_command(arguments: argparse.Namespace, console: Console) -> None:
    """Finds 33 points of everybody in every frame, with a guess of their depth.

    It does so by the network that comes with Keymark, and keeps them beside the clip, where converting uses
    them.
    """
    own = None if arguments.network is None else open_network(arguments.network)
    networks = PoseNetwork(), CloserLook(own, arguments.hands is not False)
    one = _single(arguments.target)
    if one is not None:
        footage = one if arguments.output is None else replace(one, output=arguments.output)
        refuse_existing(footage.output, arguments.replace)
        people = _detect(footage, networks, console, 0.0, 1.0)
        summary = {"keypoints": str(footage.output), **_summary(people)}
        console.finish(summary, f"{_found_text(people)}: {footage.output}")
        return
    if arguments.output is not None:
        raise UsageError(
            f"--output is one file, and {arguments.target} may hold several takes; their keypoints go "
            "beside them"
        )
    target = arguments.target
    shoot = find_takes(target, undescribed=True) if target.is_dir() else open_shoot(target)
    results: list[dict[str, Any]] = []
    share = 1.0 / len(shoot.takes)
    for index, take in enumerate(shoot.takes):  # one that fails does not stop the others
        result: dict[str, Any] = {"take": take.name, "keypoints": None, "detected": None, "error": None}
        try:
            footage = _footage(take)
            text = f"{footage.output} is there already"
            if arguments.replace or not os.path.lexists(footage.output):
                people = _detect(footage, networks, console, index * share, (index + 1) * share)
                result["detected"], text = _summary(people), f"{_found_text(people)}, in {footage.output}"
            result["keypoints"] = str(footage.output)
        except KeymarkError as error:
            text = result["error"] = str(error)
        except Exception as error:
            if arguments.debug:
                raise
            text = f"failed unexpectedly ({describe_unexpected(error)}); --debug shows where"
            result["error"] = text
        results.append(result)
        console.take_line(f"{take.name}: {text}", result["error"] and f"{take.name}: {text}")
    failed = [result["take"] for result in results if result["error"] is not None]
    found = sum(result["detected"] is not None for result in results)
    there = len(results) - len(failed) - found
    counts = {"detected": found, "there_already": there, "failed": len(failed)}
    takes = pluralize(len(results), "take")
    text = f"{takes}: {found} detected, {there} there already, {len(failed)} failed"
    console.finish({**counts, "takes": results}, text)
    if failed:
        raise ConversionError(f"{len(failed)} of {len(results)} takes failed: {listed(failed, MOST_NAMED)}")


def _found_text(people: People) -> str:
    who = "a person" if people.most_people == 1 else f"up to {people.most_people} people"
    notes = "".join(f"; {note}" for note in people.notes)
    return f"{who} in {people.seen_frames} of {pluralize(len(people.frames), 'frame')}{notes}"


def _summary(people: People) -> dict[str, Any]:
    return {
        "detector": people.source,
        **({} if people.second is None else {"second": people.second.to_json()}),
        "frames": len(people.frames),
        "seen_frames": people.seen_frames,
        "most_people": people.most_people,
        "points": list(people.names),
    }


def _detect(
    footage: Footage, networks: tuple[PoseNetwork, CloserLook], console: Console, first: float, last: float
) -> People:
    if not os.access(footage.output.parent, os.W_OK | os.X_OK):
        raise InputError(f"{footage.output}: cannot be written; its folder must exist and be writable")
    clip = open_footage(footage.clip, footage.fps)
    job = find_people(clip, *networks)
    with closing(stretch(job, first, last)) as stretched:
        people = run(stretched, console.progress)
    write_keypoints(footage.output, people, footage.frame_start, clip.fps)
    return people


def _single(path: Path) -> Footage | None:
    """The one clip or take that a path names; None for a shoot."""
    if path.name in ("", ".."):  # the file beside it is named after the folder
        path = Path(os.path.abspath(path))
    is_take = path.is_dir() and (path / TAKE_FILE).is_file()
    is_clip = path.suffix.lower() in VIDEOS and path.is_file()
    with suppress(InputError, OSError):
        is_clip = is_clip or find_images(path) is not None
    return _footage(ShootTake(path.name, path)) if is_take or is_clip else None


def _footage(take: ShootTake) -> Footage:
    path = take.path
    described = (path / TAKE_FILE, sidecar_file(path, TAKE_FILE))
    if not take.overrides and not any(map(os.path.isfile, described)) and not find_shoot_files(path.parent):
        return Footage(take.name, path, None, 1, sidecar_file(path, KEYPOINT_FILE))
    description = take.describe()
    fields, named = description.fields, description.settings.keypoints or ()
    return Footage(
        name=take.name,
        clip=description.clip,
        fps=read_field(fields, "fps", FRAME_RATE, None),
        frame_start=read_field(fields, "frame_start", FRAME_START, 1),
        output=named[0] if len(named) == 1 else description.file_called(Path(KEYPOINT_FILE)),
    )
