"""Warnings of a marker check: likely failures of a marker's color, as sentences."""

from collections.abc import Sequence
from typing import NamedTuple

FEW = 0.6
"""Share of the sampled frames below which a marker is detected too seldom."""
ENOUGH = 6
"""Sampled frames needed to tell a marker that is seldom detected from one that was hidden by chance."""
MUCH = 0.2
"""Share of confused pixels from which a warning is due."""
SMALL_PX = 40.0
"""Pixels of the measuring grid below which a region is hardly more than its border."""


class Likeness(NamedTuple):
    """Other things that look like a marker."""

    alike: Sequence[str]
    """Names of the markers of the same color."""
    claimed: Sequence[tuple[str, float]]
    """Names of the other colors' markers, each with the share of the marker's pixels classified as theirs."""
    background: float
    """Share of the marker's pixels classified as background."""
    clutter: float
    """Share of the area of its color that is no marker's."""
    rivals: float
    """Share of the area of its color's markers that is another marker's."""


def marker_warnings(
    name: str, found: int, sampled: int, grid_area: float, likeness: Likeness, still: Sequence[str] = ()
) -> tuple[str, ...]:
    """Warnings of a marker that was detected, the gravest first.

    Args:
        name: The marker's name.
        found: Number of frames in which it is detected.
        sampled: Number of sampled frames.
        grid_area: Its median area in pixels of the measuring grid.
        likeness: Other things that look like it.
        still: Where in the picture still areas have its color.
    """
    sentences = alike_warnings(name, likeness.alike)
    sentences += [
        (f"{name} and {other} have colors too alike: {100.0 * share:.0f} % of {name} would pass for {other}")
        for other, share in likeness.claimed
        if share >= MUCH
    ]
    if likeness.background >= MUCH:
        sentences.append(
            f"the background has the color of {name}: {100.0 * likeness.background:.0f} % of the "
            "marker would pass for background"
        )
    if likeness.clutter >= MUCH:
        sentences.append(
            f"{100.0 * likeness.clutter:.0f} % of the pixels with the color of {name} are something "
            "else in the picture"
        )
    if still:
        sentences.append(
            f"the color of {name} also stays still {' and '.join(still)} of the picture, which is "
            "surely no marker"
        )
    if sampled >= ENOUGH and found < FEW * sampled:
        sentences.append(
            f"{name} is found in only {found} of {sampled} frames; if it is visible in one of the "
            "others, pick its color there"
        )
    if grid_area < SMALL_PX:
        sentences.append(
            f"{name} is small in the picture, so its position and direction are uncertain; film from nearer"
        )
    return tuple(sentences)


def alike_warnings(name: str, alike: Sequence[str]) -> list[str]:
    """A sentence on the markers of the same color as one, if there are any."""
    if not alike:
        return []
    return [
        (
            f"{name} has almost the same color as {' and '.join(alike)}; only keyframes and paths tell "
            "them apart"
        )
    ]
