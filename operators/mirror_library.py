"""Mirror postures of the library that is made in this file."""

import bpy

from .running.failures import reported
from .running.redraw import refresh_asset_browsers
from .running.requirements import a_library_here, all_met, idle
from .running.say import say
from .scene.libraries import active_posture, library_here

WORD = "Mirrored"


class KEYMARK_OT_mirror_library(bpy.types.Operator):
    """Add postures with left and right exchanged; those of both sides need to be posed only once"""

    bl_idname = "keymark.mirror_library"
    bl_label = "Add Mirrored"
    bl_options = {"REGISTER", "UNDO"}

    what: bpy.props.EnumProperty(
        name="What",
        description="What is mirrored",
        items=[
            ("POSTURE", "Chosen Posture", "Add the chosen posture mirrored"),
            ("POSTURES", "All Postures", "Add all postures mirrored"),
            ("LIBRARY", "A New Library", "Make a mirrored library beside this one, with its motions"),
        ],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a library."""
        return all_met(cls, context, a_library_here, idle)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add them at the end of the list."""
        with reported(self):
            from dataclasses import replace

            from ..core.body.mirror import mirrored
            from ..core.errors import InputError
            from ..core.library.texts import identifier_from
            from .scene.libraries import add_library, library_of
            from .scene.library_postures import add_named

            group = library_here(context.scene)
            library = library_of(group)
            if self.what == "LIBRARY":
                from ..core.library.mirroring import mirrored_library

                taken = [other.identifier for other in context.scene.keymark.libraries]
                title = _with_word(library.title)
                made = replace(
                    mirrored_library(library), identifier=identifier_from(title, taken), title=title
                )
                add_library(context.scene, made)
                refresh_asset_browsers(context)
                say(self, "INFO", "'{title}' is in this file now", title=title)
                return {"FINISHED"}
            chosen = active_posture(group)
            wanted = [
                posture
                for posture in library.postures
                if self.what == "POSTURES" or (chosen is not None and posture.name == chosen.name)
            ]
            if not wanted:
                raise InputError("no posture is chosen; choose the one to mirror")
            added = add_named(
                group,
                [
                    replace(
                        posture,
                        name=_with_word(posture.name),
                        posture=mirrored(posture.posture),
                    )
                    for posture in wanted
                ],
            )
            refresh_asset_browsers(context)
            say(self, "INFO", "Added {count} mirrored postures", count=len(added))
            return {"FINISHED"}
        return {"CANCELLED"}


def _with_word(name: str) -> str:
    from ..core.library.texts import LONGEST_NAME

    return f"{name[: LONGEST_NAME - len(WORD) - 1].rstrip()} {WORD}"


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mirror_library,))
