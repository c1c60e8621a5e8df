"""A BVH as any program reads it: one performer's, with decimal points, its header checked."""

import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError, shown
from ..files.paths import read_saved_text, regular_file_size, with_decimal_point
from .named_points import chosen_subject

LARGEST_BYTES = 2**29
SLOWEST, FASTEST = 1.0, 1000.0  # frames a second
_RATE = re.compile(r"Frame\s+Time:\s*(\S+)", re.IGNORECASE)
_FRAMES = re.compile(r"Frames:\s*(\S+)", re.IGNORECASE)


@dataclass
class _Root:
    """A ROOT of the hierarchy."""

    name: str
    first: int  # its first channel
    lines: list[str]
    joints: int = 0
    channels: int = 0


def read_bvh(path: Path, subject: str | None = None) -> tuple[str, tuple[str, ...]]:
    """The text of a BVH with one ROOT alone, and notes.

    Of several ROOTs it is that of the subject, or else the one with the most joints. InputError: it is no
    BVH, its header lies about its rate or frames, which Blender would believe, or it has no such subject.
    """
    if regular_file_size(path, "a BVH") > LARGEST_BYTES:
        raise InputError(f"{path}: is larger than {LARGEST_BYTES // 2**20} MB; a motion must be smaller")
    head, _, rest = read_saved_text(path).partition("MOTION")
    matches = [pattern.search(rest[:1000]) for pattern in (_FRAMES, _RATE)]
    if "HIERARCHY" not in head[:1000] or matches[0] is None or matches[1] is None:
        raise InputError(f"{path}: is no BVH; it must have HIERARCHY, MOTION, Frames and Frame Time")
    frames, step = matches[0][1], with_decimal_point(matches[1][1])
    seconds = _number(step)
    if not 1.0 / FASTEST <= seconds <= 1.0 / SLOWEST:
        raise InputError(
            f"{path}: Frame Time is {step[:20]}; {1.0 / FASTEST:g} to {1.0 / SLOWEST:g} s are valid"
        )
    rows = [
        [with_decimal_point(word) for word in line.split()]
        for line in rest[matches[1].end() :].splitlines()
        if line.strip()
    ]
    if _number(frames) != len(rows):
        raise InputError(f"{path}: Frames is {frames[:20]}, but it has {len(rows)} rows of numbers")
    comma = next((word for row in rows for word in row if "," in word), None)
    if comma is not None:
        raise InputError(
            f"{path}: has {shown(comma[:20])} among its numbers; they must have a decimal point, or one "
            "comma in its place, and spaces between them"
        )
    roots = _roots(head)
    notes: tuple[str, ...] = ()
    lines = [line for root in roots for line in root.lines]
    if len(roots) > 1 or (roots and subject not in (None, path.stem)):
        index, notes = chosen_subject(
            path, [root.name for root in roots], [root.joints for root in roots], subject
        )
        root = roots[index]
        lines, end = root.lines, root.first + root.channels
        if min(map(len, rows), default=0) < roots[-1].first + roots[-1].channels:
            raise InputError(f"{path}: has rows with fewer numbers than its ROOTs have channels")
        rows = [row[root.first : end] for row in rows]
    numbers = "\n".join(" ".join(row) for row in rows)
    hierarchy = "\n".join(lines)
    return f"HIERARCHY\n{hierarchy}\nMOTION\nFrames: {frames}\nFrame Time: {step}\n{numbers}\n", notes


def _roots(head: str) -> list[_Root]:
    """The ROOTs of a hierarchy, each with its lines."""
    roots: list[_Root] = []
    for line in head.splitlines():
        words = line.split()
        if not words or (not roots and words[0].upper() != "ROOT"):
            continue
        if words[0].upper() == "ROOT":
            first = roots[-1].first + roots[-1].channels if roots else 0
            roots.append(_Root(" ".join(words[1:]), first, []))
        root = roots[-1]
        root.joints += words[0].upper() in ("ROOT", "JOINT")
        if words[0].upper() == "OFFSET":
            line = " ".join(with_decimal_point(word) for word in words)
        elif words[0].upper() == "CHANNELS":
            root.channels += len(words) - 2
        root.lines.append(line)
    return roots


def _number(text: str) -> float:
    with suppress(ValueError):
        return float(text)
    return float("nan")
