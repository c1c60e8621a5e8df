"""Mirror postures of the library that is made in this file."""

import bpy

from ....core.errors import InputError
from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import idle, scene_library
from .scene_libraries import library_here


class KEYMARK_OT_mirror_library(BaseOperator, bpy.types.Operator):
    """Add postures with left and right exchanged, so that one-sided ones need to be posed only once"""

    bl_idname = "keymark.mirror_library"
    bl_label = "Add Mirrored"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (scene_library, idle)

    what: bpy.props.EnumProperty(
        name="What",
        description="Postures to mirror",
        items=[
            ("POSTURE", "Chosen Posture", "Add the chosen posture mirrored"),
            ("POSTURES", "Whole Library", "Add the missing other side of all postures and motions"),
            ("LIBRARY", "A New Library", "Make a mirrored library beside this one, with its motions"),
        ],
    )

    def run(self, context: bpy.types.Context) -> None:
        """Add mirrored postures at the end of the list, or a mirrored library."""
        from ....core.library.mirroring import mirrored_library
        from .library_edits import add_mirrored
        from .library_from_scene import library_from_scene
        from .library_to_scene import add_library

        group = library_here(context.scene)
        library = library_from_scene(group)
        if self.what == "LIBRARY":
            made = mirrored_library(library)
            taken = [other.identifier for other in context.scene.keymark.libraries]
            if made.identifier in taken:
                raise InputError("library '{made}' is in this file already; remove it first", made=made.title)
            add_library(context.scene, made)
            say(self, "INFO", "'{title}' is in this file now", title=made.title)
        else:
            count = add_mirrored(group, only_chosen=self.what == "POSTURE")
            say(self, "INFO", "Added {count} mirrored postures", count=count)
        refresh_asset_browsers(context)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mirror_library,))
