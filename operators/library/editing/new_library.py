"""Begin a keyframe library in this file."""

import bpy

from ....core.errors import InputError
from ....core.library.texts import LONGEST_NAME, identifier_from, text_fault
from ...shell.base_operator import BaseOperator
from ...shell.messages import say
from ...shell.requirements import idle
from ..licenses import suggest


class KEYMARK_OT_new_library(BaseOperator, bpy.types.Operator):
    """Begin a keyframe library: pose the actor, add posture after posture, then share it as a file"""

    bl_idname = "keymark.new_library"
    bl_label = "New Library"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (idle,)

    title: bpy.props.StringProperty(name="Title", description="Title of the library", default="My Library")
    author: bpy.props.StringProperty(name="Author", description="Author of the library")
    license: bpy.props.StringProperty(
        name="License",
        description="Terms under which others may use it, an SPDX expression such as CC0-1.0 or CC-BY-4.0; "
        "by default none",
        default="LicenseRef-Proprietary",
        search=suggest,
        search_options={"SUGGESTION"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the title."""
        return context.window_manager.invoke_props_dialog(self, confirm_text="Begin")

    def run(self, context: bpy.types.Context) -> None:
        """Add the library, without postures."""
        from ....core.library.text_fields import LONGEST_LINE

        settings = context.scene.keymark
        fault = text_fault(self.title.strip(), LONGEST_NAME)
        if fault:
            raise InputError("the library's title is '{title}'; it {fault}", title=self.title, fault=fault)
        fault = text_fault(self.author.strip(), LONGEST_LINE) if self.author.strip() else ""
        if fault:
            raise InputError(
                "the library's author is '{author}'; it {fault}", author=self.author, fault=fault
            )
        group = settings.libraries.add()
        group.name, group.author = self.title.strip(), self.author.strip()
        others = [other.identifier for other in settings.libraries]
        group.license = self.license.strip()
        group.identifier = identifier_from(group.name, others)
        settings.active_library = len(settings.libraries) - 1
        say(self, "INFO", "Began the library '{title}'; now add postures", title=group.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_new_library,))
