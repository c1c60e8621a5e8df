"""A take as its footage shows it: the shot that is animated, when the performer is there, limbs never seen.

He is there where a marker or a keypoint of him is seen. Short gaps are bridged. Where a person has posed on
both sides of a gap, or inside it, the pictures decide: a detector may have failed there.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import LIMBS, limb_of
from ..body.skeleton import SIDES
from ..detect.keypoints import Keypoints, SeenPeople
from ..errors import MOST_NAMED, InputError, frames_in_words
from ..files.fields import listed
from ..markers.reading import Reading, without_tracks
from ..markers.region_tracks import RegionTracks
from ..numerics.vectors import runs, usual_step
from ..video.album import Album, changed_pixels
from .performer_keypoints import performer_keypoints
from .reference import seen_reference
from .take import Take


def shot_of(take: Take, reading: Reading, named: tuple[int, int] | None = None) -> tuple[int, int] | None:
    """First frame of the shot that is animated and the one after its last; None where the clip is not cut.

    It is the one that is `named` by its first and last frame, or that is posed, else the one in which
    somebody is seen longest. Who has posed several says that they are one: None, too.

    Raises:
        InputError: The named frames are not those of the clip.
    """
    count, cuts, start = reading.tracks.frame_count, reading.frame_findings.cuts, take.frame_start
    if named is not None:
        first, last = named[0] - start, named[1] - start
        if not 0 <= first < last < count:
            raise InputError(
                f"frames {named[0]} to {named[1]} are not all in {take.clip.name}, whose frames are {start} "
                f"to {start + count - 1}"
            )
        return first, last + 1
    if not cuts:
        return None
    shots = [*pairwise([0, *cuts, count])]
    posed = [key.index for key in take.keyframes if key.matched is None]
    if posed:
        holding = [shot for shot in shots if any(shot[0] <= index < shot[1] for index in posed)]
        return holding[0] if len(holding) == 1 else None
    seen = reading.tracks.visible.any(axis=1)
    for people in take.keypoints:
        there = [len(frame.pixel) > 0 for frame in people.frames[:count]]
        seen[: len(there)] |= there
    return max(shots, key=lambda shot: (int(seen[slice(*shot)].sum()), shot[1] - shot[0]))


def of_one_shot(take: Take, reading: Reading, named: tuple[int, int] | None = None) -> tuple[Take, Reading]:
    """The take and its reading with nothing seen but in the shot that is animated, and a sentence on it."""
    shot, findings = shot_of(take, reading, named), reading.frame_findings
    if shot is None:
        return take, reading
    first, last = shot
    others = [*range(first), *range(last, reading.tracks.frame_count)]
    keypoints = []
    for people in take.keypoints:
        nobody = SeenPeople.nobody(len(people.names))
        frames = tuple(seen if first <= index < last else nobody for index, seen in enumerate(people.frames))
        keypoints.append(replace(people, frames=frames))
    start = take.frame_start
    cut = findings.cut_note(start) if findings.cuts else ""
    whose = f"the motion is that of frames {first + start} to {last - 1 + start} and empty elsewhere"
    animated = f"{cut}; {whose}: --frames names another shot" if named is None else whose
    if named is not None and (inside := tuple(index for index in findings.cuts if first < index < last)):
        within = replace(findings, cuts=inside).cut_note(start)
        animated = f"{whose}, but {within}, within them: the motion jumps there; name one shot by --frames"
    own = replace(
        reading,
        tracks=without_tracks(reading.tracks, others),
        album=None if reading.album is None else reading.album.excluding(others),
        glimpses=None if reading.glimpses is None else reading.glimpses.excluding(others),
        notes=(animated, *(note for note in reading.notes if note != cut)),
        shot=shot,
    )
    posed = tuple(key for key in take.keyframes if first <= key.index < last)
    return replace(take, keypoints=tuple(keypoints), keyframes=posed), own


def within_shot(reading: Reading) -> BoolArray:
    """(F,) whether each frame is one of the shot that is animated."""
    within = np.zeros(reading.tracks.frame_count, dtype=np.bool_)
    within[slice(*(reading.shot or (0, None)))] = True
    return within


BRIDGED_S = 0.5
"""Longest gap in which the motion goes on: about a step, after which nothing tells any more where he went."""
LATE_S = 0.1
"""Frames that a detector needs at either end of a clip to find somebody, or to lose him."""
LOOKS = 5
"""Frames in which he is seen that a picture without evidence is compared with."""
AROUND = 0.3
"""Margin around what is seen of him, in its larger side: hands, feet and hair beyond markers and joints."""
ELSEWHERE = 0.25
"""Change of the picture outside of where he was, relative to that inside, from which he may be elsewhere."""
LEAST_SCORE = 0.05
"""Of a keypoint that counts: what detectors that always answer say of an empty picture."""
SELDOM = 0.05
"""Share of frames below which a limb is seldom seen: detectors take other things for one now and then."""
HARDLY = 0.1
"""Share of frames up to which a wrist or ankle is named as hardly ever seen; it may still tell the floor."""


def presence(take: Take, reading: Reading, keypoints: Keypoints) -> BoolArray:
    """(F,) whether the performer is there; everywhere where nothing but contours would tell.

    `keypoints` are the performer's. Without a picture to ask, frames between posed keyframes count.
    """
    tracks = reading.tracks
    sure = keypoints.seen & (keypoints.score > LEAST_SCORE)
    seen = tracks.visible.any(axis=1) | sure.any(axis=1)
    there = within_shot(reading)
    if not seen.any():
        return there
    posed = np.array([key.index for key in take.keyframes if key.matched is None], dtype=np.intp)
    frames = np.arange(tracks.frame_count)
    vouched = np.zeros_like(there)
    if len(posed):
        vouched = (frames >= posed.min()) & (frames <= posed.max())
    step_s = usual_step(tracks.time_s)
    silent = {index for people in take.keypoints for index in people.silent}
    for first, last in runs(~seen):
        at_end = first == 0 or last == tracks.frame_count
        if (last - first) * step_s <= (LATE_S if at_end else BRIDGED_S):
            continue
        if (last - first) * step_s <= BRIDGED_S and silent.issuperset(range(first, last)):
            continue
        own = slice(first, last)
        if not vouched[own].any():
            there[own] = False
        elif reading.album is not None and is_empty(reading.album, tracks, keypoints, (first, last)):
            there[own] = False
        else:
            there[own] = vouched[own]
    return there


def unseen_limbs(take: Take, tracks: RegionTracks, keypoints: Keypoints, there: BoolArray) -> tuple[str, ...]:
    """Limbs, as in `LIMBS`, that keypoints seldom show though they show the performer, and no marker covers.

    Where anything is posed a person says what is not seen; there are none then. `there` (F,) as `presence`.
    """
    if not keypoints.names or any(key.matched is None for key in take.keyframes):
        return ()
    names = (*take.marker_segments, *keypoints.names)
    seen = np.concatenate([tracks.visible, keypoints.seen & (keypoints.score > LEAST_SCORE)], axis=1)[there]
    own = {limb: [column for column, name in enumerate(names) if limb_of(name) == limb] for limb in LIMBS}
    return tuple(limb for limb in LIMBS if seen[:, own[limb]].any(axis=1).mean() < SELDOM)


def unseen_ends(
    keypoints: Keypoints, there: BoolArray, unseen: tuple[str, ...], share: float = HARDLY
) -> tuple[str, ...]:
    """Hands and feet whose wrist or ankle is seen in at most a share, of limbs that are not all `unseen`."""
    seen, names = (keypoints.seen & (keypoints.score > LEAST_SCORE))[there], np.array(keypoints.names)
    found = []
    for end, joint, limb in (("hand", "wrist", "arm"), ("foot", "ankle", "leg")):
        for side in SIDES:
            own = names == f"{joint}.{side}"
            if own.any() and f"{limb}.{side}" not in unseen and seen[:, own].any(axis=1).mean() <= share:
                found.append(f"{end}.{side}")
    return tuple(found)


def is_empty(album: Album, tracks: RegionTracks, keypoints: Keypoints, run: tuple[int, int]) -> bool:
    """Whether the pictures of a run of frames without evidence show nobody.

    Beside pictures in which he is seen they have changed where he was, and nowhere else. A picture that
    changes everywhere, as before a camera that moves, tells nothing.
    """
    places = np.concatenate([tracks.centroid, keypoints.pixel], axis=1)
    seen = np.flatnonzero(np.isfinite(places[..., 0]).any(axis=1))
    nearest = seen[np.argsort(np.minimum(abs(seen - run[0]), abs(seen - run[1])), kind="stable")]
    some = [int(frame) for frame in _spread(nearest, LOOKS) if int(frame) in album]
    doubtful = [int(frame) for frame in _spread(np.arange(*run), LOOKS) if int(frame) in album]
    outside = [_changed_elsewhere(album, places[there], there, empty) for there in some for empty in doubtful]
    return bool(outside) and float(np.median(outside)) < ELSEWHERE


def _spread(frames: IndexArray, most: int) -> IndexArray:
    return frames[np.unique(np.linspace(0, len(frames) - 1, min(most, len(frames))).astype(np.intp))]


def _changed_elsewhere(album: Album, places: Array, seen: int, empty: int) -> float:
    """Energy of two pictures' change that lies outside of where he is seen, relative to that inside."""
    one, other = (cv2.cvtColor(album.picture(frame), cv2.COLOR_BGR2GRAY) for frame in (seen, empty))
    difference = one.astype(np.float64) - other
    changed = np.where(changed_pixels(difference), difference**2, 0.0)  # squared, shadows hardly count
    known = places[np.isfinite(places).all(axis=-1)] / album.factor
    low, high = known.min(axis=0), known.max(axis=0)
    margin = AROUND * float((high - low).max())
    left, top = np.maximum(np.floor(low - margin), 0).astype(int)
    right, bottom = np.ceil(high + margin).astype(int)
    inside = float(changed[top:bottom, left:right].sum())
    return float(changed.sum() - inside) / inside if inside else np.inf


