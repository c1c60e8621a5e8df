"""A network of somebody's own beside Keymark's: it looks at whom that one follows.

Its points follow those of Keymark's. It is believed where it sees the same person; one that is of something
else, has left for right, or says the same whatever it sees is left out.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Array, Image
from ...body.skeleton import SIDES
from ..hands import LENGTH_M, SMALLEST_PX, alike, hand_of
from ..keypoints import People, SecondSource, confidences, mirrored_point
from ..performer import FITS, person_size
from ..pose_network import LAYOUT, Look, Pose
from .network import Box, Network

HIPS = [LAYOUT.names.index(f"hip.{side}") for side in "LR"]
NEAR = 0.04
"""Mean distance of two detectors' points, in sizes of the person, below which they need not be compared with
those of other moments: whoever stands still looks alike at all times."""
LEAST_GAIN = 0.5
"""By which its points must be nearer than the same points at other moments (right ones are by .6 and more),
and with sides exchanged than as they are, to be called left for right."""
FEWEST_SHARE, FEWEST_POINTS = 0.5, 4
"""Of the looks, in which it must see the same person; and points of one by which that is told."""


class Beside:
    """Looks by a network at people whom Keymark's own has found."""

    def __init__(self, network: Network) -> None:
        self.network = network
        self._guesses = False  # any depth

    def __call__(self, pictures: Sequence[Image], poses: Sequence[Pose]) -> list[Pose]:
        """Poses of people in pictures with the network's points behind their own."""
        boxes = [Box.about(pose.pixel) for pose in poses]
        looks = self.network.each(list(zip(pictures, boxes, strict=True)))
        return [self._joined(pose, look) for pose, look in zip(poses, looks, strict=True)]

    def people(self, people: People) -> People:
        """People of whom the network has seen the last points, as far as it is believed."""
        names, file = self.network.layout.names, self.network.file
        second = SecondSource(self.network.name, names, file.digest, self.network.motion)
        people = replace(people, names=(*people.names, *names), second=second)
        if not self._guesses:
            frames = [one.hint_m.copy() for one in people.frames]
            for hint in frames:
                hint[:, -len(names) :] = np.nan
            pairs = zip(people.frames, frames, strict=True)
            people = replace(people, frames=tuple(replace(one, hint_m=hint) for one, hint in pairs))
        return believed(people)

    def _joined(self, pose: Pose, look: Look) -> Pose:
        score, hint = look.score, look.hint_m
        if score is None:  # as sure as Keymark's own network is of the same point
            known = dict(zip(LAYOUT.names, pose.score, strict=True))
            score = np.array([known.get(name, pose.score.mean()) for name in self.network.layout.names])
        self._guesses = hint is not None or look.depth_m is not None
        if hint is None:
            hint = np.zeros((len(look.pixel), 3))
        meters = 1.0  # of a pixel
        if look.depth_m is not None:
            # Across the view it has pixels alone, whose size the own network's guess in space tells.
            seen = pose.pixel - pose.pixel[HIPS].mean(axis=0)
            guess = (pose.hint_m - pose.hint_m[HIPS].mean(axis=0))[:, :2]
            meters = float((seen * guess).sum() / max(float((seen**2).sum()), 1e-9))
            names = self.network.layout.names
            hips = [names.index(f"hip.{side}") for side in "LR"]
            hint = np.column_stack([meters * look.pixel, look.depth_m])
            hint -= hint[hips].mean(axis=0)
        hands, others = pose.hands, look.hands
        if look.fingers is not None:
            space = look.fingers * [meters, meters, 1.0]
            others = np.array(
                [
                    hand_of(points, own[0, :2], side)
                    for points, own, side in zip(space, look.fingers, SIDES, strict=True)
                ]
            )
        large = pose.pixels_per_meter() * LENGTH_M >= SMALLEST_PX
        if others is not None and large:
            hands = np.where(np.isfinite(hands), hands, others)
        return replace(
            pose,
            hands=hands,
            pixel=np.concatenate([pose.pixel, look.pixel]),
            score=np.concatenate([pose.score, score]),
            hint_m=np.concatenate([pose.hint_m, hint]),
        )


