"""Takes whose clips are unlike most of their shoot: filmed with another camera, or converted on the way."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from .take_check import TakeCheck

FEWEST = 5
"""Takes from which on it can be told what most are like."""
MOST = 0.8
"""Share of the takes that must be alike."""


def with_odd_ones(checks: Sequence[TakeCheck]) -> list[TakeCheck]:
    """The same with a warning where a clip has another size or rate than nearly all of the shoot."""
    sizes = _usual([None if one.size is None else f"{one.size[0]} x {one.size[1]} pixels" for one in checks])
    rates = _usual([None if one.fps is None else f"{one.fps:.4g} frames per second" for one in checks])
    warned = []
    for check, size, rate in zip(checks, sizes, rates, strict=True):
        more = [f"it has {own}, nearly all others have {usual}" for own, usual in filter(None, (size, rate))]
        if more:
            said = f"{'; '.join(more)}: is it this camera's?"
            check = replace(check, warnings=(*check.warnings, said))
        warned.append(check)
    return warned


def _usual(values: Sequence[str | None]) -> list[tuple[str, str] | None]:
    """Of each odd value, itself and the usual one; None where it is as usual, not known, or none is usual."""
    known = Counter(value for value in values if value is not None)
    if known.total() < FEWEST:
        return [None] * len(values)
    usual, count = known.most_common(1)[0]
    if count < MOST * known.total():
        return [None] * len(values)
    return [None if value in (None, usual) else (str(value), usual) for value in values]
