"""Keypoints held against the picture: whether they are of this clip, of its size, its side and its time.

A detector's file may be of a smaller copy, a mirrored one, or another clip; nothing in it says so. The pose
network looks at some pictures where the file has somebody. Where it sees him there, too, the file is right.
Elsewhere it looks for people by itself, and what would put the file's where they are is found out.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ..arrays import Array, Image
from ..errors import InputError, pluralize
from ..progress import Part
from ..video.album import Glimpses
from .keypoints import People, SeenPeople, mirrored_point
from .performer import FITS, person_size
from .pose_network import CIRCLE, LAYOUT, NAME, Crop, Pose, PoseNetwork
from .pose_tracking import scan

BETTER = 0.6  # another reading of a file must bring its points so much nearer
LEAST_OFF = 0.04  # nearer points are right as they stand
FARTHEST = 0.5  # a distance counts at most so much
FEWEST_POINTS, FEWEST_FRAMES, FEWEST_SHARE = 4, 3, 0.3
MOST_SCANNED = 6  # pictures in which people are looked for
SURE, LIKELY = (0.9, 0.5), (0.5, 0.3)  # presence and mean score from which the network sees somebody
PEOPLE = 2  # of a file, in a picture
SCALES = np.geomspace(0.1, 10.0, 185)  # steps of 2.5 %
LEAST_SCALE = 0.03  # logarithm of a scale that is one
ROUND_SHARE = 0.015  # scales are those of pictures' sizes: ratios of small numbers, if one is so near
LONGEST_SHIFT_S, NEAR_FRAMES = 3.0, 3  # by which a file may be late; what is near although it is so late
RATES = (0.25, 1.0 / 3.0, 0.4, 0.5, 2.0 / 3.0, 0.8, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0)


@dataclass(frozen=True)
class PictureFinding:
    """What the pictures say of a file of keypoints."""

    scale: tuple[float, float] = (1.0, 1.0)  # by which its places must be multiplied
    mirrored: bool = False  # whether left and right of its pictures are exchanged
    looked: Mapping[int, bool] = field(default_factory=dict)
    """Frames that were looked at, and whether the network sees somebody there whom the file has."""
    seen: Mapping[int, Array] = field(default_factory=dict, compare=False)
    """(N, 2) where the network sees the points of a file that is right [px]; NaN where it does not."""
    shift: int = 0  # by how many frames it is late
    refusal: str = ""  # why it cannot be used, to follow the file's name


@dataclass(frozen=True, eq=False)
class _Look:
    """A picture, whom the file has in it, and whom the network sees."""

    frame: int
    poses: Sequence[Array]  # of each person (K, 2) [px], NaN where not seen


def check_by_pictures(
    people: People, glimpses: Glimpses, network: PoseNetwork, fps: float
) -> Part[PictureFinding]:
    """Hold the people of a file against some pictures of the clip; what is not known for sure is not said."""
    check = _Check(people, fps)
    frames = [f for f in glimpses.frames if f < len(people.frames) and len(people.frames[f].pixel)]
    if len(check.shared) < FEWEST_POINTS or len(frames) < FEWEST_FRAMES:
        return PictureFinding()
    looks, off = [], []
    for frame in frames:
        picture, factor = glimpses.picture(frame)
        look, sure = check.look(frame, picture, factor, network)
        looks.append((look, sure))
        off.append(check.distance(look, people.frames[frame]))
        yield 0.5 * len(looks) / len(frames)
    fitting = [one < FITS for one in off]
    if sum(fitting) < FEWEST_SHARE * len(frames):
        sure_looks = [look for look, sure in looks if sure]
        rest = [look.frame for look, sure in looks if not sure]
        wanted = max(MOST_SCANNED - len(sure_looks), 0)
        for frame in rest[:: max(len(rest) // max(wanted, 1), 1)][:wanted]:
            picture, factor = glimpses.picture(frame)
            found = scan(network, picture)
            if found:
                sure_looks.append(check.seen(frame, found, factor))
            yield 0.5 + 0.5 * len(sure_looks) / MOST_SCANNED
        if len(sure_looks) < FEWEST_FRAMES:
            return PictureFinding()
        return check.explained(sure_looks) or PictureFinding(
            refusal="nobody in it is where a person is seen in the clip's pictures, at any size or time; it "
            "must be of this clip"
        )
    shown = [look for look, _ in looks if look.poses]
    return check.explained(shown) or PictureFinding(
        looked=dict(zip(frames, fitting, strict=True)),
        # What it found itself from frame to frame it knows better than from one picture alone.
        seen={look.frame: check.in_order(look.poses[0]) for look in shown if people.source != NAME},
    )


class _Check:
    """The people of one file."""

    def __init__(self, people: People, fps: float) -> None:
        self.people, self.fps = people, fps
        self.shared = [name for name in LAYOUT.names if name in people.names]
        self._own = [people.names.index(name) for name in self.shared]
        self._network = [LAYOUT.names.index(name) for name in self.shared]
        other = [mirrored_point(name) for name in self.shared]
        self._swap = [self.shared.index(name) if name in self.shared else at for at, name in enumerate(other)]

    def look(self, frame: int, picture: Image, factor: float, network: PoseNetwork) -> tuple[_Look, bool]:
        """Whom the network sees where the file has people; whether it is sure of somebody."""
        people = self.people.frames[frame]

        def sees(pose: Pose, least: tuple[float, float]) -> bool:
            return pose.presence > least[0] and float(pose.score.mean()) > least[1]

        order = np.argsort(-person_size(people.pixel) * people.score.mean(axis=1), kind="stable")
        poses = []
        seen = np.isfinite(people.pixel[:, self._own]).all(axis=-1).sum(axis=1) >= FEWEST_POINTS
        for row in order[seen[order]][:PEOPLE]:
            pose = network(picture, _crop(people.pixel[row] / factor, self.people.names))
            if not sees(pose, SURE) or self.distance(self.seen(frame, [pose], factor), people) >= FITS:
                pose = network(picture, pose.crop)  # somebody may be there, in another place of the crop
            if sees(pose, LIKELY):
                poses.append(pose)
        return self.seen(frame, poses, factor), any(sees(pose, SURE) for pose in poses)

    def seen(self, frame: int, poses: Sequence[Pose], factor: float) -> _Look:
        """A look at a picture that is smaller than the clip's by a factor."""
        points = [
            np.where((pose.score > 0.5)[:, None], pose.pixel * factor, np.nan)[self._network]
            for pose in poses
        ]
        return _Look(frame, points)

    def in_order(self, pose: Array) -> Array:
        """(N, 2) points of the network in the order of the file's."""
        points = np.full((len(self.people.names), 2), np.nan)
        points[self._own] = pose
        return points

    def distance(
        self,
        look: _Look,
        people: SeenPeople,
        changed: Callable[[Array], Array] = np.asarray,
        either_side: bool = True,
    ) -> float:
        """Least mean distance of the file's people from the network's, in sizes of a person.

        `either_side`: the network may take one side of the body for the other.
        """
        best = FARTHEST
        for pixel in changed(people.pixel[:, self._own]):
            for pose in look.poses:
                for own in (pixel, pixel[self._swap]) if either_side else (pixel,):
                    apart = np.linalg.norm(own - pose, axis=-1) / float(person_size(pose))
                    known = np.isfinite(apart)
                    if known.sum() >= FEWEST_POINTS:
                        best = min(best, float(np.minimum(apart[known], FARTHEST).mean()))
        return best

    def explained(self, looks: Sequence[_Look]) -> PictureFinding | None:
        """What would put the file's people where the network sees them; None if they are there."""
        if len(looks) < FEWEST_FRAMES:
            return None
        frames = self.people.frames
        there = {look.frame: True for look in looks}

        def cost(changed: Callable[[Array], Array] = np.asarray, either_side: bool = True) -> float:
            return float(
                np.mean([self.distance(look, frames[look.frame], changed, either_side) for look in looks])
            )

        sided, now = cost(either_side=False), cost()
        wanted = min(FITS, BETTER * now)
        if now < LEAST_OFF:  # a few frames early or late are as near, and nothing else is
            late = self._late(looks, wanted, NEAR_FRAMES, ())[1] if now > 0.5 * LEAST_OFF else None
            if sided < LEAST_OFF or late is not None:
                return late
        width = np.array([float(self.people.size[0]), 0.0])

        def flip(pixel: Array) -> Array:
            return np.asarray((width + pixel * [-1.0, 1.0])[:, self._swap])

        if cost(flip, either_side=False) < min(FITS, BETTER * sided):
            return PictureFinding(mirrored=True, looked=there)
        if now < LEAST_OFF:
            return None
        # Of somebody who walks across, another time looks like another size, and the other way around.
        best, late = self._late(looks, wanted, round(LONGEST_SHIFT_S * self.fps), RATES)
        costs = [cost(partial(np.multiply, scale)) for scale in SCALES]
        near = SCALES[int(np.argmin(costs))]
        if min(costs) < FARTHEST / 2:
            scale = self._fitted_scale(looks, np.full(2, near))
            if cost(partial(np.multiply, scale)) < best and abs(np.log(scale)).max() > LEAST_SCALE:
                return PictureFinding((float(scale[0]), float(scale[1])), looked=there)
        return late

    def _fitted_scale(self, looks: Sequence[_Look], scale: Array) -> Array:
        """(2,) scales of both axes by all points that are near the network's at a scale."""
        for reach in (FARTHEST / 2, 2.0 * FITS, 2.0 * FITS):
            ratios = [np.ones((0, 2))]
            for look in looks:
                for pixel in self.people.frames[look.frame].pixel[:, self._own]:
                    for pose in look.poses:
                        apart = np.linalg.norm(scale * pixel - pose, axis=-1)
                        near = apart < reach * float(person_size(pose))
                        ratios.append(pose[near] / np.maximum(pixel[near], 1e-6))
            found = np.concatenate(ratios)
            scale = np.median(found, axis=0) if len(found) else scale
        both = float(np.exp(np.log(scale).mean()))
        if abs(np.log(scale / both)).max() < ROUND_SHARE:
            scale = np.full(2, both)
        return np.array([_rounded(float(one)) for one in scale])

    def _late(
        self, looks: Sequence[_Look], wanted: float, most: int, rates: Sequence[float]
    ) -> tuple[float, PictureFinding | None]:
        """Whether the file is of the clip at another time, by so many frames at most, or at another rate.

        And its distance then, else the wanted.
        """
        frames = self.people.frames
        reach = min(most, len(frames) // 2)
        best, shift, rate = wanted, 0, 1.0
        for other in (1.0, *rates):
            for offset in range(-reach, reach + 1):
                pairs = [(look, round(other * look.frame + offset)) for look in looks]
                inside = [(look, f) for look, f in pairs if 0 <= f < len(frames) and len(frames[f].pixel)]
                if len(inside) < max(FEWEST_FRAMES, 0.45 * len(looks)):
                    continue
                now = float(np.mean([self.distance(look, frames[f]) for look, f in inside]))
                if now < (best if other == 1.0 else 0.8 * best):
                    best, shift, rate = now, offset, other
        if rate != 1.0:
            return best, PictureFinding(
                refusal=f"it runs through the motion {1.0 / rate:.3g} times as fast as the clip; it must be "
                "of this clip, frame by frame"
            )
        return (best, PictureFinding(shift=shift)) if shift else (wanted, None)


def applied(people: People, finding: PictureFinding) -> People:
    """The people as the pictures say that they are meant.

    Raises:
        InputError: They cannot be.
    """
    where = people.file or people.source
    if finding.refusal:
        raise InputError(f"{where}: {finding.refusal}")
    notes, names = [], people.names
    scale, size = np.array(finding.scale), np.array(people.size, dtype=np.float64)
    if finding.scale != (1.0, 1.0):
        width, height = np.round(size / scale).astype(int)
        notes.append(
            f"{people.source}: its points lie where the person in the clip's pictures is if it was made from "
            f"pictures of {width} x {height}; they were scaled to the clip's {people.size[0]} x "
            f"{people.size[1]}"
        )
    if finding.mirrored:
        names = tuple(mirrored_point(name) for name in names)
        notes.append(f"{people.source}: is of a mirrored copy of the clip; left and right were exchanged")
    if finding.shift:
        when, way = ("late", "before") if finding.shift > 0 else ("early", "after")
        notes.append(
            f"{people.source}: its points are where the person in the clip's pictures is about "
            f"{pluralize(abs(finding.shift), 'frame')} {way}: it is {when}, and was shifted"
        )
    people = replace(people, looked=finding.looked, in_pictures=finding.seen)
    if not notes:
        return people
    nobody = SeenPeople.nobody(len(names))
    frames = [nobody] * max(-finding.shift, 0)
    for frame in people.frames[max(finding.shift, 0) : len(people.frames) + min(finding.shift, 0)]:
        seen = frame.moved(partial(np.multiply, scale))
        frames.append(seen.mirrored(size[0]) if finding.mirrored else seen)
    frames += [nobody] * max(finding.shift, 0)
    ends = (max(-finding.shift, 0), len(frames) - max(finding.shift, 0))
    silent = (*range(ends[0]), *range(ends[1], len(frames)))
    return replace(people, names=names, frames=tuple(frames), silent=silent, notes=(*people.notes, *notes))


def _crop(pixel: Array, names: Sequence[str]) -> Crop:
    """The crop about a person (N, 2), upright along the trunk."""
    seen = np.isfinite(pixel).all(axis=-1)

    def middle(part: str) -> Array | None:
        own = [names.index(f"{part}.{side}") for side in "LR" if f"{part}.{side}" in names]
        own = [number for number in own if seen[number]]
        return pixel[own].mean(axis=0) if own else None

    hips, shoulders = middle("hip"), middle("shoulder")
    center = hips if hips is not None else pixel[seen].mean(axis=0)
    radius = float(np.linalg.norm(pixel[seen] - center, axis=-1).max())
    up = shoulders - hips if hips is not None and shoulders is not None else np.array([0.0, -1.0])
    return Crop(center, CIRCLE * max(radius, 4.0), float(np.arctan2(up[0], -up[1])))


def _rounded(scale: float) -> float:
    """The ratio of small numbers that is meant by a measured scale, if one is near."""
    ratios = {many / few for many in range(1, 13) for few in range(1, 13)}
    nearest = min(ratios, key=lambda ratio: abs(np.log(ratio / scale)))
    return nearest if abs(np.log(nearest / scale)) < ROUND_SHARE else scale
