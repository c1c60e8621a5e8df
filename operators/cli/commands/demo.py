"""`keymark demo`: the demonstration takes converted with and without markers, animated, and scored."""

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ....core.errors import ConversionError
from ....core.estimate.reconstruct import reconstruct
from ....core.prior.texts import EVERY_LIBRARY
from ....core.progress import run
from ....core.review.score import Score, read_truth, score_points
from ....core.session.session import Posed
from ....core.take.conversion_record import BLEND, CHARACTER_BLEND, REPORT
from ....core.take.conversion_settings import CharacterSettings, ConversionSettings
from ....core.take.description import describe
from ....core.take.evidence import CONTOURS, DEPTH_HINTS, KEYPOINTS, MARKERS
from ....core.take.examples import AEROBIC, GREETING, POSED_BY_HAND, example_folder
from ....core.take.motion import Motion
from ....core.take.take import Take
from ..console import Console, argument, command, require_blender
from ..conversion.convert_take import conversion_summary, convert_take
from ..options import HEIGHT

MARKED = (MARKERS, CONTOURS)
UNMARKED = (KEYPOINTS, DEPTH_HINTS, CONTOURS)
UNMARKED_FOLDER = "without_markers"
ANIMATED_FOLDER = "animated"
GREETING_M = 1.71
"""Height of the performer of the clip in plain clothes."""
CHARACTER_FILE = "human.blend"
COLUMNS = {"mpjpe": "all", "rooted": "about hips", "depth": "in depth", "image": "across", "jitter": "jitter"}


@command(
    argument(
        "--output -o DIR",
        "folder for the result (default: %(default)s)",
        type=Path,
        default=Path("keymark_demo"),
    )
)
def demo_command(arguments: argparse.Namespace, console: Console) -> None:
    """Converts the take that comes with Keymark, and prints how far each method is from the truth."""
    demo = example_folder(AEROBIC)
    require_blender("the demonstration needs")
    with tempfile.TemporaryDirectory() as folder:
        console.announce("The demonstration, twice four seconds of video, takes five steps, about a minute.")
        console.announce("Step 1 of 5: a character is generated, Rigify's basic human.")
        console.stage("Generating a character")
        character, missing = None, ""
        try:
            write_demo_character(Path(folder) / CHARACTER_FILE)
            character = CharacterSettings(file=Path(folder) / CHARACTER_FILE)
        except ConversionError as error:
            missing = f"Without a character: {error}"
        settings = ConversionSettings(demo / POSED_BY_HAND, evidence=MARKED, character=character)
        console.announce(
            "Step 2 of 5: the take is converted, by its markers and contours, and put on the character."
        )
        done = convert_take(describe(demo), arguments.output, console, settings, arguments.debug)
        console.announce("Step 3 of 5: the same by the paper's filter, to compare.")
        console.stage("Trying the paper's filter")
        filtered = run(reconstruct(done.session[Posed].seen, "ekf"))
        console.announce("Step 4 of 5: the take is converted without its markers, by keypoints and contours.")
        output: Path = arguments.output
        unmarked_settings = ConversionSettings(demo / POSED_BY_HAND, evidence=UNMARKED)
        unmarked = convert_take(
            describe(demo), output / UNMARKED_FOLDER, console, unmarked_settings, arguments.debug
        )
        bare = Path(folder) / "greeting.mp4"
        shutil.copyfile(example_folder(GREETING) / "clip.mp4", bare)
        console.announce(
            "Step 5 of 5: a clip in plain clothes is animated from nothing but the performer's height."
        )
        fields = {"actor": {"height_m": GREETING_M}, "keyframes": EVERY_LIBRARY}
        description = describe(bare, fields, HEIGHT)
        own = description.settings.with_defaults(ConversionSettings(character=character))
        animated = convert_take(description, output / ANIMATED_FOLDER, console, own, arguments.debug)
        scores = {
            "interpolation": _score(done.take, done.reconstruction.interpolation),
            "ekf": _score(done.take, filtered.motion),
            "map": _score(done.take, done.reconstruction.motion),
            UNMARKED_FOLDER: _score(done.take, unmarked.reconstruction.motion),
        }
        best = BLEND if character is None else CHARACTER_BLEND
        result = {
            **conversion_summary(done),
            "scores_mm": {name: score.to_dict() for name, score in scores.items()},
        }
        lines = [
            f"Error against the true motion of {scores['map'].frames} frames, posed in "
            f"{scores['map'].keyframes} of them, in millimeters:",
            " " * 17 + "".join(f"{title:>12}" for title in COLUMNS.values()),
            *(
                f"  {name.replace('_', ' '):15}" + "".join(f"{values[one]:12.1f}" for one in COLUMNS)
                for name, values in result["scores_mm"].items()
            ),
            f"({UNMARKED_FOLDER.replace('_', ' ')}: by contours, and keypoints as detectors see them)",
            f"Open in Blender: {output / BLEND}",
            missing or f"On a character: {output / CHARACTER_BLEND} (Rigify's basic human)",
            f"Without markers: {output / UNMARKED_FOLDER / BLEND}",
            f"Animated from clip and height: {output / ANIMATED_FOLDER / best}",
            *(f"  {finding}" for finding in animated.notes[:4]),
            f"Pictures:        {output / REPORT}",
        ]
        console.finish(result, "\n".join(lines))


def _score(take: Take, motion: Motion) -> Score:
    truth = read_truth(take.folder / "truth.json", motion.frame_start, len(motion.time_s))
    known = motion.method != "interpolation"
    sigma = motion.sigma_m if known else None
    return score_points(motion.points, truth, motion.keyframe_indices, take.camera, sigma)


SCRIPT = Path(__file__).parent.with_name("generate_rigify_human.py")
LONGEST_S = 300.0


def write_demo_character(file: Path) -> None:
    """Generate the rig with the shipped skin into a .blend."""
    import bpy

    program = bpy.app.binary_path
    command = [program, "-b", "--factory-startup", "--python"] if program else [sys.executable, "-P"]
    arguments = ["--", str(file)] if program else [str(file)]
    try:
        done = subprocess.run(
            [*command, str(SCRIPT), *arguments],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=LONGEST_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ConversionError(f"{file}: Rigify's human cannot be generated ({error})") from error
    if done.returncode or not file.is_file():
        lines = done.stderr.decode(errors="replace").strip().splitlines() or ["no reason is given"]
        raise ConversionError(f"{file}: Rigify's human cannot be generated ({lines[-1]})")