def believed(people: People) -> People:
    """The people without points of a second source that are not theirs, and a sentence where all are not.

    Scores that are no probabilities are made confidences.
    """
    second = people.second
    assert second is not None
    first = len(people.names) - len(second.names)
    apart, exchanged, usual = _distances(people, first)
    fits = (apart < FITS) & (apart <= exchanged)
    near = float(np.median(apart))
    same = near > NEAR and near > (1.0 - LEAST_GAIN) * usual
    if same or fits.mean() < FEWEST_SHARE:
        why = "says about the same whatever it sees" if near < FITS else "is not where the performer is seen"
        if np.median(exchanged) < (1.0 - LEAST_GAIN) * near:
            why = "has left for right"
        note = f"{second.detector}: {why}, and is left out"
        kept = slice(first)
        frames = [
            replace(
                one,
                pixel=one.pixel[:, kept],
                score=one.score[:, kept],
                hint_m=one.hint_m[:, kept],
                hands=np.where(alike(one.hands)[..., None], np.nan, one.hands),
            )
            for one in people.frames
        ]
        notes = (*people.notes, note)
        return replace(people, names=people.names[kept], frames=tuple(frames), second=None, notes=notes)
    scores = np.concatenate([frame.score[:, first:] for frame in people.frames])
    scores[~fits] = 0.0
    scores[scores > 0.0], notes = confidences(scores[scores > 0.0], second.detector)
    rows = np.cumsum([0, *(len(frame.score) for frame in people.frames)])
    frames = []
    for frame, at, end in zip(people.frames, rows[:-1], rows[1:], strict=True):
        score, pixel, hint = frame.score.copy(), frame.pixel.copy(), frame.hint_m.copy()
        score[:, first:] = scores[at:end]
        pixel[:, first:][scores[at:end] == 0.0] = np.nan
        hint[~fits[at:end], first:] = np.nan
        frames.append(replace(frame, pixel=pixel, score=score, hint_m=hint))
    return replace(people, frames=tuple(frames), notes=(*people.notes, *notes))


def _distances(people: People, first: int) -> tuple[Array, Array, float]:
    """How far the points of both sources are apart in each of L looks, in sizes of the person.

    Returns:
        (L,) mean distance of the points that both see, infinite without four of them; (L,) the same with the
        second's sides exchanged; and the usual distance from the second's points at other moments.
    """
    own, also = people.names[:first], people.names[first:]
    shared = [name for name in own if name in also and mirrored_point(name) in also]
    pixel = np.concatenate([frame.pixel for frame in people.frames])
    one = pixel[:, [own.index(name) for name in shared]]
    sides = [[first + also.index(change(name)) for name in shared] for change in (str, mirrored_point)]
    size = person_size(one)[:, None, None]
    middle = np.nanmean(one, axis=1, keepdims=True) if len(one) else one
    one = (one - middle) / size
    two, swapped = ((pixel[:, side] - middle) / size for side in sides)
    steps = [round(share * len(one)) for share in (0.25, 0.5, 0.75)]
    others = np.concatenate([_apart(one, np.roll(two, step, axis=0)) for step in steps])
    others = others[np.isfinite(others)]
    return _apart(one, two), _apart(one, swapped), float(np.median(others)) if len(others) else np.inf


def _apart(one: Array, two: Array) -> Array:
    """(L,) mean distance of points (L, S, 2) that are in both; infinite where fewer than four are."""
    apart = np.linalg.norm(one - two, axis=-1)
    count = np.isfinite(apart).sum(axis=1)
    return np.where(count >= FEWEST_POINTS, np.nansum(apart, axis=1) / np.maximum(count, 1), np.inf)
