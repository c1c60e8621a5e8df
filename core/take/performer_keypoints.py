"""The performer's keypoints: of all people seen in a take, those of the one whom the keyframes show.

Where the performer is, a person says by clicks or Blender's tracks, else the keyframes, and the markers
between them. A take with none of these has the keypoints of whoever is largest and there longest.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array, IndexArray
from ..body.mirror import other_side
from ..body.posture import Posture
from ..detect.keypoints import FACE, Keypoints, People, SeenPeople, no_face, no_hands
from ..detect.performer import Expected, Sightings, choose_performer, person_size, same_person
from ..errors import InputError, pluralize
from ..markers.region_tracks import RegionTracks
from ..numerics.markov_chain import NOBODY
from ..prior.frame_prior import SPEED_M_PER_S
from ..prior.keyframes import interpolate
from .take import Take

MIDDLES = {"neck": ("shoulder.L", "shoulder.R"), "pelvis": ("hip.L", "hip.R")}
"""Points that lie about in the middle of two joints."""
POSED_STD_M = 0.1
"""Of a point at a posed keyframe, by detector and person together."""
FARTHEST_STD_M = 1.5
"""Far from every keyframe, in a stage's width."""
MARKER_STD, HAND_STD = 0.15, 0.1
"""Of a marker's center from the middle of its segment, and of a click, as shares of a person's size."""
POSED_WEIGHT, HAND_WEIGHT, NAMED_WEIGHT = 3.0, 5.0, 10.0
"""Of the frames in which a person has said where the performer is; all others count once."""
FEWEST_KEYFRAMES, FEWEST_FITTING = 3, 0.5
"""Posed keyframes that can tell of a whole source, and their share that must show a person who fits."""
TRUNK_ENDS = ("shoulder.L", "shoulder.R", "hip.L", "hip.R")
ENDS = {
    "upper_arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "thigh": ("hip", "knee"),
    "shin": ("knee", "ankle"),
    "hand": ("wrist",),
    "foot": ("ankle",),
}
"""Points whose middle lies about in that of a segment."""


def performer_keypoints(take: Take, tracks: RegionTracks | None = None) -> Keypoints:
    """The keypoints of the performer from all sources, side by side; its notes say who was taken, and why.

    Posed keyframes tell where the performer is: two or more in all frames, a single one in its own. What was
    found does not, which was found by these very keypoints. `tracks`: the markers' regions, where the clip
    has been read.
    """
    frames = take.frame_count or max((len(people.frames) for people in take.keypoints), default=0)
    frames = frames if tracks is None else tracks.frame_count
    take = replace(take, keyframes=tuple(k for k in take.keyframes if k.matched is None and k.index < frames))
    hand = [people for people in take.keypoints if people.by_hand]
    vouched = take.keyframes or hand or (tracks is not None and tracks.visible.any())
    parts = []
    voices = ["the clicked or tracked points"] if hand else []
    voices += ["the keyframes"] if take.keyframes else []
    voices += ["the markers"] if not voices and tracks is not None and take.markers else []
    for people in take.keypoints:
        chosen, notes = np.zeros(frames, dtype=np.intp), people.notes
        if not vouched and people.most_people == 1:
            people, jumped = _of_same_person(people, chosen, take.fps)
            notes += jumped
        if not people.by_hand:
            seen = _with_middles(people, take, tracks, frames)
            expected = _expected(take, tracks, hand, people.names, seen, frames)
            if expected is not None or people.most_people > 1:
                chosen = choose_performer(seen, expected, take.fps)
                fits = [  # of posed keyframes that show people, whether one of them is the performer
                    chosen[key.index] != NOBODY
                    for key in take.keyframes
                    if key.index < len(people.frames) and len(people.frames[key.index].pixel)
                ]
                if len(fits) >= FEWEST_KEYFRAMES and float(np.mean(fits)) < FEWEST_FITTING:
                    chosen = np.full(frames, NOBODY, dtype=np.intp)
                    notes += (
                        f"{people.source}: nobody in it is where most of the posed keyframes have the "
                        "performer, so it is left out; it must be of this clip",
                    )
                else:
                    notes += _notes(people, chosen, voices)
            if not vouched and people.most_people > 1:
                people, jumped = _of_same_person(people, chosen, take.fps)
                notes += jumped
        parts.append(_of_one(people, chosen, notes, frames))
    return Keypoints.side_by_side(parts, frames)


