"""What a take has come to, read from the scene once for a redraw or a poll.

Panels, the next step, requirements and notices read it, so that they agree. Whether a result is outdated
follows from the digest of the curves that it was made from.
"""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

from bpy.types import Action, Object, PropertyGroup

from ...core.detect.keypoints import BODY_POINTS
from ...core.errors import InputError
from ..bridge.actions import action_digest, action_of
from ..bridge.footage import read_placement
from ..bridge.footage_camera import may_move
from ..bridge.keyframes import keyed_frames, unchanged_keyframes
from ..bridge.keys import FOUND, PICTURED, revision
from .keyed_frames import has_frame
from .notes import SAME_FRAME, SEPARATOR
from .results import LruCache
from .takes import NO_GUESS, as_numbers, assigned_tracks

DOUBTFUL = 0.5
"""Confidence below which a found keyframe, or a motion, is doubtful: no better than chance."""
STEPS = ("footage", "actor", "keyframes", "reconstruct", "character", "finish")
"""Names of the steps of the work, in order."""


@dataclass(frozen=True)
class KeyedFrames:
    """Scene frames keyed in an Action, in ascending order."""

    all: tuple[float, ...] = ()
    untouched: tuple[float, ...] = ()  # those whose keys are unchanged since they were found
    pictured: tuple[float, ...] = ()  # those that a person put right in the picture alone


_keyed: LruCache[KeyedFrames] = LruCache()
_digests: LruCache[str] = LruCache(64)
"""Both by the session numbers (`session_uid`) of what they were read from, and the revision of keys."""


def digest_of(action: Action | None) -> str:
    """Digest of an Action's curves; empty without an Action."""
    if action is None:
        return ""
    return _digests.known(f"{action.session_uid} {revision()}", lambda: action_digest(action)) or ""


