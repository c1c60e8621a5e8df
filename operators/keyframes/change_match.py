"""Found keyframes: jump to them, accept, remove and replace them."""

import bpy

from ...core.body.human import HUMAN
from ..overlays.candidates import look_at
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.fields import Choice, Integer, Switch
from ..shell.keyed_frames import doubtful_matches, invalidate_keyed_frames, match_at, state_of
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take, find_take
from .candidate_buttons import candidate_title
from .found_keyframes import chosen_match, undecided_matches
from .store_keyframe import improve_neighbors


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

    def run(self, context: bpy.types.Context) -> set[str] | None:
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


class KEYMARK_OT_accept_match(BaseOperator, bpy.types.Operator):
    """Count this pose as right in the picture: finding again leaves it alone, its depth stays as found"""

    bl_idname = "keymark.accept_match"
    bl_label = "Accept"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        from ..bridge.keyframes import take_over

        take = active_take(context.scene)
        match = chosen_match(take)
        invalidate_keyed_frames()
        if state_of(take, match) != "FOUND":
            self.report({"INFO"}, f"Frame {match.frame:g} is no found keyframe any more")
            return {"CANCELLED"}
        frame = round(match.frame, 3)
        take_over(take.armature, take.keyframe_action, HUMAN, (frame,))
        note_contradictions(take, frame, ())
        invalidate_keyed_frames()
        self.report({"INFO"}, f"Frame {frame:g} counts as right in the picture now")
        return None


class KEYMARK_OT_remove_match(BaseOperator, bpy.types.Operator):
    """Remove this found keyframe and its keys; a pose of your own at its frame stays"""

    bl_idname = "keymark.remove_match"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> None:
        from ..bridge.keyframes import remove_keyframes

        scene = context.scene
        take = active_take(scene)
        matching, match = take.matching, chosen_match(take)
        invalidate_keyed_frames()
        frame = round(match.frame, 3)
        if state_of(take, match) == "FOUND":
            remove_keyframes(take.armature, take.keyframe_action, HUMAN, (frame,))
            invalidate_keyed_frames()
        note_contradictions(take, frame, ())
        removed = matching.shown_match
        matching.matches.remove(removed)
        matching.shown_match = max(0, min(removed, len(matching.matches) - 1))
        self.report({"INFO"}, f"Removed the found keyframe at frame {frame:g}")


class KEYMARK_OT_remove_found(BaseOperator, bpy.types.Operator):
    """Remove every found keyframe that you have neither changed, accepted nor chosen the pose of"""

    bl_idname = "keymark.remove_found"
    bl_label = "Remove All Found"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Remove their keys and entries; what the animator has decided on stays."""
        from .found_result import clear_found

        scene, take = context.scene, active_take(context.scene)
        if not undecided_matches(take):
            self.report({"INFO"}, "All found keyframes are yours by now; nothing was removed")
            return {"CANCELLED"}
        count = clear_found(take)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        self.report({"INFO"}, f"Removed {count} found keyframes")
        return None


class KEYMARK_OT_replace_match(BaseOperator, bpy.types.Operator):
    """Key this posture instead; what is keyed at the frame is replaced"""

    bl_idname = "keymark.replace_match"
    bl_label = "Take Candidate"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    candidate: Integer(
        "Candidate", "Index of the candidate to take; 0 is the one that was chosen first", default=0, min=0
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        take = find_take(context.scene)
        matching = take.matching if take is not None else None
        if matching is None or matching.shown_match >= len(matching.matches):
            return str(cls.__doc__)
        match = matching.matches[matching.shown_match]
        if properties.candidate >= len(match.candidates):
            return str(cls.__doc__)
        look_at(context, properties.candidate)
        said = candidate_title(match, match.candidates[properties.candidate])
        return f"{said}. Key this posture instead; what is keyed at the frame is replaced"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        from .match_edits import key_candidate

        take = active_take(context.scene)
        match = chosen_match(take)
        if self.candidate >= len(match.candidates):
            count = len(match.candidates)
            sentence = f"Frame {match.frame:g} has {count} candidates; candidate must be 0 to {count - 1}"
            self.report({"ERROR"}, sentence)
            return {"CANCELLED"}
        match.chosen, match.by_hand = self.candidate, True
        key_candidate(take, match)
        match.go_to(context.scene)
        frame, number = float(match.frame), self.candidate + 1
        note_contradictions(take, frame, ())
        improved = improve_neighbors(context, take, frame)  # moves the entries of others in memory
        also = f"; {improved} found ones around it were posed anew" if improved else ""
        self.report({"INFO"}, f"Frame {frame:g} shows candidate {number}{also}")
        return None
