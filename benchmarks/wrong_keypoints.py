"""Keypoints that are wrong in one way each: shuffled, mirrored, someone else's, random, shifted, late."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from takes import load_project

load_project()

from keymark.core.arrays import Array  # noqa: E402
from keymark.core.footage.keypoints.keypoints import (  # noqa: E402
    People,
    SeenPeople,
    mirrored_point,  # noqa: E402
)

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