@dataclass(frozen=True, eq=False)
class TakeState:
    """The state of a take; each value is read when it is first wanted, and kept."""

    take: PropertyGroup

    # --- Clip and performer

    @cached_property
    def placement_is_guess(self) -> bool:
        """Whether the camera still is where it was put because nobody had said where it stood."""
        take = self.take
        if take.camera is None or tuple(take.guessed_placement) == NO_GUESS or may_move(take.camera):
            return False
        now = as_numbers(read_placement(take.camera))
        return max(abs(one - other) for one, other in zip(now, take.guessed_placement, strict=True)) < 1e-4

    @cached_property
    def actor(self) -> Object | None:
        """The actor if it is in the scene; deleted with X it is in the file alone, kept by the take."""
        actor = self.take.armature
        return actor if actor is not None and actor.name in self.take.id_data.objects else None

    @cached_property
    def kept_actions(self) -> tuple[Action, ...]:
        """The actor's Actions: keyframes, motion and final; they outlive it."""
        actions = self.take.keyframe_action, self.take.motion_action, self.take.finish.action
        return tuple(action for action in actions if action is not None)

    @cached_property
    def has_lost_actor(self) -> bool:
        """Whether there was an actor that is gone from the scene."""
        return self.actor is None and (self.take.armature is not None or bool(self.kept_actions))

    @cached_property
    def has_keypoints(self) -> bool:
        """Whether any keypoints are followed: files, motion tracks or clicked points."""
        follow = self.take.follow
        loaded = any(entry.is_used for entry in follow.files) or len(follow.clicks)
        return bool((follow.use_keypoints and loaded) or (follow.use_tracks and assigned_tracks(self.take)))

    @cached_property
    def has_points(self) -> bool:
        return bool(self.take.follow.use_markers and len(self.take.markers)) or self.has_keypoints

    @cached_property
    def has_contours(self) -> bool:
        """Whether contours can be followed: they are switched on, and the camera stands still."""
        take = self.take
        return bool(take.follow.use_contours and take.camera is not None and not may_move(take.camera))

    @cached_property
    def lacks_colors(self) -> bool:
        return self.take.follow.use_markers and not all(each.is_picked for each in self.take.markers)

    # --- Keyframes

    @cached_property
    def keyed(self) -> KeyedFrames:
        """The scene frames of the keyframe Action."""
        take = self.take
        if take.armature is None or take.keyframe_action is None:
            return KeyedFrames()
        source = take.armature, take.keyframe_action

        def read() -> KeyedFrames:
            with suppress(InputError):  # an armature of other bones
                found, pictured = (unchanged_keyframes(*source, kind) for kind in (FOUND, PICTURED))
                return KeyedFrames(keyed_frames(*source), found, pictured)
            return KeyedFrames()

        key = f"{take.armature.session_uid} {take.keyframe_action.session_uid} {revision()}"
        return _keyed.known(key, read) or KeyedFrames()

    @cached_property
    def matched(self) -> tuple[float, ...]:
        """The scene frames that were found in the footage and not changed since, in ascending order."""
        known = {round(match.frame, 3) for match in self.take.matching.matches}
        return tuple(frame for frame in self.keyed.untouched if frame in known)

    @cached_property
    def posed(self) -> tuple[float, ...]:
        """The scene frames that the animator posed, in ascending order."""
        matched = set(self.matched)
        return tuple(frame for frame in self.keyed.all if frame not in matched)

    @property
    def sure_by_poses(self) -> bool:
        """Whether how sure the motion is follows from its poses, all of which were found."""
        return bool(self.matched) and not self.posed and bool(self.take.matching.reason)

    @property
    def confidence(self) -> float:
        """How sure the motion is, from 0 to 1; negative where nothing tells."""
        return float(self.take.matching.fit if self.sure_by_poses else self.take.review.confidence)

    def is_posed(self, frame: float) -> bool:
        """Whether the animator posed a frame; a clip's frame may lie between whole scene frames."""
        return has_frame(self.posed, frame)

    @cached_property
    def proposed(self) -> list[int]:
        """The proposed scene frames, in ascending order."""
        return sorted({proposal.frame for proposal in self.take.proposals})

    @cached_property
    def unposed(self) -> list[int]:
        keyed = {round(frame) for frame in self.keyed.all}
        return [frame for frame in self.proposed if frame not in keyed]

    def depth_is_found(self, frame: float) -> bool:
        """Whether a pose made from a frame's, or the clip's without a key there, is as deep as found."""
        found = sorted({*self.matched, *self.keyed.pictured})
        return has_frame(found if has_frame(self.keyed.all, frame) else found and [frame], frame)

    # --- Found keyframes, those that nobody posed

    def of_match(self, match: PropertyGroup) -> str:
        """What has become of a found keyframe: FOUND still, POSED by the animator, or GONE with its keys."""
        frame = round(match.frame, 3)
        return "FOUND" if frame in self.matched else "POSED" if frame in self.posed else "GONE"

    def contradictions_at(self, frame: float) -> tuple[str, ...]:
        """Names of what no plausible posture explains at a scene frame, as far as it is still followed."""
        take, follow = self.take, self.take.follow
        for entry in take.contradictions:
            if abs(entry.frame - frame) < SAME_FRAME and entry.reading == take.reading_key:
                markers = {marker.name for marker in take.markers}
                points = BODY_POINTS if follow.use_keypoints or follow.use_tracks else ()
                names = entry.names.split(SEPARATOR)
                return tuple(x for x in names if (follow.use_markers if x in markers else x in points))
        return ()

    @cached_property
    def doubtful(self) -> list[int]:
        """Places of undecided found keyframes to check: contradicted ones first, then the least sure."""
        ranks = []
        for index, match in enumerate(self.take.matching.matches):
            contradicted = bool(self.contradictions_at(match.frame))
            open_ = not match.by_hand and self.of_match(match) == "FOUND"
            if open_ and (contradicted or match.confidence < DOUBTFUL):
                ranks.append((not contradicted, match.confidence, index))
        return [index for *_, index in sorted(ranks)]

    @property
    def found_count(self) -> int:
        return sum(self.of_match(match) == "FOUND" for match in self.take.matching.matches)

    def match_at(self, frame: float) -> int:
        """Place in the list of the found keyframe at a scene frame; -1 for none."""
        apart = [abs(match.frame - frame) for match in self.take.matching.matches]
        nearest = min(range(len(apart)), key=apart.__getitem__, default=-1)
        return nearest if apart and apart[nearest] < SAME_FRAME else -1

    def offered_at(self, frame: float) -> PropertyGroup | None:
        """The poses to choose from at a scene frame that has no key; None where there are none."""
        offered = self.take.offered
        here = len(offered.candidates) > 1 and abs(offered.frame - frame) < SAME_FRAME
        return offered if here and round(frame, 3) not in self.keyed.all else None

    # --- Results

    @cached_property
    def shown_action(self) -> Action | None:
        return None if self.take.armature is None else action_of(self.take.armature)

    @cached_property
    def shows_keyframes(self) -> bool:
        """Whether the actor is animated by its keyframe Action, or by none."""
        return self.shown_action is None or self.shown_action == self.take.keyframe_action

    @cached_property
    def motion_is_outdated(self) -> bool:
        """Whether keyframes have changed since the motion was made from them."""
        take = self.take
        return take.motion_action is not None and take.made_from not in ("", digest_of(take.keyframe_action))

    @cached_property
    def final_is_outdated(self) -> bool:
        """Whether the motion has changed since the final Action was made from it."""
        final, motion = self.take.finish, self.take.motion_action
        return None not in (final.action, motion) and final.made_from != digest_of(motion)

    @cached_property
    def newest(self) -> tuple[str, Action | None]:
        """The kind and the Action of the newest motion: the final one, unless the reconstructed is newer."""
        final, motion = self.take.finish.action, self.take.motion_action
        is_final = final is not None and not self.final_is_outdated
        return ("FINAL", final) if is_final else ("MOTION", motion)

    def source_of(self, result: PropertyGroup) -> Action | None:
        """The Action that a character's result is to be made from now."""
        return result.source_action if result.source == "ACTION" else self.newest[1]

    def of_earlier(self, result: PropertyGroup) -> bool:
        """Whether the motion that a character's result was made from has changed since."""
        source = self.source_of(result)
        return None not in (result.action, source) and result.made_from != digest_of(source)

    @cached_property
    def results(self) -> list[PropertyGroup]:
        """What characters perform."""
        return [made for each in self.take.characters for made in each.results if made.action is not None]

    @cached_property
    def has_outdated_result(self) -> bool:
        return any(self.of_earlier(result) for result in self.results)

    @cached_property
    def performers(self) -> list[tuple[Object, Action]]:
        """Whose motion there is, and what it is: the active character, the others, the actor last."""
        take, found = self.take, []
        characters = list(take.characters)
        first = min(take.active_character, max(len(characters) - 1, 0))
        for each in characters[first : first + 1] + characters[:first] + characters[first + 1 :]:
            result = each.results[min(each.active_result, len(each.results) - 1)] if each.results else None
            if result is not None and result.action is not None and each.armature is not None:
                found.append((each.armature, result.action))
        if self.actor is not None and take.motion_action is not None:
            found.append((self.actor, take.finish.action or take.motion_action))
        return found

    @cached_property
    def is_outdated(self) -> bool:
        """Whether anything was made of what has changed since."""
        return self.motion_is_outdated or self.final_is_outdated or self.has_outdated_result

    @cached_property
    def open_weak(self) -> list[int]:
        """Places in the list of the weak frames that nobody has posed."""
        weak = enumerate(self.take.review.weak_frames)
        return [index for index, each in weak if not self.is_posed(each.frame)]

    # --- What is to be known, and to be done

    def notices(self, step: str) -> list[str]:
        """The sentences of a step that hold now."""
        return [
            entry.text
            for entry in self.take.notices
            if entry.step == step and (not entry.of_keyframe or has_frame(self.keyed.all, entry.frame))
        ]

    @cached_property
    def next(self) -> tuple[str, str]:
        """The step that the work has come to, and what is next, short enough for a narrow sidebar."""
        take, final = self.take, self.take.finish.action
        unsure = (final is None or self.final_is_outdated) and 0.0 <= self.confidence < DOUBTFUL
        if take.clip is None:
            found = "footage", "load the footage"
        elif take.clip_state.missing:
            found = "footage", "find the clip's file"
        elif self.placement_is_guess or take.camera is None:
            found = "footage", "say where the camera stood"
        elif self.lacks_colors:
            found = "actor", "pick the markers' colors"
        elif self.has_lost_actor:
            found = "actor", "bring the actor back"
        # Contours need nothing to be done: whoever goes on to the actor follows these alone.
        elif not self.has_points and not (self.actor is not None and self.has_contours):
            found = "actor", "choose what to follow"
        elif self.actor is None:
            found = "actor", "build the actor"
        elif not self.proposed and not self.keyed.all:
            found = "keyframes", "pose all keyframes" if self.has_points else "propose keyframes"
        elif take.motion_action is None and self.unposed and not self.matched:
            found = "keyframes", "pose all keyframes" if self.has_points else "pose the proposed frames"
        elif take.motion_action is None and len(self.keyed.all) < 2:
            found = "keyframes", "pose and store keyframes"
        elif take.motion_action is None:
            found = "keyframes", "check the doubtful poses" if self.doubtful else "reconstruct the motion"
        elif self.motion_is_outdated:
            found = "keyframes", "correct more, or update"
        elif unsure and self.doubtful:
            found = "reconstruct", "check the doubtful poses"
        elif unsure and self.open_weak:
            found = "reconstruct", "pose the weak frames"
        elif unsure:
            again = len(take.review.weak_frames)
            found = "reconstruct", "reconstruct again" if again else "pose more keyframes"
        elif self.final_is_outdated:
            found = "reconstruct", "review, then bake again"
        elif self.has_outdated_result:
            found = "reconstruct", "retarget again"
        elif self.results:
            found = "character", "export, or another take"
        elif final is not None:
            found = "character", "a character, or export"
        else:
            found = "reconstruct", "review, then a character"
        return found
