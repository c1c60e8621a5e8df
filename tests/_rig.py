"""A rig without Blender: every joint of a body turns by a quaternion, in the joint's own axes."""

import numpy as np
from _scene import BODY
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import continuous_quaternions, to_quaternions
from keymark.core.keys.rig import Rig, RigBone

LEAVES = ("hand", "foot")


def quaternion_rig(body: Body = BODY) -> Rig:
    """Bones of a body, by default the average one's, hands and feet fixed to their limbs."""
    skeleton, bones = body.skeleton, []
    turning = [s for s in skeleton.segments if not s.name.startswith(LEAVES)]
    names = [segment.name for segment in turning]
    for segment in turning:
        leaves = [s for s in skeleton.segments if s.parent == segment.name and s.name.startswith(LEAVES)]
        ends = np.stack([body.local(part.end) for part in (segment, *leaves)])
        parent = -1 if segment.parent is None else names.index(segment.parent)
        above = -1 if parent < 0 else turning[parent].joint
        first = segment.joint
        while skeleton.joints[first].parent != above:
            first = skeleton.joints[first].parent
        origin = np.zeros(3) if parent < 0 else body.offsets[first]
        axes = np.eye(3) if parent < 0 else None
        bones.append(RigBone(segment.name, parent, "QUATERNION", np.eye(3), np.eye(3), origin, ends, axes))
    return Rig(tuple(bones))


def rig_values(rig: Rig, posture: Posture, body: Body = BODY) -> list[np.ndarray]:
    """What each bone of `quaternion_rig` holds to show a batch of postures."""
    joint = {segment.name: segment.joint for segment in body.skeleton.segments}
    pose = body.pose(posture)
    values = []
    for bone in rig.bones:
        turn = pose.rotation[:, joint[bone.name]]
        if bone.parent >= 0:
            turn = np.swapaxes(pose.rotation[:, joint[rig.bones[bone.parent].name]], -1, -2) @ turn
        values.append(continuous_quaternions(to_quaternions(turn)))
    values[0] = np.concatenate([values[0], pose.origin[:, 0]], axis=1)
    return values
