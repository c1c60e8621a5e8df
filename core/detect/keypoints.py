"""Names of the points of the body that a keypoint may show.

The principal points of the skeleton, and what detectors add: face, spine, hands and feet. Left and right are
the performer's own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, freeze
from ..body.human import HUMAN
from ..body.skeleton import SIDES
from ..files.kinds import Choice, Items, Text
from ..files.records import Record

FACE = ("nose", *(f"{part}.{side}" for part in ("eye", "ear") for side in SIDES))
SPINE = ("crown", "neck", "pelvis")
"""Top of the head, the middle between the shoulders, and the middle between the hips."""
HANDS = tuple(f"{part}.{side}" for part in ("index", "thumb", "pinky") for side in SIDES)
"""Knuckles: where the finger begins."""
FEET = tuple(f"{part}.{side}" for part in ("heel", "toe", "small_toe") for side in SIDES)
"""Back of the heel, tip of the big toe, tip of the small toe."""
BODY_POINTS = (*HUMAN.point_names, *FACE, *SPINE, *HANDS, *FEET)
"""All names, in the order in which they are listed to people."""


def mirrored_point(name: str) -> str:
    """The same point on the other side of the body; a point in the middle is its own mirror image."""
    stem, dot, side = name.rpartition(".")
    return f"{stem}.{'R' if side == 'L' else 'L'}" if dot else name


def mirror_images(names: Sequence[str], sources: Sequence[str]) -> list[int]:
    """For each keypoint the index of the one that its source has on the other side; its own without one."""
    index = {key: i for i, key in enumerate(zip(names, sources, strict=True))}
    return [
        index.get((mirrored_point(name), source), i)
        for i, (name, source) in enumerate(zip(names, sources, strict=True))
    ]


def confidences(scores: Array, where: str) -> tuple[Array, tuple[str, ...]]:
    """Scores (S,) of all placed points as confidences, and a sentence where they had to be changed.

    Probabilities stay as they are; a negative one among them stands for nothing found. Negative scores beside
    such above 1 are logits, the logarithm of the odds. Responses of networks that exceed 1 (SimCC's heat
    maps, percentages) are divided by the one that most stay below: only their order and proportion mean
    anything. A file without any score vouches for all of its points.
    """
    known = scores[np.isfinite(scores)]
    if not len(known) or not known.any():
        note = f"{where}: has no scores; every point in it is believed alike"
        return np.where(np.isnan(scores), np.nan, 1.0), (note,) if len(scores) else ()
    low, high = float(known.min()), float(known.max())
    if high <= 1.0:
        return np.maximum(scores, 0.0), ()
    if low < 0.0:
        note = f"{where}: its scores, {low:.3g} to {high:.3g}, were taken for logits and made confidences"
        return 1.0 / (1.0 + np.exp(-np.clip(scores, -50.0, 50.0))), (note,)
    certain = max(1.0, float(np.quantile(known, 0.95)))  # a few outliers set no scale
    note = f"{where}: its scores reach {high:.3g}; {certain:.3g} and more count as certain"
    return np.minimum(scores / certain, 1.0), (note,)


FACING = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turn of whoever at rest faces the viewer, in axes x right, y down, z away."""
FACE_NUMBERS = 6  # of a face, as `face` explains them
HAND_NUMBERS = 22  # of a hand, as `hands` does


def no_face() -> Array:
    """(6,) what is known of a face that was not looked at."""
    return np.full(FACE_NUMBERS, np.nan)


def no_hands() -> Array:
    """(2, 22) what is known of hands that were not looked at."""
    return np.full((len(SIDES), HAND_NUMBERS), np.nan)


