"""Jump to the next or previous found keyframe, or to a doubtful one."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.found_frames import doubtful_matches, match_at
from ..shell.keyed_frames import invalidate_keyed_frames
from ..shell.requirements import matches
from ..shell.takes import active_take


class KEYMARK_OT_jump_to_match(BaseOperator, bpy.types.Operator):
    """Go to a found keyframe"""

    bl_idname = "keymark.jump_to_match"
    bl_label = "Jump to Found Keyframe"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (matches,)

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Direction from the current frame; from the last one it goes to the first",
        items=[
            ("NEXT", "Next", "Go to the next found keyframe"),
            ("PREVIOUS", "Previous", "Go to the previous found keyframe"),
        ],
    )
    only_doubtful: bpy.props.BoolProperty(
        name="Only Doubtful", description="Go to doubtful ones only, the most doubtful first", default=False
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tooltip with the direction."""
        if properties.only_doubtful:
            return (
                "Go to the most doubtful found keyframe: first those in which something that is seen "
                "contradicts, then the least sure ones. Accept it, take another candidate, or correct "
                "the pose and store it; pressed once more, it goes on to the next"
            )
        if properties.direction == "NEXT":
            return "Go to the next found keyframe"
        return "Go to the previous found keyframe"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Choose it in the list, which goes there."""
        take = active_take(context.scene)
        invalidate_keyed_frames()
        wanted = self._doubtful(take) if self.only_doubtful else self._in_order(context.scene, take)
        if wanted is None:
            self.report({"INFO"}, "No found keyframe is in doubt")
            return {"CANCELLED"}
        take.matching.shown_match = wanted
        return None

    def _doubtful(self, take: bpy.types.PropertyGroup) -> int | None:
        """The most doubtful one or, where that is shown, the one after it; None where none is in doubt."""
        doubtful = doubtful_matches(take)
        if not doubtful:
            return None
        step = 1 if self.direction == "NEXT" else -1
        shown = match_at(take, take.id_data.frame_current_final)
        return doubtful[(doubtful.index(shown) + step) % len(doubtful)] if shown in doubtful else doubtful[0]

    def _in_order(self, scene: bpy.types.Scene, take: bpy.types.PropertyGroup) -> int:
        """The nearest one in the direction, around the ends."""
        now, places = scene.frame_current_final, range(len(take.matching.matches))
        frames = [match.frame for match in take.matching.matches]
        if self.direction == "NEXT":
            return next((place for place in places if frames[place] > now + 1e-3), 0)
        return next((place for place in reversed(places) if frames[place] < now - 1e-3), places[-1])


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_jump_to_match,))
