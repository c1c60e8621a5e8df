"""Notices: what a person must know of a step for as long as it is true, in the panel of that step.

The status bar shows a sentence for some seconds; a notice stays until whoever gave it, or another operator
that makes it untrue, gives the step's notices anew, or until the keyframe that it is about is gone.
"""

from collections.abc import Iterable

import bpy

from .fields import HIDDEN, Number, Switch, Text


class KEYMARK_PG_notice(bpy.types.PropertyGroup):
    """A sentence about a step of a take."""

    step: Text("Step", "The step it is about", options=HIDDEN)
    about: Text("About", "What of the step it is about; a newer notice replaces it", options=HIDDEN)
    text: Text("Notice", "The sentence")
    of_keyframe: Switch("Of a Keyframe", "It holds while there is a keyframe at its frame", options=HIDDEN)
    frame: Number("Frame", "The scene frame that it is about", options=HIDDEN)


def give_notices(
    take: bpy.types.PropertyGroup,
    step: str,
    about: str,
    sentences: Iterable[str] = (),
    frame: float | None = None,
) -> None:
    """Replace the notices about something of a step of `STEPS`; none: there is nothing to know any more.

    `about` is any name, such as `clip`; notices of a keyframe's scene frame hold while there is one.
    """
    notices = take.notices
    for index in reversed(range(len(notices))):
        if (notices[index].step, notices[index].about) == (step, about):
            notices.remove(index)
    for sentence in sentences:
        entry = notices.add()
        entry.step, entry.about = step, about
        entry.text = sentence
        entry.of_keyframe, entry.frame = frame is not None, frame or 0.0