def people_of(people: People, number: int, fps: float) -> People:
    """The people without all but one, counted from 1 at the left where most are seen for the first time.

    Raises:
        InputError: There are fewer.
    """
    most = people.most_people
    if people.by_hand:
        return people
    if number > most:
        raise InputError(
            f"performer is {number}; {people.source} sees at most {pluralize(most, 'person', 'people')}"
        )
    at = next(index for index, frame in enumerate(people.frames) if len(frame.pixel) == most)
    seen = people.frames[at].pixel
    across = np.array([np.nanmean(one[..., 0]) if np.isfinite(one).any() else np.inf for one in seen])
    row = int(np.argsort(across, kind="stable")[number - 1])
    pixel = np.full((len(people.frames), len(people.names), 2), np.nan)
    pixel[at] = seen[row]
    std_px = np.full(pixel.shape[:2], HAND_STD * float(person_size(seen[row])))
    weight = np.where(np.arange(len(pixel)) == at, NAMED_WEIGHT, 1.0)
    sightings = Sightings(
        tuple(frame.pixel for frame in people.frames), tuple(frame.score for frame in people.frames)
    )
    chosen = choose_performer(sightings, Expected(pixel, std_px, weight), fps)
    frames = tuple(
        SeenPeople.nobody(len(people.names)) if row == NOBODY else frame.only([int(row)])
        for frame, row in zip(people.frames, chosen, strict=True)
    )
    return replace(people, frames=frames)


def _of_one(people: People, chosen: IndexArray, notes: tuple[str, ...], frames: int) -> Keypoints:
    pixel = np.full((frames, len(people.names), 2), np.nan)
    score, hint = np.zeros(pixel.shape[:2]), np.full((*pixel.shape[:2], 3), np.nan)
    face, hands = (np.stack([none()] * frames) for none in (no_face, no_hands))
    for index, seen in enumerate(people.frames[:frames]):
        row = chosen[index]
        if row != NOBODY and len(seen.pixel):
            pixel[index], score[index], hint[index] = seen.pixel[row], seen.score[row], seen.hint_m[row]
            face[index], hands[index] = seen.face[row], seen.hands[row]
    beside = {}
    if people.second is not None and not np.isfinite(hint[:, -len(people.second.names) :]).any():
        beside = {people.second.detector: people.source}
    return Keypoints(people.names, people.sources, pixel, score, hint, notes, face, hands, beside)


def _with_middles(people: People, take: Take, tracks: RegionTracks | None, frames: int) -> Sightings:
    """Everyone's points, and the middle of each marker's segment behind them."""
    names, empty = people.names, np.zeros((0, len(people.names)))
    segments = take.marker_segments if tracks is not None else ()
    middles = [_middle_of(segment, names) for segment in segments]
    pixels, scores = [], []
    for index in range(frames):
        there = index < len(people.frames)
        pixel = people.frames[index].pixel if there else np.zeros((*empty.shape, 2))
        score = people.frames[index].score if there else empty
        ends = [
            pixel[:, middle].mean(axis=1) if middle else np.full((len(pixel), 2), np.nan)
            for middle in middles
        ]
        trust = [score[:, middle].mean(axis=1) if middle else np.zeros(len(pixel)) for middle in middles]
        pixels.append(np.concatenate([pixel, *(end[:, None] for end in ends)], axis=1))
        scores.append(np.concatenate([score, *(one[:, None] for one in trust)], axis=1))
    return Sightings(tuple(pixels), tuple(scores))


def _middle_of(segment: str, names: tuple[str, ...]) -> list[int]:
    """Numbers of the points about the middle of a segment; none where one is not among the names."""
    stem, _, side = segment.partition(".")
    wanted = tuple(f"{end}.{side}" for end in ENDS[stem]) if stem in ENDS else TRUNK_ENDS
    if stem == "head":
        wanted = tuple(name for name in ("head", "ear.L", "ear.R") if name in names) or ("nose",)
    return [names.index(name) for name in wanted] if set(wanted) <= set(names) else []


def _expected(
    take: Take,
    tracks: RegionTracks | None,
    hand: list[People],
    names: tuple[str, ...],
    seen: Sightings,
    frames: int,
) -> Expected | None:
    """Where the performer's points, and behind them the markers, are expected; None if nothing is known."""
    sizes = [float(size) for pixel in seen.pixel for size in person_size(pixel)]
    size_px = float(np.median(sizes)) if sizes else 1.0
    markers = len(take.marker_segments) if tracks is not None else 0
    pixel = np.full((frames, len(names) + markers, 2), np.nan)
    std_px = np.full(pixel.shape[:2], 1.0)
    weight = np.ones(frames)
    if take.keyframes:
        weight[list(take.keyframe_indices)] = POSED_WEIGHT
        place, deviation_px, at = _from_keyframes(take, names, frames)
        pixel[at, : len(names)], std_px[at, : len(names)] = place, deviation_px
    if tracks is not None and markers:
        pixel[:, len(names) :], std_px[:, len(names) :] = tracks.centroid[:frames], MARKER_STD * size_px
    for people in hand:
        for index, frame in enumerate(people.frames[:frames]):
            if not len(frame.pixel):
                continue
            for number, name in enumerate(people.names):
                if name in names and np.isfinite(frame.pixel[0, number]).all():
                    pixel[index, names.index(name)] = frame.pixel[0, number]
                    std_px[index, names.index(name)] = HAND_STD * size_px
                    weight[index] = HAND_WEIGHT
    return Expected(pixel, std_px, weight) if np.isfinite(pixel).any() else None


