"""Gather pose assets that were appended or dragged into this file into libraries."""

import bpy

from ....core.errors import InputError
from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle


class KEYMARK_OT_gather_library(BaseOperator, bpy.types.Operator):
    """Make libraries of Keymark's pose assets that were appended, or dragged here from the asset browser"""

    bl_idname = "keymark.gather_library"
    bl_label = "Gather Pose Assets"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (idle,)

    def run(self, context: bpy.types.Context) -> None:
        """Add a library for each header among the pose assets that are not listed yet."""
        from ...bridge.library.pose_assets import assets_by_library, library_from_assets
        from .library_to_scene import add_library

        listed = context.scene.keymark.libraries
        known = {entry.action for group in listed for entry in group.postures}
        loose = [action for action in bpy.data.actions if action not in known and action.library is None]
        found = assets_by_library(loose)
        taken = {group.identifier for group in listed}
        gathered = {name: actions for name, actions in found.items() if name not in taken}
        if not gathered:
            raise InputError("this file has no pose assets of a library that is not listed already")
        for actions in gathered.values():
            (library,) = library_from_assets(actions)
            add_library(context.scene, library, actions)
        say(self, "INFO", "Gathered {count} libraries", count=len(gathered))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_gather_library,))
