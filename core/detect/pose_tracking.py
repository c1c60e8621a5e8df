"""Everyone in a clip, found by the landmark network and followed from picture to picture.

The clip is decoded once, a stretch at a time. People are looked for at the end of every stretch, by crops of
several sizes and places; from there they are followed backward until they are lost or met, and forward into
the next stretches. Who of them is the performer is chosen later, as among any detector's people
(`keypoints/performer`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import cv2
import numpy as np

from ..arrays import Image
from ..errors import InputError
from ..progress import Job, Progress
from ..video.clip import Clip
from .closer_look import CloserLook
from .face import no_faces, scaled_faces
from .keypoints import People, SeenPeople
from .pose_network import LAYOUT, NAME, Crop, Pose, PoseNetwork

DETECTING = "Detecting keypoints"
STRETCH = 60  # pictures kept at a time, 170 MB
LOOKS_A_SECOND = 30.0  # the usual rate of video, from which on pictures are left out
LARGEST_SIDE_PX = 1280  # pictures are made as small; the network sees 256 pixels of a person
HEIGHTS = (1.15, 0.75, 0.5, 0.33)  # sides of the crops that are looked into, by the height of the picture
SIZES = (0.75,)  # the same by the largest person who is followed already
STEP = 0.5  # between crops, by their side
APART = 0.3  # share of a crop's side within which two crops show the same person
MOST_OTHER = 1.6  # ratio of sizes beyond which a later person is another
OVERLOOKED = 0.1  # shift, turn and growth of a crop for which the network's training makes up
SMALLEST = 0.35  # others are followed from this share of the largest one's size on


@dataclass(frozen=True, eq=False)
class _Sighting:
    """A person in one frame."""

    track: int  # number of the person, a new one where somebody was lost in between
    pose: Pose


def find_people(clip: Clip, network: PoseNetwork, closer: CloserLook | None = None) -> Job[People]:
    """Find everyone in a clip; where it has many pictures a second, those between the looked at have nobody.

    `closer` sees heads and hands too.

    Raises:
        InputError: It is a picture, has no frames, or nobody is in it.
    """
    refuse_picture(clip)
    scale = min(1.0, LARGEST_SIDE_PX / max(clip.size))
    every = max(1, round(clip.fps / LOOKS_A_SECOND))
    tracking = _Tracking(network)
    seen: list[list[_Sighting]] = []
    count = 0
    yield Progress(DETECTING, 0.0)
    for pictures, count in _stretches(clip, scale, every):  # noqa: B007 - the last count is the clip's
        for done in tracking.follow(pictures):
            yield Progress(DETECTING, min(every * (len(seen) + done) / clip.frame_count, 1.0))
        seen += tracking.seen if closer is None else _looked_at(closer, pictures, tracking.seen)
    if not seen:
        raise InputError(f"{clip.path}: holds no frame that can be decoded; it must be a video or images")
    kept = _believed(seen)
    if not any(kept):
        raise InputError(
            f"{clip.path}: nobody is seen in any of its {count} frames; it must show a person, at "
            "least from the head to the hips and not too small"
        )
    frames = [SeenPeople.nobody(len(LAYOUT.names))] * count
    frames[::every] = [_people(frame, clip.size, scale) for frame in kept]
    return People(LAYOUT.names, NAME, clip.size, tuple(frames))


def _looked_at(
    closer: CloserLook, pictures: Sequence[Image], seen: Sequence[Sequence[_Sighting]]
) -> list[list[_Sighting]]:
    """The same people with their heads and hands."""
    poses = iter(
        closer([(picture, one.pose) for picture, frame in zip(pictures, seen, strict=True) for one in frame])
    )
    return [[_Sighting(one.track, next(poses)) for one in frame] for frame in seen]


def refuse_picture(clip: Clip) -> None:
    """Refuse a single picture in place of a clip."""
    if clip.frame_count == 1:
        raise InputError(
            f"{clip.path}: is a single picture; it must be a video, or a folder of the pictures of one"
        )


def _stretches(clip: Clip, scale: float, every: int) -> Iterator[tuple[list[Image], int]]:
    """Stretches of every so manieth picture, with the number of frames up to the end of each."""
    pictures: list[Image] = []
    count = 0
    for index, _, picture in clip.frames():
        count = index + 1
        if index % every:
            continue
        if len(pictures) == STRETCH:
            yield pictures, index
            pictures = []
        if scale < 1.0:
            size = (round(scale * clip.size[0]), round(scale * clip.size[1]))
            way = (
                cv2.INTER_LINEAR if scale > 0.5 else cv2.INTER_AREA
            )  # as exact there, in a third of the time
            picture = np.asarray(cv2.resize(picture, size, interpolation=way), dtype=np.uint8)
        pictures.append(picture)
    if pictures:
        yield pictures, count


class _Tracking:
    """Whom the pictures of one stretch after another show."""

    def __init__(self, network: PoseNetwork) -> None:
        self._network = network
        self._tracks = 0
        self.seen: list[list[_Sighting]] = []
        """Of each picture of the last stretch."""

    def follow(self, pictures: Sequence[Image]) -> Iterator[int]:
        """Follow everyone through the next stretch; yields the number of pictures that are done."""
        before, self.seen = self.seen, [[] for _ in pictures]
        if before:
            yield from self._go(pictures, before[-1], range(len(pictures)))
        else:
            yield from self._look(pictures, 0)
        last = len(pictures) - 1
        yield from self._look(pictures, last)
        if not any(self.seen):
            yield from self._look(pictures, last // 2)

    def _look(self, pictures: Sequence[Image], index: int) -> Iterator[int]:
        """Look for new people in a picture, and follow them both ways."""
        known = [one.pose for one in self.seen[index]]
        poses = _scan(self._network, pictures[index], known)
        new = [_Sighting(track, pose) for track, pose in enumerate(poses, self._tracks)]
        self._tracks += len(new)
        self.seen[index] += new
        yield from self._go(pictures, new, range(index - 1, -1, -1))
        yield from self._go(pictures, new, range(index + 1, len(pictures)))

    def _go(self, pictures: Sequence[Image], people: Sequence[_Sighting], way: range) -> Iterator[int]:
        """Follow people until they are lost, or met by others who are followed already.

        Two pictures are looked at at once, in the same crops; the second anew where somebody has left theirs.
        """
        for pair in (way[at : at + 2] for at in range(0, len(way), 2)):
            if not people:
                return
            crops = {one.track: one.pose.crop for one in people}
            looks_at = [(index, one.track) for index in pair for one in people]
            looks = self._network.each([(pictures[index], crops[track]) for index, track in looks_at])
            poses = dict(zip(looks_at, looks, strict=True))
            for index in pair:
                now = []
                for one in people:
                    pose = poses[index, one.track]
                    if not _is_near(one.pose.crop, crops[one.track]):
                        pose = self._network(pictures[index], one.pose.crop)
                    known = [other.pose for other in self.seen[index]]
                    if _is_followed(one.pose, pose, pictures[index]) and not _is_among(pose, known):
                        now.append(_Sighting(one.track, pose))
                        self.seen[index].append(now[-1])
                people = now
                yield sum(map(bool, self.seen))


def _is_near(crop: Crop, other: Crop) -> bool:
    """Whether the network sees the same in two crops, but for what it has learned to overlook."""
    turned = abs(np.angle(np.exp(1j * (crop.angle - other.angle))))
    moved = np.hypot(*(crop.center - other.center)) / other.side
    return bool(max(moved, turned, abs(crop.side / other.side - 1.0)) < OVERLOOKED)


def _is_followed(before: Pose, now: Pose, picture: Image) -> bool:
    """Whether a person is the one of the picture before, and not lost."""
    moved = np.hypot(*(now.crop.center - before.crop.center)) / before.crop.side
    grown = max(now.crop.side / before.crop.side, before.crop.side / max(now.crop.side, 1.0))
    lost = now.presence < 0.5 or now.score.mean() < 0.3 or moved > 0.35 or grown > 1.5
    return not lost and _is_inside(now, picture)


def _settled(network: PoseNetwork, picture: Image, crops: Sequence[Crop]) -> list[Pose]:
    """Whom crops show for sure, once these have moved to them; the surest first."""
    poses = network.each([(picture, crop) for crop in crops])
    poses = _distinct([pose for pose in poses if pose.presence > 0.3])
    for _ in range(2):  # somebody may be there, in another place of the crop
        poses = _distinct(network.each([(picture, pose.crop) for pose in poses]))
    return [
        pose
        for pose in poses
        if pose.presence > 0.9 and pose.score.mean() > 0.5 and _is_inside(pose, picture)
    ]


def _distinct(poses: Sequence[Pose]) -> list[Pose]:
    """Each person once, the surest first."""
    found: list[Pose] = []
    for pose in sorted(poses, key=lambda one: -one.presence * float(one.score.mean())):
        if not _is_among(pose, found):
            found.append(pose)
    return found


def _scan(network: PoseNetwork, picture: Image, known: Sequence[Pose]) -> list[Pose]:
    """People who are not known yet, the surest first."""
    largest = max((pose.crop.side for pose in known), default=0.0)
    sides = [size * largest for size in SIZES] if known else [size * len(picture) for size in HEIGHTS]
    found: list[Pose] = []
    for number, side in enumerate(sides):
        there = [pose.crop for pose in chain(known, found)]
        crops = [
            crop
            for crop in _grid(picture, side)
            if all(np.hypot(*(crop.center - one.center)) >= APART * one.side for one in there)
        ]
        small = SMALLEST * largest
        for pose in _settled(network, picture, crops):
            new = pose.crop.side > small and not _is_among(pose, [*known, *found])
            if new and len(known) + len(found) < 4:
                found.append(pose)
                largest = max(largest, pose.crop.side)
        if found and not known and number:  # somebody else may be one size smaller
            break
    return [pose for pose in found if pose.crop.side > SMALLEST * largest]


def find_in_picture(network: PoseNetwork, picture: Image) -> list[Pose]:
    """Whoever is seen in a single picture, the surest first."""
    return _scan(network, picture, [])


def _grid(picture: Image, side: float) -> Iterator[Crop]:
    """Crops of a side all over a picture; one where it fills the picture."""
    axes = []
    for length in (picture.shape[1], picture.shape[0]):
        count = 1 + round(max(length - 0.8 * side, 0.0) / (STEP * side))
        axes.append(np.linspace(min(0.4 * side, 0.5 * length), max(length - 0.4 * side, 0.5 * length), count))
        if count == 1:
            axes[-1] = np.array([0.5 * length])
    for y in axes[1]:
        for x in axes[0]:
            yield Crop(np.array([x, y]), side)


def _is_inside(pose: Pose, picture: Image) -> bool:
    return bool((pose.crop.center > 0.0).all() and (pose.crop.center < picture.shape[1::-1]).all())


def _is_among(pose: Pose, known: Sequence[Pose]) -> bool:
    """Whether one of the others is the same person: about the same place and size."""
    return any(
        float(np.linalg.norm(pose.pixel - other.pixel, axis=1).mean())
        < 0.5 * APART * max(pose.crop.side, other.crop.side)
        for other in known
    )


def _believed(seen: Sequence[Sequence[_Sighting]]) -> list[list[Pose]]:
    """The people of each picture but those of a moment; where nobody meets another, those of one size."""
    sides: dict[int, list[float]] = {}
    for one in chain.from_iterable(seen):
        sides.setdefault(one.track, []).append(one.pose.crop.side)
    longest = max(map(len, sides.values()), default=0)
    kept = {track for track, own in sides.items() if len(own) >= min(longest, 4)}
    if all(len(frame) < 2 for frame in seen) and kept:
        usual = float(np.median(max(sides.values(), key=len)))
        alike = (usual / MOST_OTHER, usual * MOST_OTHER)
        kept = {track for track in kept if alike[0] < float(np.median(sides[track])) < alike[1]}
    return [[one.pose for one in frame if one.track in kept] for frame in seen]


def _people(poses: Sequence[Pose], size: tuple[int, int], scale: float) -> SeenPeople:
    """The people of a frame in the clip's own pixels; points beyond its edges are not seen."""
    count = len(LAYOUT.names)
    pixel = np.array([pose.pixel for pose in poses]).reshape(-1, count, 2) / scale
    score = np.array([pose.score for pose in poses]).reshape(-1, count)
    hint = np.array([pose.hint_m for pose in poses]).reshape(-1, count, 3)
    faces = [no_faces(1)[0] if pose.face is None else pose.face for pose in poses]
    face = scaled_faces(faces, 1.0 / scale) if any(pose.face is not None for pose in poses) else None
    there = ((pixel >= 0.0) & (pixel <= np.array(size))).all(axis=-1)
    return SeenPeople(np.where(there[..., None], pixel, np.nan), np.where(there, score, 0.0), hint, face)
