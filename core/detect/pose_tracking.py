"""Everyone in a clip, found by the landmark network and followed from picture to picture.

The network looks at some fifteen pictures a second, in a thread of its own while the clip goes on being
decoded; a cubic goes through what it sees. People are looked for at the end of every stretch of pictures, by
crops of several sizes and places; from there they are followed backward until they are lost or met, and
forward into the next stretches. Who of them is the performer is chosen later, as among any detector's people
(`keypoints/performer`).
"""

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray
from ..body.skeleton import SIDES
from ..errors import InputError
from ..numerics.cubic import hermite_basis
from ..progress import Job, Progress
from ..video.clip import Clip
from ..video.working_image import measuring_image
from .closer_look import CloserLook
from .keypoints import People, SeenPeople, no_face, no_hands
from .pose_network import LAYOUT, NAME, Crop, Pose, PoseNetwork

DETECTING = "Detecting keypoints"
STRETCH = 30  # pictures kept at a time, 190 MB
AHEAD = 6  # pictures that may be decoded before the network has seen the one before them
LOOKS_A_SECOND = 15.0
"""Twice as many are no more exact: 2.26 % of a body's height on seven takes, 2.24 with a cubic in between."""
HANDS_EVERY = 2  # looks at people; those at hands take longer
LARGEST_SIDE_PX = 1920  # larger pictures are halved; the network sees 256 pixels of a person
HEIGHTS = (1.15, 0.75, 0.5, 0.33)  # sides of the crops that are looked into, by the height of the picture
SIZES = (0.75,)  # the same by the largest person who is followed already
STEP = 0.5  # between crops, by their side
APART = 0.3  # share of a crop's side within which two crops show the same person
MOST_OTHER = 1.6  # ratio of sizes beyond which a later person is another
SHOULDERS = [LAYOUT.names.index(f"shoulder.{side}") for side in SIDES]
SMALLEST = 0.35  # others are followed from this share of the largest one's size on


@dataclass(frozen=True, eq=False)
class _Sighting:
    """A person in one frame."""

    track: int  # number of the person, a new one where somebody was lost in between
    pose: Pose


def find_people(clip: Clip, network: PoseNetwork, closer: CloserLook | None = None) -> Job[People]:
    """Find everyone in a clip; `closer` sees heads and hands too.

    Raises:
        InputError: It is a picture, has no frames, or nobody is in it.
    """
    yield Progress(DETECTING, 0.0)
    with PeopleFinder(clip, lambda: (network, closer)) as finder:
        for index, _, picture in clip.frames():
            finder.add(index, picture)
            yield Progress(DETECTING, min((index + 1) / clip.frame_count, 1.0))
        return finder.people()


