"""A keyframe library learned from the motion in an Action, the animator's changes included."""

import bpy

from ....core.body.human import HUMAN
from ....core.library.learning import LibraryMetadata, learn_library
from ....core.library.library import Library
from ....core.progress import run
from ..actor_lengths import read_body
from ..final_motion import motion_frames, read_values, shown_postures
from ..rig import read_rig


def library_from_action(
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    frame_s: float,
    about: LibraryMetadata,
    count: int | None = None,
) -> Library:
    """Learn a library from the motion that an Action holds for an actor.

    Args:
        armature_object: The actor.
        action: The motion, with the animator's changes.
        frame_s: Time from one scene frame to the next [s].
        about: Title, author and license.
        count: How many postures; by default 10 to 40, as many as differ.

    Raises:
        InputError: The Action has no motion of the actor, the armature is not an actor's, or the motion
            is too short or stands still, or title, author or license is invalid.
    """
    body = read_body(armature_object, HUMAN)
    rig = read_rig(armature_object, body)
    frames = motion_frames(armature_object, action, body)
    values = run(read_values(armature_object, action, rig, frames))
    posture = shown_postures(armature_object, rig, rig.pose(values), body)
    library = learn_library(body, posture, (frames - frames[0]) * frame_s, about, count)
    Library.from_json(library.to_json(), f"library '{about.title}'")  # checks what was typed
    return library
