"""`keymark animate`: from a clip and the performer's height to a motion, and on to a character."""

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

from ....core.errors import InputError
from ....core.files.paths import absolute_path
from ....core.prior.texts import EVERY_LIBRARY
from ....core.session.result import Conversion
from ....core.session.see import PictureTurnedError, require_upright
from ....core.session.session import Keep, keep_nothing
from ....core.take.description import ASSUMED, describe
from ....core.take.take_file import USUAL_HEIGHT_M, check_height
from ....core.video.header import TURNS, can_turn, write_turned
from ..console import Console, UsageError, argument, command
from ..conversion.character_result import FORMAT, check_exporters, export_formats
from ..conversion.convert_take import conversion_summary, conversion_text, convert_take
from ..options import HANDS, HEIGHT, PICTURES, character_options, given_settings, output, setting_options


@command(
    argument("clip CLIP", "a video, or a folder of the images of one", type=Path),
    argument(
        f"{HEIGHT} METERS",
        f"the performer's height, as in 1.78; {USUAL_HEIGHT_M:g} is assumed without it",
        type=float,
    ),
    *setting_options("keypoints", "network", "shot", "performer"),
    argument(
        "--rotate",
        "turn the picture clockwise (MP4 and QuickTime); by default so that people are upright",
        type=int,
        choices=TURNS,
    ),
    *output("OUT", "folder for the result, new or old"),
    FORMAT,
    *character_options(),
    PICTURES,
    HANDS,
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
    fields = {"actor": {"height_m": height_m or USUAL_HEIGHT_M}, "keyframes": EVERY_LIBRARY}
    clip: Path = arguments.clip
    if clip.is_dir() and (clip / "take.json").is_file():
        raise InputError(f"{clip}: is a take, which keymark convert is for; name a clip")
    if arguments.character is not None:
        check_exporters(formats)

    def convert(footage: Path, notes: tuple[str, ...] = (), keep: Keep = keep_nothing) -> Conversion:
        description = describe(footage, fields, ASSUMED if height_m is None else HEIGHT)
        settings = given_settings(arguments).with_defaults(description.settings)
        debug: bool = arguments.debug
        return convert_take(description, arguments.output, console, settings, debug, formats, keep, notes)

    turn_deg: int | None = arguments.rotate
    if turn_deg and arguments.keypoints:
        raise UsageError("--rotate turns the picture and not the keypoints of --keypoints; give one of them")
    how = "as --rotate says"
    if turn_deg is None:
        how = "in which people are upright; --rotate 0 leaves it as it is"
        try:
            done = convert(clip, keep=require_upright if can_turn(clip) else keep_nothing)
        except PictureTurnedError as turned:
            turn_deg = turned.turn_deg
    elif turn_deg == 0:
        done = convert(clip)
    if turn_deg:
        note = f"the picture is turned by {turn_deg} degrees clockwise, {how}"
        parents = absolute_path(arguments.output).parents  # on the disk of OUT, whose clip it becomes
        with TemporaryDirectory(dir=next(one for one in parents if one.is_dir())) as folder:
            write_turned(clip, turn_deg, Path(folder) / clip.name)
            done = convert(Path(folder) / clip.name, (note,))
    console.finish(conversion_summary(done), conversion_text(done))
    console.warn(done.warnings)
