"""Learn a keyframe library from a take's motion."""

import bpy

from ...core.library.texts import identifier_from
from ..shell.base_operator import BaseOperator
from ..shell.messages import warn_if_outdated
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take
from .licenses import suggest
from .registry import refresh

DIALOG_WIDTH = 360
ONCE = "Learned '{title}': {count} postures over {seconds:.1f} s"
A_CYCLE = "Learned '{title}': {count} postures of a cycle of {seconds:.2f} s, which comes again and again"


class KEYMARK_OT_learn_library(BaseOperator, bpy.types.Operator):
    """Make a keyframe library of the motion, so that the next take of its kind needs fewer keyframes"""

    bl_idname = "keymark.learn_library"
    bl_label = "Library from Motion"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, motion, idle)

    title: bpy.props.StringProperty(
        name="Title", description="Title of the library; by default the take's name"
    )
    author: bpy.props.StringProperty(name="Author", description="Author of the library")
    license: bpy.props.StringProperty(
        name="License",
        description="Terms under which others may use it, an SPDX expression such as CC0-1.0 or CC-BY-4.0; "
        "by default none",
        default="LicenseRef-Proprietary",
        search=suggest,
        search_options={"SUGGESTION"},
    )
    count: bpy.props.IntProperty(
        name="Postures",
        description="Number of postures in the library; 0 for 10 to 40, as many as differ",
        default=0,
        min=0,
        max=1000,
    )
    learned_as: bpy.props.StringProperty(
        name="Learned As",
        description="Identifier that the library was given, by which learning again replaces it",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for title and author."""
        take = active_take(context.scene)
        if not self.title:
            self.title = take.name
        if not self.author:
            self.author = take.finish.author
        return context.window_manager.invoke_props_dialog(self, width=DIALOG_WIDTH, confirm_text="Learn")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the dialog."""
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("title", "author", "license"):
            layout.prop(self, name)
        layout.prop(self, "count", text="Postures (0: Automatic)")

    def run(self, context: bpy.types.Context) -> None:
        """Learn the library, and write it into the user's folder."""
        from ...core.library.learning import LibraryMetadata
        from ..bridge.library.library_from_action import library_from_action
        from .registry_files import registered_identifiers, write_to_registry

        take, render = active_take(context.scene), context.scene.render
        title = self.title.strip() or take.name
        about = LibraryMetadata(
            title=title,
            author=self.author.strip() or "Unknown",
            license=self.license.strip(),
            identifier=self.learned_as or identifier_from(title, registered_identifiers()),
        )
        action = take.finish.action or take.motion_action
        frame_s = render.fps_base / render.fps
        library = library_from_action(take.armature, action, frame_s, about, self.count or None)
        self.learned_as = library.identifier
        write_to_registry([library])
        refresh(library.identifier)
        warn_if_outdated(self, take)
        (learned,) = library.motions
        count, seconds = len(library.postures), learned.duration_s
        said = A_CYCLE if learned.cyclic else ONCE
        self.report({"INFO"}, said.format(title=title, count=count, seconds=seconds))


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_learn_library,))
