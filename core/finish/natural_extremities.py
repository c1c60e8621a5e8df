"""Natural hands and feet for a motion, whose postures leave them rigid with forearms and shins."""

from collections.abc import Sequence
from types import MappingProxyType

from ..arrays import Array
from ..body.extremities import Extremities
from ..body.kinematics import Body
from ..body.posture import Posture
from .contacts import Contact, find_contacts
from .foot_ground import find_ground, on_ground
from .foot_pitch import Shins, Soles
from .foot_turns import foot_turns
from .hand_turns import hand_turns


def natural_extremities(
    body: Body, posture: Posture, time_s: Array, contacts: Sequence[Contact] | None = None
) -> Extremities:
    """Hands that hang relaxed, and feet that lie flat, roll and never pass the ground.

    Args:
        body: The body.
        posture: A batch of F postures.
        time_s: (F,) rising time of each frame [s].
        contacts: Rests of the ankles, 0 the left and 1 the right; found where not given.
    """
    pose = body.pose(posture)
    shins, soles = Shins.of(body, pose), Soles.of(body)
    rests = on_ground(find_contacts(shins.ankle, time_s) if contacts is None else contacts)
    ground = find_ground(shins, soles, time_s, rests)
    feet = foot_turns(shins, soles, ground, time_s, rests)
    hands = hand_turns(body, pose, ground.height_m.min(axis=1), time_s)
    return Extremities(MappingProxyType({**feet, **hands}))
