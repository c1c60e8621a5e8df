"""Outlier takes: clips whose size or rate differs from nearly all of their shoot, as of another camera."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from ...text import Sentence
from .take_check import TakeCheck

FEWEST_TAKES = 5
"""Known values below which none is usual."""
USUAL_SHARE = 0.8
"""Share of the takes that must have the same value for it to be usual."""


def flag_outliers(checks: Sequence[TakeCheck]) -> list[TakeCheck]:
    """The checks, with a warning for each clip whose size or rate is an outlier of the shoot."""
    sizes = [None if one.size is None else f"{one.size[0]} x {one.size[1]} pixels" for one in checks]
    rates = [None if one.fps is None else f"{one.fps:.4g} frames per second" for one in checks]
    warned = []
    for check, size, rate in zip(checks, _outliers(sizes), _outliers(rates), strict=True):
        more = [
            Sentence(
                "the clip has {own}, nearly all others have {usual}; check that it is this camera's",
                own=own,
                usual=usual,
            )
            for own, usual in filter(None, (size, rate))
        ]
        check = replace(check, warnings=(*check.warnings, *more))
        warned.append(check)
    return warned


def _outliers(values: Sequence[str | None]) -> list[tuple[str, str] | None]:
    """Each outlier with the usual value; None where a value is usual or unknown, or none is usual."""
    known = Counter(value for value in values if value is not None)
    if known.total() < FEWEST_TAKES:
        return [None] * len(values)
    usual, count = known.most_common(1)[0]
    if count < USUAL_SHARE * known.total():
        return [None] * len(values)
    return [None if value in (None, usual) else (str(value), usual) for value in values]
