"""The contents of a keyframe library, as an object for programs and as lines for people."""

from collections import Counter
from typing import Any

from .....core.library.library import Library, LibraryMotion


def library_summary(library: Library) -> dict[str, Any]:
    """A library's contents as an object for `--json`."""
    return {
        "identifier": library.identifier,
        "title": library.title,
        "version": library.version,
        "author": library.author,
        "license": library.license,
        "description": library.description,
        "tags": list(library.tags),
        "sources": list(library.sources),
        "stature_m": round(library.actor.stature_m, 3),
        "postures": [posture.name for posture in library.postures],
        "motions": [
            {
                "name": motion.name,
                "cyclic": motion.cyclic,
                "duration_s": motion.duration_s,
                "steps": len(motion.steps),
                "travel": list(motion.travel),
            }
            for motion in library.motions
        ],
    }


def library_lines(library: Library) -> list[str]:
    """A library's contents as lines for people."""
    lines = [
        f"{library.title} ({library.identifier}, version {library.version})",
        *([library.description] if library.description else []),
        f"By {library.author}; license {library.license}; posed on {100.0 * library.actor.stature_m:.0f} cm",
        f"{library.size}:",
        *(f"  {_motion_line(motion)}" for motion in library.motions),
    ]
    steps = Counter(step.posture for motion in library.motions for step in motion.steps)
    loose = [posture.name for posture in library.postures if not steps[posture.name]]
    if loose:
        lines.append(f"  in no motion: {', '.join(loose)}")
    return [*lines, *(f"Source: {source}" for source in library.sources)]


def _motion_line(motion: LibraryMotion) -> str:
    kind = "again and again, " if motion.cyclic else ""
    x, y, _ = motion.travel
    distance_m = (x * x + y * y) ** 0.5
    travel = f", {distance_m:.2f} m on" if distance_m >= 0.01 else ""
    return f"{motion.name}: {len(motion.steps)} postures, {kind}{motion.duration_s:.2f} s{travel}"
