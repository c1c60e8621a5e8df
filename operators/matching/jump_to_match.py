"""Jump to the next or previous match, or to a doubtful one."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.messages import say
from ..shell.requirements import matches
from ..shell.takes import active_take
from .matches import state_of


class KEYMARK_OT_jump_to_match(BaseOperator, bpy.types.Operator):
    """Go to a frame that was matched with a library"""

    bl_idname = "keymark.jump_to_match"
    bl_label = "Jump to Match"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (matches,)

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Direction from the current frame; from the last match it goes to the first",
        items=[
            ("NEXT", "Next", "Go to the next match"),
            ("PREVIOUS", "Previous", "Go to the previous match"),
        ],
    )
    only_doubtful: bpy.props.BoolProperty(
        name="Only Doubtful", description="Go to doubtful matches only", default=False
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tooltip with the direction."""
        if properties.only_doubtful:
            return "Go to the next doubtful match: replace it, or pose the actor there"
        return "Go to the next match" if properties.direction == "NEXT" else "Go to the previous match"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Choose the match in the list, which goes there."""
        scene, take = context.scene, active_take(context.scene)
        matching = take.matching
        invalidate_keyed_frames()
        wanted = [
            (match.frame, index)
            for index, match in enumerate(matching.matches)
            if not self.only_doubtful or (match.is_doubtful and state_of(take, match) == "MATCHED")
        ]
        if not wanted:
            say(self, "INFO", "No match is in doubt")
            return {"CANCELLED"}
        now = scene.frame_current_final
        if self.direction == "NEXT":
            ahead = [each for each in wanted if each[0] > now + 1e-3]
            chosen = min(ahead or wanted)
        else:
            behind = [each for each in wanted if each[0] < now - 1e-3]
            chosen = max(behind or wanted)
        matching.active_match = chosen[1]
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_jump_to_match,))
