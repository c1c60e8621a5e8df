"""`keymark animate`: from a clip and the performer's height to a motion, and on to a character."""

import argparse
from pathlib import Path

from ....core.errors import InputError
from ....core.take.description import ASSUMED, describe
from ....core.take.take_file import USUAL_HEIGHT_M, check_height
from ..command import Command, UsageError, argument
from ..console import Console
from ..conversion.character_result import FORMAT, check_exporters, export_formats
from ..conversion.convert_take import conversion_summary, conversion_text, convert_take
from ..options import (
    HEIGHT,
    PICTURES,
    bare_clip_fields,
    character_options,
    given_settings,
    output,
    setting_options,
)


def animate_command(arguments: argparse.Namespace, console: Console) -> None:
    """Goes from a clip and the performer's height all the way to a motion, and onto a character.

    Found are keypoints in the clip, the camera by them, the poses and the motion, which is put onto a
    character where one is named. OUT then holds what convert writes, and is a take itself, with the clip and
    a take.json that says what was found and what was assumed: open it in Blender to correct any step.
    """
    height_m = arguments.height
    if height_m is not None:
        check_height(height_m, HEIGHT)
    formats = export_formats(arguments.format)
    if formats and arguments.character is None:
        raise UsageError("--format is given without --character, of which it writes further files")
    said = bare_clip_fields(USUAL_HEIGHT_M if height_m is None else height_m)
    clip: Path = arguments.clip
    if clip.is_dir() and (clip / "take.json").is_file():
        raise InputError(f"{clip}: is a take, which keymark convert is for; name a clip")
    description = describe(clip, said, ASSUMED if height_m is None else HEIGHT)
    settings = given_settings(arguments).with_defaults(description.settings)
    if arguments.character is not None:
        check_exporters(formats)
    done = convert_take(description, arguments.output, console, settings, arguments.debug, formats)
    console.finish(conversion_summary(done), conversion_text(done))


ANIMATE = Command(
    arguments=(
        argument("clip", metavar="CLIP", type=Path, help="a video, or a folder of the images of one"),
        argument(
            HEIGHT,
            metavar="METERS",
            type=float,
            help=f"the performer's height, as in 1.78; {USUAL_HEIGHT_M:g} is assumed without it",
        ),
        *setting_options("keypoints"),
        *output("OUT", "folder for the result, new or old"),
        FORMAT,
        *character_options(),
        PICTURES,
    ),
    run=animate_command,
)
