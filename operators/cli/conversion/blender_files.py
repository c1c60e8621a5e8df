"""motion.blend and motion.bvh, written by Blender into the staging folder of a conversion."""

from pathlib import Path

from ....core.take.motion import Motion
from ....core.take.take import Take
from ..blender_silence import blender_silence
from .hidden_files import hidden_files

BLEND, BVH = "motion.blend", "motion.bvh"


def write_blender_files(take: Take, motion: Motion, staging_folder: Path, output: Path, debug: bool) -> str:
    """Let Blender write both files into the staging folder.

    Args:
        take: Clip, camera, body and what is followed.
        motion: The motion to write.
        staging_folder: Where the files are wanted.
        output: The folder of the result, as a real path.
        debug: Whether to let Blender's messages through.

    Returns:
        Digest of the curves in the .blend.

    Raises:
        InputError: Blender cannot read the clip.
        ConversionError: Blender cannot write a file.
    """
    with hidden_files((BLEND, BVH), staging_folder, output) as hidden, blender_silence(debug):
        from ...bridge.result_files import write_scene

        return write_scene(take, motion, hidden[BLEND], hidden[BVH])
