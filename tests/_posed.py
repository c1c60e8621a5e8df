"""The posture that the actor of a scene's active take shows."""

import bpy
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.operators.bridge.actor_lengths import read_body
from keymark.operators.bridge.pose import read_posture
from keymark.operators.shell.takes import active_take


def posture_of(scene: bpy.types.Scene) -> Posture:
    """The actor's posture."""
    armature_object = active_take(scene).armature
    return read_posture(armature_object, read_body(armature_object, HUMAN)).posture
