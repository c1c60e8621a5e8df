"""The takes that come along as examples: where they are, and copies of them."""

import filecmp
import shutil
from pathlib import Path

from ..errors import InputError
from ..files.output_folder import output_folder
from .description import KEYFRAME_FILE, KEYPOINT_FILE, TAKE_FILE

SHIPPED = Path(__file__).resolve().parents[2] / "presets" / "demo"
AEROBIC, GREETING = "aerobic", "greeting"
"""Names of the examples and of their folders: sleeves of five colors, and plain clothes."""
POSED_BY_HAND = "keyframes_noisy.json"
"""An example's keyframes with the errors that a person makes when posing; its keyframes.json has none."""
COPIED = {
    TAKE_FILE: TAKE_FILE,
    "clip.mp4": "clip.mp4",
    KEYPOINT_FILE: KEYPOINT_FILE,
    POSED_BY_HAND: KEYFRAME_FILE,
    "LICENSE.txt": "LICENSE.txt",
}
"""Files of an example that make up a take, and their names in a copy; the truth is left to the score."""


def example_folder(name: str) -> Path:
    """The folder of an example in this installation."""
    folder = SHIPPED / name
    if not folder.is_dir():
        raise InputError(f"{folder}: this example is missing from the installation; install Keymark anew")
    return folder


def copy_example(name: str, into: Path) -> Path:
    """Copy an example as a take of its own into a folder; returns the folder of the copy.

    A copy that is there already and unchanged stays as it is.
    """
    source, target = example_folder(name), into / name
    if target.exists():
        pairs = [(source / own, target / copied) for own, copied in COPIED.items()]
        if not all(copy.is_file() and filecmp.cmp(own, copy, shallow=False) for own, copy in pairs):
            raise InputError(
                f"{target}: something lies here that is no unchanged copy of the example; open it with "
                "Open Take, or choose another folder"
            )
        return target
    with output_folder(target) as staging:
        for own, copied in COPIED.items():
            shutil.copyfile(source / own, staging / copied)
    return target