def absence_notes(take: Take, there: BoolArray, shot: BoolArray | None = None) -> tuple[str, ...]:
    """Notes on frames in which the performer is not there, and on keyframes posed in them.

    `shot` (F,): the frames of the only shot that is animated; nothing is said of others.
    """
    there = there if shot is None else there | ~shot
    if there.all():
        return ()
    named = frames_in_words(np.flatnonzero(~there) + take.frame_start, MOST_NAMED)
    count = len(runs(there))
    what = "the motion is left empty there" + (f" and has {count} stretches" if count > 1 else "")
    notes = [f"nobody is seen in {named}: {what}"]
    lost = [k.index + take.frame_start for k in take.keyframes if k.matched is None and not there[k.index]]
    if lost:
        which = listed([str(frame) for frame in lost], MOST_NAMED)
        what = f"keyframe {which} is" if len(lost) == 1 else f"keyframes {which} are"
        notes.append(f"{what} posed where the picture shows nobody, and left aside; pose where he is seen")
    return tuple(notes)


def unseen_notes(limbs: tuple[str, ...], ends: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Notes on limbs that are never seen, and on hands and feet of which the same is so (`unseen_ends`)."""
    notes = []
    if limbs:
        stay = "stays" if len(limbs) == 1 else "stay"
        notes.append(
            f"{named_limbs(limbs)} never seen and {stay} at rest; pose keyframes where that is wrong"
        )
    if ends:
        is_one = len(ends) == 1
        notes.append(
            f"{named_limbs(ends)} hardly ever seen, as beyond the picture's edge, and "
            f"where {'it is' if is_one else 'they are'} likely to be; pose keyframes where that is wrong"
        )
    return tuple(notes)


def unseen_line(empty: int, limbs: tuple[str, ...]) -> str:
    """The same in one line, for a motion with so many empty frames; empty where nothing is missing."""
    frames = "1 frame" if empty == 1 else f"{empty} frames"
    parts = [f"nobody is seen in {frames}"] * bool(empty)
    parts += [f"{named_limbs(limbs)} never seen"] * bool(limbs)
    return ", ".join(parts)


def named_limbs(limbs: tuple[str, ...]) -> str:
    """Some limbs as the beginning of a sentence, with its verb: `the legs are`."""
    every = ("arm", "leg", "hand", "foot")
    kinds = {kind: [limb for limb in limbs if limb.startswith(kind)] for kind in every}
    sides = {"L": "left", "R": "right"}
    words = [
        f"the {'feet' if kind == 'foot' else f'{kind}s'}"
        if len(own) == 2
        else f"the {sides[own[0][-1]]} {kind}"
        for kind, own in kinds.items()
        if own
    ]
    are = "is" if len(limbs) == 1 else "are"
    return f"{' and '.join(words)} {are}"


@dataclass(frozen=True, eq=False)
class SeenTake:
    """A take, the reading of its clip, and the performer in it."""

    take: Take
    """With its keypoints as the pictures say they are meant, seen as by a camera that stands still."""
    reading: Reading
    """As that camera sees the clip."""
    keypoints: Keypoints
    """The performer's."""
    there: BoolArray
    """(F,) frames in which the performer is there."""
    unseen: tuple[str, ...]
    """Limbs that are never seen."""
    unseen_ends: tuple[str, ...] = ()
    """Hands and feet of the same, of limbs that are seen; none where markers or poses tell of them."""
    camera_notes: tuple[str, ...] = ()
    """A sentence on a camera that moves and is not followed."""

    @property
    def feet_seen(self) -> tuple[bool, bool]:
        """Whether the left and the right foot are ever seen: those that are not tell no floor."""
        seldom = unseen_ends(self.keypoints, self.there, self.unseen, SELDOM)
        unseen = {*self.unseen, *(end for end in seldom if end in self.unseen_ends)}
        left, right = (not unseen & {f"leg.{side}", f"foot.{side}"} for side in SIDES)
        return left, right


def seen_take(take: Take, reading: Reading, camera_notes: tuple[str, ...] = ()) -> SeenTake:
    """Tell the performer from everybody else, and when which of his limbs are seen."""
    keypoints = performer_keypoints(take, reading.tracks)
    reference, keypoints = seen_reference(keypoints, take.keypoints)
    take = replace(take, reference=take.reference or reference)
    there = presence(take, reading, keypoints)
    unseen = unseen_limbs(take, reading.tracks, keypoints, there)
    is_told = take.markers or any(key.is_posed for key in take.keyframes)
    ends = () if is_told else unseen_ends(keypoints, there, unseen)
    return SeenTake(take, reading, keypoints, there, unseen, ends, camera_notes)
