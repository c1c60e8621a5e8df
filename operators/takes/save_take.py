"""Save the active take as a folder, to convert it elsewhere."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ...core.progress import run
from ..keypoints.evidence import scene_evidence
from ..matching.matches import known_matches
from ..shell.base_operator import BaseOperator
from ..shell.messages import warn
from ..shell.requirements import actor, footage, idle
from ..shell.takes import active_take, footage_of


class KEYMARK_OT_save_take(BaseOperator, bpy.types.Operator):
    """Save footage, camera, actor, keyframes and what is followed as a take folder, to convert elsewhere"""

    bl_idname = "keymark.save_take"
    bl_label = "Save Take"
    bl_options = {"REGISTER"}
    requirements = (footage, actor, idle)

    directory: bpy.props.StringProperty(
        name="Folder",
        description="Where take.json, keyframes.json and the clip are written",
        subtype="DIR_PATH",
    )
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the file browser."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: bpy.types.Context) -> None:
        """Read the take from the scene and write the folder."""
        from ...core.shoot.discovery import check_hides_no_take
        from ...core.take.evidence import evidence_of
        from ...core.take.take_file import write_take
        from ..bridge.take_from_scene import read_scene_take

        if not self.directory:
            raise InputError("directory is empty; name the folder to save the take in")
        scene_take = active_take(context.scene)
        take, notes = run(
            read_scene_take(
                footage_of(context.scene, scene_take),
                scene_take.armature,
                scene_take.keyframe_action,
                scene_evidence(scene_take),
                known_matches(scene_take),
            )
        )
        folder = Path(bpy.path.abspath(self.directory))
        check_hides_no_take(folder)
        folder.mkdir(parents=True, exist_ok=True)
        has = evidence_of(take)
        # A camera that stands still brings contours, unless the take says that they are not followed.
        write_take(take, folder, has if has and not take.contours else None)
        for note in notes:
            warn(self, note)
        self.report({"INFO"}, f"Saved the take in {folder}")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_save_take,))
