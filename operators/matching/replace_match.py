"""Replace the posture of a found keyframe by another candidate."""

import bpy

from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take, find_take
from .candidate_titles import candidate_title
from .improve_neighbors import improve_neighbors
from .matches import chosen_match


class KEYMARK_OT_replace_match(BaseOperator, bpy.types.Operator):
    """Key this posture instead; what is keyed at the frame is replaced"""

    bl_idname = "keymark.replace_match"
    bl_label = "Take Candidate"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, matches, idle)

    candidate: bpy.props.IntProperty(
        name="Candidate",
        description="Index of the candidate to take; 0 is the one that was chosen first",
        default=0,
        min=0,
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Tooltip with the candidate's whole name, which a narrow sidebar cuts off."""
        take = find_take(context.scene)
        matching = take.matching if take is not None else None
        if matching is None or matching.shown_match >= len(matching.matches):
            return str(cls.__doc__)
        match = matching.matches[matching.shown_match]
        if properties.candidate >= len(match.candidates):
            return str(cls.__doc__)
        said = candidate_title(match, match.candidates[properties.candidate])
        return f"{said}. Key this posture instead; what is keyed at the frame is replaced"

    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Key the candidate, and go to its frame."""
        from .match_edits import key_candidate

        take = active_take(context.scene)
        match = chosen_match(take)
        if self.candidate >= len(match.candidates):
            self.report(
                {"ERROR"},
                f"Frame {match.frame:g} has {len(match.candidates)} candidates; candidate must be 0 to "
                f"{len(match.candidates) - 1}",
            )
            return {"CANCELLED"}
        match.chosen, match.by_hand = self.candidate, True
        key_candidate(take, match)
        match.go_to(context.scene)
        frame, number = float(match.frame), self.candidate + 1
        note_contradictions(take, frame, ())
        improved = improve_neighbors(context, take, frame)  # moves the entries of others in memory
        if improved:
            self.report(
                {"INFO"},
                f"Frame {frame:g} shows candidate {number}; {improved} found ones around it were posed anew",
            )
        else:
            self.report({"INFO"}, f"Frame {frame:g} shows candidate {number}")
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_replace_match,))
