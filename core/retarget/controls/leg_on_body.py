"""A leg in FK on a body that few keys have moved a little: its foot stays where it was."""

from ...arrays import Array
from ...body import rotations
from ...numerics.vectors import unit
from ..solve.two_bone import STRAIGHTEST, LimbPose, reach_for
from .control_channels import ControlChannels
from .control_motion import ControlMotion


def leg_on_body(motion: ControlMotion, leg: str, carrier: ControlChannels) -> dict[str, Array]:
    """(F, 4, 4) poses of the bones at a leg's three joints, in the armature's space."""
    limb = motion.limbs[leg]
    first, second, third = limb.bones
    upper, lower, end = (motion.bones[bone].copy() for bone in limb.bones)
    start, middle, goal = limb.joints
    line = unit(goal - start)
    before = LimbPose(
        upper[:, :3, :3], lower[:, :3, :3], start, middle, goal, rotations.cross(limb.bend, line)
    )
    root = carrier.place + (carrier.turn @ limb.root_place)
    after = reach_for(before, root, goal, STRAIGHTEST)
    upper[:, :3, :3], upper[:, :3, 3] = after.upper_turn, root
    lower[:, :3, :3], lower[:, :3, 3] = after.lower_turn, after.middle
    end[:, :3, 3] = after.end
    return {first: upper, second: lower, third: end}
