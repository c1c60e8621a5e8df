"""A take as it is read where keyframes are to be found: with those that a person posed, or with none."""

from dataclasses import replace
from pathlib import Path

from .conversion_settings import ConversionSettings
from .description import Description
from .take import Take
from .take_file import read_described


def take_to_pose(
    description: Description, keyframes: Path | None, settings: ConversionSettings | None = None
) -> Take:
    """Read a take with the keyframes that a person posed, or with none where no file is named.

    Keyframes that an earlier run has found are left out, since they are found anew. `settings` say which
    keypoints are read and which evidence is used, by default the take's own.

    Raises:
        InputError: The take or the keyframe file is unusable.
    """
    fewest = 0 if keyframes is None else 1
    take = read_described(
        description, keyframes, keyframes_required=False, fewest_keyframes=fewest, settings=settings
    )
    return replace(take, keyframes=tuple(k for k in take.keyframes if k.matched is None))
