"""Postures that a frame may show: in what each differs from the first one; operators that take one."""

from math import degrees

import bpy

from ...core.errors import InputError
from ...core.prior.texts import COMPOSED
from ..overlays.candidates import look_at
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.fields import Integer
from ..shell.keyed_frames import offered_at, show_keyframes
from ..shell.requirements import actor, idle, matches
from ..shell.takes import active_take
from .corrections import LIMBS
from .found_keyframes import chosen_match
from .store_keyframe import improve_neighbors

NOTICEABLE_TURN_DEG = 15.0
PAIRS = {("arm.L", "arm.R"): "arms", ("leg.L", "leg.R"): "legs"}
"""Limbs that are named together."""


def candidate_title(match: bpy.types.PropertyGroup, candidate: bpy.types.PropertyGroup) -> str:
    """What tells a candidate from the first one: its turn, then the name of its posture.

    Postures that were composed have the name of one that they resemble, which often is the same for all and
    tells a person little: instead the limbs are named that are elsewhere.
    """
    turn = _turn(degrees(candidate.turned))
    if match.library != COMPOSED:
        named = str(candidate.name)
        return f"{turn}: {named}" if turn else named[:1].upper() + named[1:]
    elsewhere, words = candidate.limbs.split(), []
    for pair, both in PAIRS.items():
        there = [LIMBS[name] for name in pair if name in elsewhere]
        words += [both] if len(there) == len(pair) else there
    limbs = ", ".join(words)
    if turn:
        return f"{turn}: {limbs}" if limbs else turn
    if limbs:
        return f"Other {limbs}"
    return "As found" if candidate == match.candidates[0] else "Nearly as found"


def _turn(angle_deg: float) -> str:
    """Words for a turn to the left; none where it is hardly seen."""
    if abs(angle_deg) < NOTICEABLE_TURN_DEG:
        return ""
    if abs(angle_deg) > 180.0 - NOTICEABLE_TURN_DEG:
        return "Turned round"
    return f"{abs(angle_deg):.0f}° {'left' if angle_deg > 0.0 else 'right'}"


class CandidateOperator(BaseOperator):
    """Base of operators that take one of what a frame may show, which is drawn while their tooltip is."""

    candidate: Integer("Candidate", "Index of the posture; 0 is the one that was likeliest", default=0, min=0)

    @classmethod
    def source(cls, take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
        """What has the candidates; raises InputError where there is nothing."""
        raise NotImplementedError

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        try:
            source = cls.source(active_take(context.scene))
        except InputError:
            return str(cls.__doc__)
        if properties.candidate >= len(source.candidates):
            return str(cls.__doc__)
        look_at(context, properties.candidate)
        return f"{candidate_title(source, source.candidates[properties.candidate])}. {cls.__doc__}"

    def chosen(self, take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
        """What has the candidates, if the wanted one is among them."""
        source = self.source(take)
        count = len(source.candidates)
        if self.candidate >= count:
            raise InputError(
                f"frame {source.frame:g} has {count} candidates; candidate must be 0 to {count - 1}"
            )
        return source


class KEYMARK_OT_replace_match(CandidateOperator, bpy.types.Operator):
    """Key this posture instead; what is keyed at the frame is replaced"""

    bl_label = "Take Candidate"
    requirements = (actor, matches, idle)

    source = staticmethod(chosen_match)

    def run(self, context: bpy.types.Context) -> None:
        from .match_edits import key_candidate

        take = active_take(context.scene)
        match = self.chosen(take)
        match.chosen, match.by_hand = self.candidate, True
        key_candidate(take, match)
        match.go_to(context.scene)
        frame, number = float(match.frame), self.candidate + 1
        note_contradictions(take, frame, ())
        improved = improve_neighbors(context, take, frame)  # moves the entries of others in memory
        also = f"; {improved} found ones around it were posed anew" if improved else ""
        self.report({"INFO"}, f"Frame {frame:g} shows candidate {number}{also}")


class KEYMARK_OT_show_offered(CandidateOperator, bpy.types.Operator):
    """Pose the actor like this; nothing is keyed until you store it"""

    bl_label = "Show Candidate"
    requirements = (actor, idle)

    @classmethod
    def source(cls, take: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup:
        frame = take.id_data.frame_current_final
        offered = offered_at(take, frame)
        if offered is None:
            raise InputError(f"frame {frame:g} offers no poses; fit it to the footage first")
        return offered

    def run(self, context: bpy.types.Context) -> None:
        from ..bridge.keyframes import candidate_posture
        from ..bridge.pose import write_posture

        take = active_take(context.scene)
        offered = self.chosen(take)
        show_keyframes(take)
        write_posture(take.armature, candidate_posture(offered.candidates[self.candidate]))
        if offered.chosen != self.candidate:
            note_contradictions(take, context.scene.frame_current_final, ())
        offered.chosen = self.candidate
