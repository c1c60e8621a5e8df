"""Pose the actor in a posture of a library."""

from typing import TYPE_CHECKING

import bpy

from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.keyframe_action import show_keyframes
from ..shell.messages import say
from ..shell.requirements import actor, idle
from ..shell.takes import active_take
from .editing.scene_libraries import active_posture, library_here
from .library_choice import chosen_library

if TYPE_CHECKING:
    from ...core.library.library import Library


class KEYMARK_OT_apply_posture(BaseOperator, bpy.types.Operator):
    """Pose the actor in a posture of a library, fitted to its proportions; no key is set"""

    bl_idname = "keymark.apply_posture"
    bl_label = "Apply Posture"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one that is made in this file",
        options={"SKIP_SAVE"},
    )
    posture: bpy.props.StringProperty(
        name="Posture",
        description="Name of the posture; empty: the one chosen in the list",
        options={"SKIP_SAVE"},
    )
    mirrored: bpy.props.BoolProperty(
        name="Mirrored", description="Exchange left and right", options={"SKIP_SAVE"}
    )
    place: bpy.props.EnumProperty(
        name="Place",
        description="Location of the posed actor",
        items=[
            ("ACTOR", "Where the Actor Is", "At its location and heading, on the floor under its feet"),
            ("WORLD", "As in the Library", "As it was posed, above the world's origin, the floor at z = 0"),
        ],
    )

    def run(self, context: bpy.types.Context) -> None:
        """Fit the posture to the actor and pose it, over the keyframes."""
        from ..bridge.actor_lengths import read_body
        from ..bridge.library.posture_transfer import named_posture, placed_like, posture_for_actor
        from ..bridge.pose import read_posture, write_posture

        take = active_take(context.scene)
        body = read_body(take.armature, HUMAN)
        library, name = self._chosen(context)
        found = named_posture(library, name)
        posture = posture_for_actor(found, library.actor, body, mirror=self.mirrored)
        if self.place == "ACTOR":
            posture = placed_like(posture, body, read_posture(take.armature, body).posture)
        show_keyframes(take)
        write_posture(take.armature, posture)
        say(
            self,
            "INFO",
            "Posed as '{name}'; Fit from Current Pose brings it to the footage, Store Keyframe keys it",
            name=name,
        )

    def _chosen(self, context: bpy.types.Context) -> "tuple[Library, str]":
        """The library and the name of its posture."""
        if self.library:
            if not self.posture:
                raise InputError("no posture is chosen; choose one of the library's, or give posture")
            return chosen_library(context, self.library), self.posture
        group = library_here(context.scene)
        entry = active_posture(group)
        name = self.posture or (entry.name if entry is not None else "")
        if not name:
            raise InputError(
                "library '{library}' has no postures yet; pose the actor and add one", library=group.name
            )
        return chosen_library(context, ""), name


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_apply_posture,))
