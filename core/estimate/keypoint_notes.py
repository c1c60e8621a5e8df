"""Notes on keypoints for people: what was left out, exchanged back or thrown out, one sentence each."""

import numpy as np

from ..arrays import BoolArray
from ..files.fields import listed
from ..text import pluralize
from .keypoint_fit import KeypointFit

THROUGHOUT = 0.5
"""Share of the frames from which on sides are exchanged throughout."""
MANY_THROWN_OUT = 0.2
"""Share of a source's keypoints that are thrown out which gets a note."""
MOST_NAMED = 4
"""Largest number of points that a note names."""


def keypoint_notes(fit: KeypointFit) -> tuple[str, ...]:
    """Notes on each source of keypoints that was not taken as it stands."""
    notes: list[str] = []
    for source, trust in fit.source_trust.items():
        own = np.array([name == source for name in fit.keypoints.sources])
        if trust == 0.0:
            notes.append(_left_out(source, fit.lag.get(source, 0)))
            continue
        notes += _exchanged(source, fit.swapped[:, own])
        doubted = np.flatnonzero(own & (fit.trust == 0.0))
        if len(doubted):
            named = listed([fit.keypoints.names[i] for i in doubted], MOST_NAMED)
            notes.append(
                f"keypoints of {source} that lie elsewhere than in the keyframes are left out: {named}"
            )
        seen = fit.keypoints.seen & own & (fit.trust > 0.0)
        share = fit.thrown_out[seen].mean() if seen.any() else 0.0
        if share > MANY_THROWN_OUT:
            notes.append(
                f"{share:.0%} of the keypoints of {source} lie far from where everything else has "
                "the performer and are thrown out; check whom and what they follow"
            )
    return tuple(notes)


def _left_out(source: str, lag: int) -> str:
    if lag:
        when = f"about {pluralize(abs(lag), 'frame')} {'late' if lag > 0 else 'early'} by the keyframes"
        return (
            f"the keypoints of {source} are {when} and are left out; check that they were made from "
            "this clip, at its frame rate and from its first frame"
        )
    return (
        f"the keypoints of {source} are not where the keyframes have the performer and are left out; "
        "check that they are of this clip and this person"
    )


def _exchanged(source: str, swapped: BoolArray) -> list[str]:
    frames = int(swapped.any(axis=1).sum())
    if not frames:
        return []
    if frames > THROUGHOUT * len(swapped):
        return [f"{source} takes left for right throughout; the estimate exchanged its keypoints back"]
    return [
        (f"{source} takes left for right in {pluralize(frames, 'frame')}; the estimate exchanged them back")
    ]
