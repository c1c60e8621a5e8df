"""Found keyframes and offered poses: jump to them, take a candidate, accept, remove."""

from collections.abc import Callable
from math import degrees

import bpy
from bpy.types import Context, Operator, OperatorProperties, PropertyGroup

from ...core.errors import InputError
from ...core.prior.texts import COMPOSED
from ..bridge.keyframes import candidate_posture, remove_keyframes, take_over
from ..bridge.pose import write_posture
from ..bridge.scene_frames import show_frame
from ..overlays.tools import look_at
from ..shell import need
from ..shell.base_operator import BaseOperator, Unchanged, operator
from ..shell.fields import Integer, Switch
from ..shell.keyed_frames import show_keyframes
from ..shell.notes import note_contradictions
from ..shell.take_state import TakeState
from ..shell.takes import active_take
from .corrections import LIMBS
from .found_properties import directions, known_matches, match_here, neighbor
from .posing import improve_neighbors


class KEYMARK_OT_jump_to_match(BaseOperator, bpy.types.Operator):
    """Go to a found keyframe"""

    bl_label = "Jump to Found Keyframe"
    requirements = (need.matches,)

    direction: directions("found keyframe", "Direction from this frame; from the last one on to the first")
    only_doubtful: Switch("Only Doubtful", "Go to doubtful ones only, the most doubtful first", default=False)

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        if properties.only_doubtful:
            return (
                "Go to the most doubtful found keyframe: first those in which something that is seen "
                "contradicts, then the least sure ones. Accept it, take another candidate, or correct "
                "the pose and store it; pressed once more, it goes on to the next"
            )
        return f"Go to the {properties.direction.lower()} found keyframe"

    def run(self, context: Context) -> None:
        take, now = active_take(context.scene), context.scene.frame_current_final
        if self.only_doubtful:  # the most doubtful one or, where that is shown, the one after it
            places, here = TakeState(take).doubtful, TakeState(take).match_at(now)
            at = places.index(here) if here in places else None
            if not places:
                raise Unchanged("no found keyframe is in doubt")
            step = 1 if self.direction == "NEXT" else -1
            wanted = places[0 if at is None else (at + step) % len(places)]
        else:  # the nearest one, around the ends
            frames = [match.frame for match in take.matching.matches]
            end = frames[0 if self.direction == "NEXT" else -1]
            nearest = neighbor(frames, now, self.direction)
            wanted = frames.index(end if nearest is None else nearest)
        take.matching.shown_match = wanted


here = need.of_take(
    lambda state: state.match_at(state.take.id_data.frame_current_final) >= 0,
    "This frame holds no found keyframe; choose one in the list",
)


