"""Found keyframes: jump to them, accept and remove them."""

import bpy

from ...core.body.human import HUMAN
from ..shell.base_operator import BaseOperator, Unchanged
from ..shell.contradictions import note_contradictions
from ..shell.fields import Choice, Switch
from ..shell.keyed_frames import doubtful_matches, match_at, state_of
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .found_keyframes import chosen_match, undecided_matches


class KEYMARK_OT_jump_to_match(BaseOperator, bpy.types.Operator):
    """Go to a found keyframe"""

    bl_label = "Jump to Found Keyframe"
    requirements = (matches,)

    direction: Choice(
        "Direction",
        "Direction from the current frame; from the last one it goes to the first",
        items=[
            ("NEXT", "Next", "Go to the next found keyframe"),
            ("PREVIOUS", "Previous", "Go to the previous found keyframe"),
        ],
    )
    only_doubtful: Switch("Only Doubtful", "Go to doubtful ones only, the most doubtful first", default=False)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        if properties.only_doubtful:
            return (
                "Go to the most doubtful found keyframe: first those in which something that is seen "
                "contradicts, then the least sure ones. Accept it, take another candidate, or correct "
                "the pose and store it; pressed once more, it goes on to the next"
            )
        return f"Go to the {properties.direction.lower()} found keyframe"

    def run(self, context: bpy.types.Context) -> None:
        take, now = active_take(context.scene), context.scene.frame_current_final
        if self.only_doubtful:  # the most doubtful one or, where that is shown, the one after it
            places, here = doubtful_matches(take), match_at(take, now)
            at = places.index(here) if here in places else None
            if not places:
                raise Unchanged("no found keyframe is in doubt")
            step = 1 if self.direction == "NEXT" else -1
            wanted = places[0 if at is None else (at + step) % len(places)]
        else:  # the nearest one, around the ends
            frames = [match.frame for match in take.matching.matches]
            after = [place for place, frame in enumerate(frames) if frame > now + 1e-3]
            before = [place for place, frame in enumerate(frames) if frame < now - 1e-3]
            wanted = (after or [0])[0] if self.direction == "NEXT" else (before or [len(frames) - 1])[-1]
        take.matching.shown_match = wanted


class KEYMARK_OT_accept_match(BaseOperator, bpy.types.Operator):
    """Count this pose as right in the picture: finding again leaves it alone, its depth stays as found"""

    bl_label = "Accept"
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        from ..bridge.keyframes import take_over

        take = active_take(context.scene)
        match = chosen_match(take)
        if state_of(take, match) != "FOUND":
            raise Unchanged(f"frame {match.frame:g} is no found keyframe any more")
        frame = round(match.frame, 3)
        take_over(take.armature, take.keyframe_action, HUMAN, (frame,))
        note_contradictions(take, frame, ())
        self.report({"INFO"}, f"Frame {frame:g} counts as right in the picture now")


class KEYMARK_OT_remove_match(BaseOperator, bpy.types.Operator):
    """Remove this found keyframe and its keys; a pose of your own at its frame stays"""

    bl_label = "Remove"
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        from ..bridge.keyframes import remove_keyframes

        take = active_take(context.scene)
        matching, match = take.matching, chosen_match(take)
        frame = round(match.frame, 3)
        if state_of(take, match) == "FOUND":
            remove_keyframes(take.armature, take.keyframe_action, HUMAN, (frame,))
        note_contradictions(take, frame, ())
        removed = matching.shown_match
        matching.matches.remove(removed)
        matching.shown_match = max(0, min(removed, len(matching.matches) - 1))
        self.report({"INFO"}, f"Removed the found keyframe at frame {frame:g}")


class KEYMARK_OT_remove_found(BaseOperator, bpy.types.Operator):
    """Remove every found keyframe that you have neither changed, accepted nor chosen the pose of"""

    bl_label = "Remove All Found"
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Remove their keys and entries; what the animator has decided on stays."""
        from .found_result import clear_found

        scene, take = context.scene, active_take(context.scene)
        if not undecided_matches(take):
            raise Unchanged("all found keyframes are yours by now; nothing was removed")
        count = clear_found(take)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        self.report({"INFO"}, f"Removed {count} found keyframes")