class PeopleFinder:
    """Looks for everyone in the pictures of a clip while these are read one after the other."""

    def __init__(self, clip: Clip, load: Callable[[], tuple[PoseNetwork, CloserLook | None]]) -> None:
        """Begin with a clip; its first picture has the networks loaded, which take their time."""
        refuse_picture(clip)
        self.count = 0
        """Frames so far."""
        self._clip = clip
        self._every = max(1, round(clip.fps / LOOKS_A_SECOND))
        self._halvings = max(0, (max(clip.size) - 1) // LARGEST_SIDE_PX).bit_length()
        self._load = load
        self._looked: list[int] = []  # frames that are looked at
        self._last: Image | None = None  # the last picture, where it is not
        self._pool = ThreadPoolExecutor(1)
        self._waiting: deque[Future[None]] = deque()

    @cached_property
    def _tracking(self) -> "_Tracking":
        return _Tracking(*self._load())

    def __enter__(self) -> "PeopleFinder":
        return self

    def __exit__(self, *_error: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def add(self, index: int, picture: Image) -> None:
        """Take the next frame; it waits where the network has fallen behind."""
        self.count, self._last = index + 1, picture
        if index % self._every == 0:
            self._look(picture)

    def _look(self, picture: Image) -> None:
        self._looked.append(self.count - 1)
        self._last = None
        small = measuring_image(picture, self._halvings)
        self._waiting.append(self._pool.submit(self._tracking.add, small))
        if len(self._waiting) > AHEAD:
            self._waiting.popleft().result()

    def people(self) -> People:
        """Everyone, once all frames were taken."""
        path, size = self._clip.path, self._clip.size
        if self._last is not None:
            self._look(self._last)
        if not self._looked:
            raise InputError(f"{path}: holds no frame that can be decoded; it must be a video or images")
        self._waiting.append(self._pool.submit(self._tracking.end_stretch))
        while self._waiting:
            self._waiting.popleft().result()
        tracks = _believed(self._tracking.seen)
        if not tracks:
            raise InputError(
                f"{path}: nobody is seen in any of its {self.count} frames; it must show a person, at "
                "least from the head to the hips and not too small"
            )
        (first, *_), closer = tracks[0].values(), self._tracking.closer
        frames = [SeenPeople.nobody(len(first.pixel))] * self.count
        looked = np.array(self._looked)
        for track in tracks:
            _fill(frames, looked, track, size, 0.5**self._halvings)
        people = People(LAYOUT.names, NAME, size, tuple(frames))
        return people if closer is None or closer.beside is None else closer.beside.people(people)


def refuse_picture(clip: Clip) -> None:
    """Refuse a single picture in place of a clip."""
    if clip.frame_count == 1:
        raise InputError(
            f"{clip.path}: is a single picture; it must be a video, or a folder of the pictures of one"
        )


class _Tracking:
    """Whom pictures show that come one after the other."""

    def __init__(self, network: PoseNetwork, closer: CloserLook | None) -> None:
        self._network, self.closer = network, closer
        self._tracks = 0
        self._pictures: list[Image] = []  # of the stretch at hand
        self._seen: list[list[_Sighting]] = []
        self._people: list[_Sighting] = []  # who is followed on, in the last picture
        self.seen: list[list[_Sighting]] = []
        """Of each picture of the stretches that are complete."""

    def add(self, picture: Image) -> None:
        """Follow everyone into the next picture."""
        self._pictures.append(picture)
        self._seen.append([])
        last = len(self._pictures) - 1
        is_first = not self.seen and last == 0
        self._people = self._new(0) if is_first else self._go(self._people, range(last, last + 1))
        if len(self._pictures) == STRETCH:
            self.end_stretch()

    def end_stretch(self) -> None:
        """Look for others at the end of the stretch, and follow them back."""
        if not self._pictures:
            return
        last = len(self._pictures) - 1
        self._look(last)
        if not any(self._seen):
            self._look(last // 2)
        self._people = self._seen[last]
        self.seen += self._seen if self.closer is None else self._looked_at(self.closer)
        self._pictures, self._seen = [], []

    def _looked_at(self, closer: CloserLook) -> list[list[_Sighting]]:
        """The stretch's people with their heads and hands."""
        seen = enumerate(zip(self._pictures, self._seen, strict=True))
        looks = [
            (picture, one.pose, index % HANDS_EVERY == 0) for index, (picture, frame) in seen for one in frame
        ]
        poses = iter(closer(looks))
        return [[_Sighting(one.track, next(poses)) for one in frame] for frame in self._seen]

    def _look(self, index: int) -> None:
        """Look for new people in a picture, and follow them both ways."""
        new = self._new(index)
        self._go(new, range(index - 1, -1, -1))
        self._go(new, range(index + 1, len(self._pictures)))

    def _new(self, index: int) -> list[_Sighting]:
        """New people in a picture."""
        poses = scan(self._network, self._pictures[index], [one.pose for one in self._seen[index]])
        new = [_Sighting(track, pose) for track, pose in enumerate(poses, self._tracks)]
        self._tracks += len(new)
        self._seen[index] += new
        return new

    def _go(self, people: list[_Sighting], way: range) -> list[_Sighting]:
        """Follow people until they are lost, or met by others who are followed already; who is left."""
        for index in way:
            if not people:
                break
            picture, known = self._pictures[index], [other.pose for other in self._seen[index]]
            poses = self._network.each([(picture, one.pose.crop) for one in people])
            followed: list[_Sighting] = []
            for one, pose in zip(people, poses, strict=True):
                before, now = one.pose.crop, pose.crop
                moved = np.hypot(*(now.center - before.center)) / before.side
                grown = max(now.side / before.side, before.side / max(now.side, 1.0))
                same = pose.presence >= 0.5 and _sure(pose, picture) >= 0.3 and moved <= 0.35 and grown <= 1.5
                if same and not _is_among(pose, known):
                    followed.append(_Sighting(one.track, pose))
                    known.append(pose)  # two may have become one
            people = followed
            self._seen[index] += people
        return people


def _distinct(poses: Sequence[Pose]) -> list[Pose]:
    """Each person once, the surest first."""
    found: list[Pose] = []
    for pose in sorted(poses, key=lambda one: -one.presence * float(one.score.mean())):
        if not _is_among(pose, found):
            found.append(pose)
    return found


def scan(network: PoseNetwork, picture: Image, known: Sequence[Pose] = ()) -> list[Pose]:
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
        seen = network.each([(picture, crop) for crop in crops])
        seen = _distinct([pose for pose in seen if pose.presence > 0.3])
        for _ in range(2):  # somebody may be there, in another place of the crop
            seen = _distinct(network.each([(picture, pose.crop) for pose in seen]))
        for pose in (one for one in seen if one.presence > 0.9 and _sure(one, picture) > 0.5):
            new = pose.crop.side > small and not _is_among(pose, [*known, *found])
            if new and len(known) + len(found) < 4:
                found.append(pose)
                largest = max(largest, pose.crop.side)
        if found and not known and number:  # somebody else may be one size smaller
            break
    return [pose for pose in found if pose.crop.side > SMALLEST * largest]


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


def _sure(pose: Pose, picture: Image) -> float:
    """Mean score of the points within the picture; 0 where neither hips nor shoulders are."""

    def inside(place: Array) -> BoolArray:
        return np.asarray(((place > 0.0) & (place < picture.shape[1::-1])).all(axis=-1))

    shoulders = pose.pixel[SHOULDERS].mean(axis=0)
    is_there = inside(np.stack([pose.crop.center, shoulders])).any()
    return float(pose.score[inside(pose.pixel)].mean()) if is_there else 0.0


def _is_among(pose: Pose, known: Sequence[Pose]) -> bool:
    """Whether one of the others is the same person: about the same place and size."""
    return any(
        float(np.linalg.norm(pose.pixel - other.pixel, axis=1).mean())
        < 0.5 * APART * max(pose.crop.side, other.crop.side)
        for other in known
    )


def _believed(seen: Sequence[Sequence[_Sighting]]) -> list[dict[int, Pose]]:
    """Everyone's poses by the picture, but of those of a moment; where nobody meets another, of one size."""
    tracks: dict[int, dict[int, Pose]] = {}
    for index, frame in enumerate(seen):
        for one in frame:
            tracks.setdefault(one.track, {})[index] = one.pose
    longest = max(map(len, tracks.values()), default=0)
    kept = [own for own in tracks.values() if len(own) >= min(longest, 4)]
    if all(len(frame) < 2 for frame in seen) and kept:
        sides = [float(np.median([pose.crop.side for pose in own.values()])) for own in kept]
        usual = sides[int(np.argmax([len(own) for own in kept]))]
        alike = (usual / MOST_OTHER, usual * MOST_OTHER)
        kept = [own for own, side in zip(kept, sides, strict=True) if alike[0] < side < alike[1]]
    return kept


def _fill(
    frames: list[SeenPeople],
    looked: IndexArray,
    track: Mapping[int, Pose],
    size: tuple[int, int],
    scale: float,
) -> None:
    """Add a person to the frames from the first to the last look at them, in the clip's own pixels.

    Between looks all is on the cubic through them whose slopes are those of their neighbors (Catmull and Rom
    1974), but for faces and hands, which are those of looks. Points beyond the picture's edges are not seen.
    """
    at = looked[sorted(track)]
    poses = [track[index] for index in sorted(track)]
    face, hands = (np.stack([none()] * int(at[-1] - at[0] + 1)) for none in (no_face, no_hands))
    face[at - at[0]], hands[at - at[0]] = [one.face for one in poses], [one.hands for one in poses]
    face[:, :2] /= scale
    hands[..., :2] /= scale
    seen = np.stack([np.column_stack([one.pixel / scale, one.score, one.hint_m]) for one in poses])
    if len(at) > 1:
        between = np.arange(at[0], at[-1] + 1)
        left = np.clip(np.searchsorted(at, between, side="right") - 1, 0, len(at) - 2)
        gap, slope = np.diff(at)[left], np.gradient(seen, at, axis=0)
        v0, m0, v1, m1 = hermite_basis(gap, (between - at[left]) / gap).T[..., None, None]
        begun, ended = v0 * seen[left] + m0 * slope[left], v1 * seen[left + 1] + m1 * slope[left + 1]
        seen, at = begun + ended, between
    pixel, score = seen[..., :2], np.clip(seen[..., 2], 0.0, 1.0)
    there = ((pixel >= 0.0) & (pixel <= np.array(size))).all(axis=-1)
    pixel, score = np.where(there[..., None], pixel, np.nan), np.where(there, score, 0.0)
    for row, frame in enumerate(at):
        others = frames[frame]
        frames[frame] = SeenPeople(
            np.concatenate([others.pixel, pixel[row][None]]),
            np.concatenate([others.score, score[row][None]]),
            np.concatenate([others.hint_m, seen[row, None, :, 3:]]),
            np.concatenate([others.face, face[row][None]]),
            np.concatenate([others.hands, hands[row][None]]),
        )