@operator("Accept", need.actor, need.matches, here, need.idle)
def accept_match(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Count this pose as right in the picture: finding again leaves it alone, its depth stays as found"""
    match = match_here(take)
    if TakeState(take).of_match(match) != "FOUND":
        raise Unchanged(f"frame {match.frame:g} is no found keyframe any more")
    frame = round(match.frame, 3)
    take_over(take.armature, take.keyframe_action, (frame,))
    note_contradictions(take, frame, ())
    operator.report({"INFO"}, f"Frame {frame:g} counts as right in the picture now")


@operator("Remove", need.actor, need.matches, here, need.idle)
def remove_match(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Remove this found keyframe and its keys; a pose of your own at its frame stays"""
    matching, match = take.matching, match_here(take)
    frame = round(match.frame, 3)
    if TakeState(take).of_match(match) == "FOUND":
        remove_keyframes(take.armature, take.keyframe_action, (frame,))
    note_contradictions(take, frame, ())
    removed = TakeState(take).match_at(frame)
    matching.matches.remove(removed)
    matching.shown_match = max(0, min(removed, len(matching.matches) - 1))
    operator.report({"INFO"}, f"Removed the found keyframe at frame {frame:g}")


@operator("Remove All Found", need.actor, need.matches, need.idle)
def remove_found(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Remove every found keyframe that you have neither changed, accepted nor chosen the pose of"""
    from .found_result import clear_found

    scene, take = context.scene, active_take(context.scene)
    if not known_matches(take, by_hand=False):
        raise Unchanged("all found keyframes are yours by now; nothing was removed")
    count = clear_found(take)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    operator.report({"INFO"}, f"Removed {count} found keyframes")


NOTICEABLE_TURN_DEG = 15.0
PAIRS = {("arm.L", "arm.R"): "arms", ("leg.L", "leg.R"): "legs"}
"""Limbs that are named together."""


def candidate_title(match: PropertyGroup, candidate: PropertyGroup) -> str:
    """What tells a candidate from the first: its turn, then its posture's name, or limbs if composed."""
    angle_deg, turn = degrees(candidate.turned), ""  # hardly seen
    if abs(angle_deg) > 180.0 - NOTICEABLE_TURN_DEG:
        turn = "Turned round"
    elif abs(angle_deg) >= NOTICEABLE_TURN_DEG:
        turn = f"{abs(angle_deg):.0f}° {'left' if angle_deg > 0.0 else 'right'}"
    if match.library != COMPOSED:
        named = str(candidate.name)
        return f"{turn}, {named}" if turn else named[:1].upper() + named[1:]
    elsewhere, words = candidate.limbs.split(), []
    for pair, both in PAIRS.items():
        there = [LIMBS[name] for name in pair if name in elsewhere]
        words += [both] if len(there) == len(pair) else there
    limbs = ", ".join(words)
    if turn:
        return f"{turn}, other {limbs}" if limbs else turn
    if limbs:
        return f"Other {limbs}"
    return "As found" if candidate == match.candidates[0] else "Nearly as found"


class CandidateOperator(BaseOperator):
    """Base of operators that take one of what a frame may show, which is drawn while their tooltip is."""

    candidate: Integer("Candidate", "Index of the posture; 0 is the one that was likeliest", default=0, min=0)

    source: Callable[[PropertyGroup], PropertyGroup | None]
    """What has the candidates at the current frame of a take."""

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        source = cls.source(active_take(context.scene))
        if source is None or properties.candidate >= len(source.candidates):
            return str(cls.__doc__)
        look_at(context, properties.candidate)
        return f"{candidate_title(source, source.candidates[properties.candidate])}. {cls.__doc__}"

    def chosen(self, take: PropertyGroup) -> PropertyGroup:
        """What has the candidates, if the wanted one is among them."""
        source = self.source(take)
        if source is None:
            frame = take.id_data.frame_current_final
            raise InputError(f"frame {frame:g} offers no poses; fit it to the footage first")
        count = len(source.candidates)
        if self.candidate >= count:
            raise InputError(
                f"frame {source.frame:g} has {count} candidates; candidate must be 0 to {count - 1}"
            )
        return source


class KEYMARK_OT_replace_match(CandidateOperator, bpy.types.Operator):
    """Key this posture instead; what is keyed at the frame is replaced"""

    bl_label = "Take Candidate"
    requirements = (need.actor, need.matches, here, need.idle)

    source = staticmethod(match_here)

    def run(self, context: Context) -> None:
        from .found_result import key_matches

        take = active_take(context.scene)
        match = self.chosen(take)
        match.chosen, match.by_hand = self.candidate, True
        key_matches(take, [round(match.frame, 3)], [candidate_posture(match.candidate)])
        show_frame(context.scene, match.frame)
        frame, number = float(match.frame), self.candidate + 1
        note_contradictions(take, frame, ())
        improved = improve_neighbors(context, take, frame)  # moves the entries of others in memory
        also = f"; {improved} found ones around it were posed anew" if improved else ""
        self.report({"INFO"}, f"Frame {frame:g} shows candidate {number}{also}")


class KEYMARK_OT_show_offered(CandidateOperator, bpy.types.Operator):
    """Pose the actor like this; nothing is keyed until you store it"""

    bl_label = "Show Candidate"
    requirements = (need.actor, need.idle)

    source = staticmethod(lambda take: TakeState(take).offered_at(take.id_data.frame_current_final))

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        offered = self.chosen(take)
        show_keyframes(take)
        write_posture(take.armature, candidate_posture(offered.candidates[self.candidate]))
        if offered.chosen != self.candidate:
            note_contradictions(take, context.scene.frame_current_final, ())
        offered.chosen = self.candidate
