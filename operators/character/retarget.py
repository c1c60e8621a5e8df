"""Give the take's motion to a character."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.requirements import idle
from ..shell.takes import active_take, take_by_identifier
from .characters import find_character
from .map_conversion import map_of
from .requirements import editable, recognized, source
from .results import result_to_write, show_lines
from .source_motion import source_of

if TYPE_CHECKING:
    from ...core.progress import Job
    from ...core.retarget.options import RetargetOptions
    from ..bridge.character.retarget import Retargeted


@dataclass(frozen=True, eq=False)
class RetargetedCharacter:
    """A motion on a character of a take, not yet written."""

    take: str
    """The take's identifier."""
    armature: int
    """The armature's session number, by which the character is found again."""
    kind: str
    """The kind of source motion."""
    source_action: int
    """The source Action's session number."""
    title: str
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

        take, character = active_take(scene), find_character(bpy.context)
        motion = source_of(take, character)
        identifier, armature_object = take.identifier, character.armature
        character_map, options = map_of(character.character_map), options_of(character.options)
        numbers = armature_object.session_uid, motion.action.session_uid
        del take, character  # Blender may move them while the job runs
        job = retarget(armature_object, motion.actor, motion.action, character_map, options)
        retargeted = yield from job
        return RetargetedCharacter(identifier, numbers[0], motion.kind, numbers[1], motion.title, retargeted)

    def finish(self, scene: bpy.types.Scene, result: RetargetedCharacter) -> None:
        """Write the Action, and list it with what was measured of it."""
        take = take_by_identifier(scene, result.take)
        character = next(
            (each for each in take.characters if _number(each.armature) == result.armature), None
        )
        if character is None:
            raise InputError("the character of this job was removed while it ran; nothing was changed")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_retarget,))
