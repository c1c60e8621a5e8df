"""Keypoints that are wrong in one way each: shuffled, someone else's, late, of another size, mirrored."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from takes import load_project

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.detect.keypoints import People, SeenPeople, mirrored_point  # noqa: E402

SEED = 15
RANDOM_SHARE = 0.3
"""Share of the points that are anywhere in the picture."""
OFFSET_SHARE = 0.04
"""Constant offset, as a share of the picture's width."""
OTHER_PERSON_SHARE = 0.2
"""Distance of the other person, as a share of the picture's width."""
OTHER_PERSON_FRAMES = 40
"""Frames by which the other person's motion is ahead of the performer's."""
LATE_FRAMES = 10


def shuffled(people: People) -> People:
    """Every frame shows what belongs to some other one."""
    order = np.random.default_rng(SEED).permutation(len(people.frames))
    return replace(people, frames=tuple(people.frames[index] for index in order))


def left_for_right(people: People) -> People:
    """Left and right are exchanged in all frames."""
    names = list(people.names)
    other = [names.index(twin) if (twin := mirrored_point(name)) in names else index
             for index, name in enumerate(names)]  # fmt: skip
    frames = tuple(
        SeenPeople(seen.pixel[:, other], seen.score[:, other], seen.hint_m[:, other])
        for seen in people.frames
    )
    return replace(people, frames=frames)


def another_person(people: People) -> People:
    """Someone beside the performer, who moves alike but at other times."""
    later = [*people.frames[OTHER_PERSON_FRAMES:], *people.frames[:OTHER_PERSON_FRAMES]]
    step = np.array([OTHER_PERSON_SHARE * people.size[0], 0.0])
    return replace(people, frames=tuple(replace(seen, pixel=seen.pixel + step) for seen in later))


def partly_random(people: People) -> People:
    """Almost a third of the points are anywhere in the picture, with full confidence."""
    random = np.random.default_rng(SEED)

    def scattered(seen: SeenPeople) -> SeenPeople:
        wrong = random.random(seen.score.shape) < RANDOM_SHARE
        anywhere: Array = random.random(seen.pixel.shape) * np.array(people.size)
        return replace(seen, pixel=np.where(wrong[..., None], anywhere, seen.pixel))

    return replace(people, frames=tuple(scattered(seen) for seen in people.frames))


def offset(people: People) -> People:
    """All points lie too far to the right and too low."""
    step = OFFSET_SHARE * people.size[0]
    return replace(people, frames=tuple(replace(seen, pixel=seen.pixel + step) for seen in people.frames))


def late(people: People) -> People:
    """Every frame shows what belongs ten frames earlier."""
    frames = [people.frames[0]] * LATE_FRAMES + list(people.frames[:-LATE_FRAMES])
    return replace(people, frames=tuple(frames))


WRONG: Mapping[str, Callable[[People], People]] = {
    "shuffled frames": shuffled,
    "left for right": left_for_right,
    "another person": another_person,
    "30 % at random": partly_random,
    "constant offset": offset,
    "ten frames late": late,
}
"""What a detector may do, by the name in tables."""


def resized(scale: float) -> Callable[[People], People]:
    """All points are those of a copy of the clip of another size."""

    def changed(people: People) -> People:
        return _moved(people, lambda pixel: scale * pixel)

    return changed


def of_mirrored_copy(people: People) -> People:
    """All points are those of a mirrored copy of the clip."""
    flip = [people.size[0], 0.0]
    return left_for_right(_moved(people, lambda pixel: np.array(flip) + pixel * [-1.0, 1.0]))


def at_rate(rate: float) -> Callable[[People], People]:
    """Frame by frame of a copy at another frame rate; where that ends, it goes on from the beginning."""

    def changed(people: People) -> People:
        count = len(people.frames)
        rows = (np.arange(count) / rate).astype(int) % count
        return replace(people, frames=tuple(people.frames[row] for row in rows))

    return changed


def jumping(people: People) -> People:
    """For a fifth of the clip someone else, who walks the other way."""
    count = len(people.frames)
    gone = range(2 * count // 5, 3 * count // 5)
    mirrored = of_mirrored_copy(people).frames
    other = tuple(mirrored[count - 1 - row] if row in gone else people.frames[row] for row in range(count))
    return replace(people, frames=other)


def _moved(people: People, change: Callable[[Array], Array]) -> People:
    """The points elsewhere; those outside the picture are not seen."""
    frames = []
    for seen in people.frames:
        pixel = change(seen.pixel)
        inside = ((pixel >= 0.0) & (pixel <= np.array(people.size))).all(axis=-1)
        place = np.where(inside[..., None], pixel, np.nan)
        frames.append(SeenPeople(place, np.where(inside, seen.score, 0.0), seen.hint_m))
    return replace(people, frames=tuple(frames))


NOT_OF_THE_PICTURE: Mapping[str, Callable[[People], People]] = {
    "as it is": lambda people: people,
    "half size": resized(0.5),
    "three quarters": resized(0.75),
    "1.2 times": resized(1.2),
    "1.5 times": resized(1.5),
    "mirrored copy": of_mirrored_copy,
    "half the rate": at_rate(0.5),
    "twice the rate": at_rate(2.0),
    "ten frames late": late,
    "another person": another_person,
    "someone in between": jumping,
}
"""What a file may be of, by the name in tables."""
