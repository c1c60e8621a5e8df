"""What may go wrong with a marker's color, in sentences for the person who can still change it."""

from collections.abc import Sequence
from typing import NamedTuple

FEW = 0.6
"""Share of the frames looked at below which a marker is seldom found."""
ENOUGH = 6
"""Frames that must be looked at to tell a marker that is seldom found from one that was hidden just then."""
MUCH = 0.2
"""Share of its color that others may have before it is worth a word."""
SMALL_PX = 40.0
"""Pixels of the measuring grid below which a region is hardly more than its border."""


class Likeness(NamedTuple):
    """What else looks like a marker."""

    alike: Sequence[str]
    """Names of markers that no color tells from it."""
    claimed: Sequence[tuple[str, float]]
    """Names of the other colors' markers, each with the share of its pixels taken for them."""
    background: float
    """Share of its pixels taken for the background."""
    clutter: float
    """Share of what has its color that is no marker."""
    rivals: float
    """Share of the markers of its color that is not it."""


def marker_warnings(
    name: str, found: int, sampled: int, grid_area: float, likeness: Likeness
) -> tuple[str, ...]:
    """Return what a person should know of a marker that was found, the gravest first.

    Args:
        name: the marker's.
        found: frames in which it is seen.
        sampled: frames looked at.
        grid_area: its usual area in pixels of the measuring grid.
        likeness: what else looks like it.
    """
    sentences = alike_warnings(name, likeness.alike)
    sentences += [
        f"{name} and {other} have colors too alike: {_percent(share)} of {name} would pass for {other}"
        for other, share in likeness.claimed
        if share >= MUCH
    ]
    if likeness.background >= MUCH:
        sentences.append(
            f"the background wears the color of {name}: {_percent(likeness.background)} of the marker would "
            "pass for it"
        )
    if likeness.clutter >= MUCH:
        sentences.append(
            f"{_percent(likeness.clutter)} of what has the color of {name} is something else in the picture"
        )
    if sampled >= ENOUGH and found < FEW * sampled:
        sentences.append(
            f"{name} is found in only {found} of {sampled} frames; where it is not hidden, pick its "
            "color in one that misses it"
        )
    if grid_area < SMALL_PX:
        sentences.append(
            f"{name} is small in the picture, so its place and direction are uncertain; film from nearer"
        )
    return tuple(sentences)


def alike_warnings(name: str, alike: Sequence[str]) -> list[str]:
    """Return a sentence on markers that no color tells from one, where there are any."""
    if not alike:
        return []
    return [
        f"{name} has almost the same color as {' and '.join(alike)}; only keyframes and paths tell which is "
        "which"
    ]


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"
