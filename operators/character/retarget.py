"""Give the take's motion to a character."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ...core.progress import stretch
from ..shell.job_operator import JobOperator
from ..shell.messages import warn
from ..shell.requirements import idle
from ..shell.takes import active_take, take_by_identifier
from .characters import active_character
from .figures import figures
from .map_conversion import map_of
from .options import options_of
from .requirements import editable, recognized, source
from .results import add_result, result_to_replace, show_lines
from .source_motion import SourceMotion, source_of

if TYPE_CHECKING:
    from ...core.progress import Job
    from ..bridge.character.retarget import Retargeted

READ = 0.1
"""Share of the job at which the motion is read."""


@dataclass(frozen=True, eq=False)
class RetargetedCharacter:
    """A motion on a character of a take, not yet written."""

    take: str
    """The take's identifier."""
    uids: tuple[int, int, int]
    """Session numbers of the character's armature, the source Action and its actor."""
    kind: str
    """The kind of source motion."""
    title: str
    """What a new Action is named after, beside the character."""
    retargeted: "Retargeted"


class KEYMARK_OT_retarget(JobOperator, bpy.types.Operator):
    """Let the character perform the motion, as an Action of its own"""

    bl_idname = "keymark.retarget"
    bl_label = "Retarget"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (source, editable, recognized, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[RetargetedCharacter]":
        """Read the motion and solve it on the character, with the options at the start of the job."""
        from ..bridge.character.retarget import retarget
        from ..bridge.character.source import read_source

        take = active_take(scene)
        character = active_character(scene)
        motion = source_of(take, character)
        identifier, armature_object = take.identifier, character.armature
        uids = armature_object.session_uid, motion.action.session_uid, motion.actor.session_uid
        character_map, options = map_of(character.character_map), options_of(character.options)
        del take, character  # Blender may move them while the job runs
        source, frames = yield from stretch(read_source(motion.actor, motion.action), 0.0, READ)
        job = retarget(armature_object, source, frames, character_map, options)
        retargeted = yield from stretch(job, READ, 1.0)
        return RetargetedCharacter(identifier, uids, motion.kind, motion.title, retargeted)

    def finish(self, scene: bpy.types.Scene, result: RetargetedCharacter) -> None:
        """Write the Action, and list it with what was measured of it."""
        take = take_by_identifier(scene, result.take)
        character = next((each for each in take.characters if _uid(each.armature) == result.uids[0]), None)
        source_action = next((each for each in bpy.data.actions if _uid(each) == result.uids[1]), None)
        actor = next((each for each in bpy.data.objects if _uid(each) == result.uids[2]), None)
        if character is None or source_action is None or actor is None:
            raise InputError(
                "the character or its motion was removed while the job ran; nothing was changed, run it again"
            )
        earlier = None
        if not character.keep_earlier:
            earlier = result_to_replace(character, result.kind, source_action)
        into = earlier.action if earlier is not None else f"{result.title} {character.armature.name}"
        action = result.retargeted.write(scene, into)
        source = SourceMotion(result.kind, source_action, actor, result.title)
        listed = add_result(character, source, action)
        show_lines(listed, figures(result.retargeted.quality), result.retargeted.notes)
        for note in result.retargeted.notes:
            warn(self, note)
        self.report({"INFO"}, f"'{character.armature.name}' performs '{action.name}'")


def _uid(block: bpy.types.ID | None) -> int:
    return -1 if block is None else int(block.session_uid)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_retarget,))