@dataclass(frozen=True, eq=False)
class Keypoints:
    """N keypoints of one person in F frames; NaN where one is not seen."""

    names: tuple[str, ...]  # (N,) the body point each shows; two sources may show the same one
    sources: tuple[str, ...]  # (N,) what saw each: a detector, Blender's tracks, a person
    pixel: Array  # (F, N, 2) [px] of the clip, origin at the outer corner of the top left pixel
    score: Array  # (F, N) the source's confidence, 0 to 1; 0 where not seen
    hint_m: Array
    """(F, N, 3) a network's guess of the points in space [m]: x right, y down, z away from the camera, origin
    between the hips; NaN where there is none."""
    notes: tuple[str, ...] = ()
    """Sentences on who of several people was taken, and on what the sources' files leave open."""
    face: Array = field(default_factory=no_face)  # (F, 6) faces as in `face`, NaN where not looked at
    hands: Array = field(default_factory=no_hands)  # (F, 2, 22) left and right as in `hands`, likewise
    beside: Mapping[str, str] = field(default_factory=dict)
    """Sources without hints that looked at whom another one follows, and that one."""

    def __post_init__(self) -> None:
        frames, count = len(self.pixel), len(self.names)
        _with_looks(self, frames)
        shapes = {"pixel": (frames, count, 2), "score": (frames, count), "hint_m": (frames, count, 3)}
        freeze(self, shapes | {"face": self.face.shape, "hands": self.hands.shape})

    @classmethod
    def none(cls, frames: int) -> "Keypoints":
        """No keypoint at all, N = 0."""
        empty = np.zeros((frames, 0))
        return cls((), (), np.zeros((frames, 0, 2)), empty, np.zeros((frames, 0, 3)))

    @classmethod
    def side_by_side(cls, parts: Sequence["Keypoints"], frames: int) -> "Keypoints":
        """All keypoints of several sources of the same clip, in order."""
        if not parts:
            return cls.none(frames)
        return cls(
            tuple(name for part in parts for name in part.names),
            tuple(source for part in parts for source in part.sources),
            np.concatenate([part.pixel for part in parts], axis=1),
            np.concatenate([part.score for part in parts], axis=1),
            np.concatenate([part.hint_m for part in parts], axis=1),
            tuple(note for part in parts for note in part.notes),
            next((part.face for part in parts if np.isfinite(part.face).any()), no_face()),
            next((part.hands for part in parts if np.isfinite(part.hands).any()), no_hands()),
            {other: source for part in parts for other, source in part.beside.items()},
        )

    def frames(self, own: slice) -> "Keypoints":
        """The keypoints of some frames."""
        return replace(self, **{name: getattr(self, name)[own] for name in OF_FRAMES})

    def frame(self, index: int) -> "Keypoints":
        """The keypoints of one frame."""
        return self.frames(slice(index, index + 1))

    def exchanged(self, which: BoolArray | None = None) -> "Keypoints":
        """The keypoints, or those of `which` (F, N), exchanged with their source's mirror images of them."""
        partner = mirror_images(self.names, self.sources)
        either = np.ones(self.score.shape, dtype=bool) if which is None else which | which[:, partner]
        return replace(
            self,
            pixel=np.where(either[..., None], self.pixel[:, partner], self.pixel),
            score=np.where(either, self.score[:, partner], self.score),
            hint_m=np.where(either[..., None], self.hint_m[:, partner], self.hint_m),
        )

    @property
    def frame_count(self) -> int:
        """Number of frames F."""
        return len(self.pixel)

    @property
    def seen(self) -> BoolArray:
        """(F, N) whether each keypoint is seen in each frame."""
        return np.asarray(np.isfinite(self.pixel).all(axis=-1))

    def without_hints(self) -> "Keypoints":
        """The same keypoints without the guess of the points in space."""
        return replace(self, hint_m=np.full(self.hint_m.shape, np.nan))


OF_FRAMES = ("pixel", "score", "hint_m", "face", "hands")


def _with_looks(owner: "Keypoints | SeenPeople", count: int) -> None:
    """Give looks at faces and hands, of so many or the same of all, to each."""
    object.__setattr__(owner, "face", np.broadcast_to(owner.face, (count, FACE_NUMBERS)))
    object.__setattr__(owner, "hands", np.broadcast_to(owner.hands, (count, len(SIDES), HAND_NUMBERS)))


