"""What a person must know of a take while it is true: contradictions of a frame, notices of a step."""

from collections.abc import Iterable, Sequence

import bpy
from bpy.types import PropertyGroup

from .fields import HIDDEN, Number, Switch, Text

SAME_FRAME = 0.5  # a note nearer to a frame than this [frames] is of that frame
SEPARATOR = "\n"  # between names, which are of one line each


class KEYMARK_PG_contradiction(bpy.types.PropertyGroup):
    """What no plausible posture explains at a frame."""

    frame: Number("Frame", "The scene frame")
    names: Text("Names", "Names of the markers and keypoints, a line each", options=HIDDEN)
    reading: Text("Reading", "Key of the reading of the clip that it was found in", options=HIDDEN)


def note_contradictions(take: PropertyGroup, frame: float, names: Sequence[str]) -> None:
    """Note which markers and keypoints no plausible posture explains at a scene frame; none: all are."""
    noted = take.contradictions
    for index in reversed(range(len(noted))):
        if abs(noted[index].frame - frame) < SAME_FRAME:
            noted.remove(index)
    if names:
        entry = noted.add()
        entry.frame, entry.names, entry.reading = frame, SEPARATOR.join(names), take.reading_key


class KEYMARK_PG_notice(bpy.types.PropertyGroup):
    """A sentence about a step of a take."""

    step: Text("Step", "The step it is about", options=HIDDEN)
    about: Text("About", "What of the step it is about; a newer notice replaces it", options=HIDDEN)
    text: Text("Notice", "The sentence")
    of_keyframe: Switch("Of a Keyframe", "It holds while there is a keyframe at its frame", options=HIDDEN)
    frame: Number("Frame", "The scene frame that it is about", options=HIDDEN)


def give_notices(
    take: PropertyGroup, step: str, about: str, sentences: Iterable[str] = (), frame: float | None = None
) -> None:
    """Replace the notices on something of a step of `STEPS`; those of a frame hold while it is a keyframe."""
    notices = take.notices
    for index in reversed(range(len(notices))):
        if (notices[index].step, notices[index].about) == (step, about):
            notices.remove(index)
    for sentence in sentences:
        entry = notices.add()
        entry.step, entry.about = step, about
        entry.text = sentence
        entry.of_keyframe, entry.frame = frame is not None, frame or 0.0