def _from_keyframes(take: Take, names: tuple[str, ...], frames: int) -> tuple[Array, Array, IndexArray]:
    """(G, N, 2) pixels of the body's points, NaN for others, (G, N) their deviations [px], and (G,) frames.

    They are those of postures between the keyframes in all frames, or of the only keyframe in its own.
    """
    keyed = np.array(take.keyframe_indices, dtype=np.intp)
    index = keyed if len(keyed) < 2 else np.arange(frames)
    posture = Posture.stack([key.posture for key in take.keyframes])
    posture = posture if len(keyed) < 2 else interpolate(take.keyframes, frames)
    body, joints = take.body, take.body.skeleton.point_names
    points = body.points(body.pose(posture))  # (G, 13, 3)
    place = np.full((len(index), len(names), 3), np.nan)
    for number, name in enumerate(names):
        ends = MIDDLES.get(name, ("head",) if name in (*FACE, "crown") else (name,))
        if set(ends) <= set(joints):
            place[:, number] = points[:, [joints.index(end) for end in ends]].mean(axis=1)
    pixel, depth = take.camera.project(place, index[:, None])
    away_s = np.abs(index[:, None] - keyed) / take.fps
    std_m = np.minimum(POSED_STD_M + SPEED_M_PER_S * away_s.min(axis=1), FARTHEST_STD_M)
    return pixel, std_m[:, None] * take.camera.focal_px / np.where(depth > 0.0, depth, 1.0), index


def _of_same_person(people: People, chosen: IndexArray, fps: float) -> tuple[People, tuple[str, ...]]:
    """The people without frames in which those chosen are somebody else than in most, and a note on them."""
    path = _of_one(people, chosen, (), len(chosen)).pixel
    jumped = np.flatnonzero(np.isfinite(path).any(axis=(1, 2)) & ~same_person(path, fps, people.looked))
    if not len(jumped):
        return people, ()
    frames = list(people.frames)
    for index in jumped:
        frames[index] = SeenPeople.nobody(len(people.names))
    note = (
        f"{people.source}: jumps to somebody else, farther than a person moves from one frame to the next; "
        f"the {'frame that shows' if len(jumped) == 1 else f'{len(jumped)} frames that show'} him "
        f"{'is' if len(jumped) == 1 else 'are'} left out"
    )
    return replace(people, frames=tuple(frames)), (note,)


ALIKE = 0.06
"""Median distance of the points of two bodies that move as one, after shift and size, in sizes of a body."""
FEWEST_ALIKE = 10  # frames in which that is seen


def _copies(people: People, chosen: IndexArray) -> str:
    """That the performer is there twice, as in a split screen, and which one is taken; else nothing."""
    both = [index for index, frame in enumerate(people.frames[: len(chosen)]) if len(frame.pixel) == 2]
    both = [index for index in both if chosen[index] != NOBODY]
    if len(both) < FEWEST_ALIKE:
        return ""
    sides = [people.names.index(other_side(name)) for name in people.names]
    own = np.stack([people.frames[index].pixel[chosen[index]] for index in both])
    copy = np.stack([people.frames[index].pixel[1 - chosen[index]] for index in both])
    which = "right" if np.nanmedian(own[..., 0]) > np.nanmedian(copy[..., 0]) else "left"
    first = _centered(own)
    moving = float(np.nanmedian(np.linalg.norm(first - np.nanmedian(first, axis=0), axis=-1)))
    words = {"copies": copy, "mirrored copies": copy[:, sides] * [-1.0, 1.0]}
    apart = {
        each: float(np.nanmedian(np.linalg.norm(first - _centered(other), axis=-1)))
        for each, other in words.items()
    }
    nearest = min(apart, key=lambda each: apart[each])
    if not apart[nearest] < min(ALIKE, 0.5 * moving):
        return ""
    return f", {nearest} of each other, of whom the one on the {which} is taken"


def _centered(pixel: Array) -> Array:
    """Points (F, N, 2) about their middle, in median sizes of the person."""
    there = pixel - np.nanmean(pixel, axis=1, keepdims=True)
    return np.asarray(there / np.median(person_size(pixel)))


def _notes(people: People, chosen: IndexArray, voices: list[str]) -> tuple[str, ...]:
    """Sentences on who of several people was taken, by what says which of them the performer is."""
    why = (
        f"the performer is the one that {' and '.join(voices)} show"
        if voices
        else "the performer is taken to be the largest who is there longest; click on another, or name one "
        "with --performer, counted from the left, to change it"
    )
    counts = np.array([len(frame.pixel) for frame in people.frames[: len(chosen)]])
    several = int((counts > 1).sum())
    left_out = int(((counts > 0) & (chosen[: len(counts)] == NOBODY)).sum())
    notes = []
    if several:
        who = f"up to {people.most_people} people in {pluralize(several, 'frame')}"
        notes.append(f"{people.source}: {who}{_copies(people, chosen)}; {why}")
    if left_out:
        notes.append(
            f"{people.source}: {left_out} of {int((counts > 0).sum())} frames with people "
            f"{'shows' if left_out == 1 else 'show'} somebody else than the performer and "
            f"{'is' if left_out == 1 else 'are'} left out"
        )
    return tuple(notes)