@dataclass(frozen=True, eq=False)
class SeenPeople:
    """One source's people of one frame, H of them; a person may be missing in any frame."""

    pixel: Array  # (H, N, 2) [px] of the clip, NaN where not seen
    score: Array  # (H, N) 0 to 1, 0 where not seen
    hint_m: Array  # (H, N, 3) as in `Keypoints`
    face: Array = field(default_factory=no_face)  # (H, 6) as in `Keypoints`
    hands: Array = field(default_factory=no_hands)  # (H, 2, 22) likewise

    def __post_init__(self) -> None:
        _with_looks(self, len(self.pixel))

    @classmethod
    def nobody(cls, points: int) -> "SeenPeople":
        """No person at all, H = 0, by a source of so many points."""
        return cls(np.zeros((0, points, 2)), np.zeros((0, points)), np.zeros((0, points, 3)))

    def moved(self, place: Callable[[Array], Array]) -> "SeenPeople":
        """The same with all places (..., 2) [px] as a function has them; faces and hands go along."""
        looks = (
            np.concatenate([place(own[..., :2]), own[..., 2:]], axis=-1) for own in (self.face, self.hands)
        )
        return SeenPeople(place(self.pixel), self.score, self.hint_m, *looks)

    def mirrored(self, width: float) -> "SeenPeople":
        """The same in the mirror image of a picture so wide [px]; points keep their columns, hands do not."""
        flipped = self.moved(lambda place: np.array([width, 0.0]) + place * [-1.0, 1.0])
        # A turn's axis is a pseudovector. A hand's second look was at the mirror image.
        face, hands = flipped.face * [1.0, 1.0, 1.0, -1.0, -1.0, 1.0], flipped.hands[:, ::-1].copy()
        looks = hands[..., 2:].reshape(*hands.shape[:-1], 2, -1)[..., ::-1, :].copy()
        looks[..., 1:3] *= -1.0
        hands[..., 2:] = looks.reshape(*hands.shape[:-1], -1)
        return replace(flipped, hint_m=flipped.hint_m * [-1.0, 1.0, 1.0], face=face, hands=hands)

    def only(self, rows: Sequence[int] | IndexArray) -> "SeenPeople":
        """Some of them alone."""
        return SeenPeople(*(getattr(self, name)[rows] for name in OF_FRAMES))


NAMES = Items("body points", 1, len(BODY_POINTS), unique="point", item=Choice(BODY_POINTS))
LONGEST_DETECTOR = 200  # characters
VISIBLE = f"one line of at most {LONGEST_DETECTOR} visible characters"
Detector = Annotated[str, Text(LONGEST_DETECTOR, VISIBLE, one_line=True)]


@dataclass(frozen=True)
class SecondSource(Record):
    """A network of somebody's own that looked at the same people; its points follow those of the first."""

    detector: Detector
    """What it is, with the number of its points and the size of its pictures."""
    names: Annotated[tuple[str, ...], NAMES]
    """Body points that it sees, each once; they follow the first source's."""
    digest: Annotated[str, Text(64, "a checksum, SHA-256", one_line=True)] = ""
    """Checksum of its file, SHA-256."""
    motion: bool = False
    """Whether its points in world are followed as a reference motion, and are no hints of depth."""


@dataclass(frozen=True, eq=False)
class People:
    """Everyone whom a source saw in F frames, with N body points each."""

    names: tuple[str, ...]  # (N,) the body points
    source: str  # what saw them: the name of the detector, or of the file
    size: tuple[int, int]  # width and height of the pictures they were seen in [px]
    frames: tuple[SeenPeople, ...]  # those of each frame of the clip, none or several
    file: str = ""  # the file they were read from, for sentences; empty where there is none
    by_hand: bool = False
    """Whether a person placed the points: clicks and Blender's tracks, which are all the performer's."""
    notes: tuple[str, ...] = ()  # sentences on what was taken for granted or mended
    looked: Mapping[int, bool] = field(default_factory=dict)
    """Frames in which the picture was asked, and whether it shows somebody where these people are."""
    silent: tuple[int, ...] = ()
    """Frames that it says nothing of, not even that nobody is there: it was shifted."""
    in_pictures: Mapping[int, Array] = field(default_factory=dict)
    """(N, 2) where the pose network sees the points of the largest there [px]; NaN where it does not."""
    second: SecondSource | None = None
    """Who else saw these people; None where `source` saw all points."""

    @property
    def sources(self) -> tuple[str, ...]:
        """(N,) what saw each point."""
        also = () if self.second is None else (self.second.detector,) * len(self.second.names)
        return (self.source,) * (len(self.names) - len(also)) + also

    @property
    def most_people(self) -> int:
        """Largest number of people in a frame."""
        return max((len(frame.pixel) for frame in self.frames), default=0)

    @property
    def seen_frames(self) -> int:
        """Number of frames in which anybody is seen."""
        return sum(len(frame.pixel) > 0 for frame in self.frames)

    def without_hints(self) -> "People":
        """The same people without the guess of the points in space."""
        frames = tuple(replace(frame, hint_m=np.full(frame.hint_m.shape, np.nan)) for frame in self.frames)
        return replace(self, frames=frames)
