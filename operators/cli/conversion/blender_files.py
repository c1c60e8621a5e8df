"""motion.blend and motion.bvh, written by Blender into the staging folder of a conversion."""

import os
from pathlib import Path

from ....core.take.motion import Motion
from ....core.take.take import Take
from ..blender_silence import blender_silence

BLEND, BVH = "motion.blend", "motion.bvh"


def write_blender_files(take: Take, motion: Motion, staging_folder: Path, output: Path, debug: bool) -> str:
    """Let Blender write both files into the staging folder.

    Blender stores the clip's path relative to the folder that it writes in, which must therefore lie as deep
    as `output`: where the staging folder does not, the files are written into `output` under hidden names
    and moved.

    Args:
        take: Clip, camera, body and markers.
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
    folder = staging_folder if staging_folder.parent == output.parent else output
    hidden = {name: folder / f"{staging_folder.name}-{name}" for name in (BLEND, BVH)}
    try:
        with blender_silence(debug):
            from ...bridge.result_files import write_scene

            curves = write_scene(take, motion, hidden[BLEND], hidden[BVH])
        for name, file in hidden.items():
            os.replace(file, staging_folder / name)
        return curves
    finally:
        for file in hidden.values():
            file.unlink(missing_ok=True)
