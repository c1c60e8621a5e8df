"""Natural hands and feet for a motion, whose postures leave them rigid with forearms and shins."""

from types import MappingProxyType

from ..arrays import Array
from ..body.extremities import Extremities
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from .contacts import STRAY_M, Contact, find_contacts
from .foot_turns import foot_turns
from .hand_turns import hand_turns


def natural_extremities(
    body: Body,
    posture: Posture,
    time_s: Array,
    contacts: tuple[Contact, ...] | None = None,
    stray_m: float = STRAY_M,
) -> Extremities:
    """Hands that hang relaxed, and feet that lie flat, roll and never pass the ground.

    Args:
        body: The body.
        posture: A batch of F postures.
        time_s: (F,) rising time of each frame [s].
        contacts: Rests of the ankles, 0 the left and 1 the right; found where not given.
        stray_m: Largest distance of a resting foot's estimate from its place [m].
    """
    pose = body.pose(posture)
    if contacts is None:
        ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
        contacts = find_contacts(body.points(pose)[:, ankles], time_s, stray_m)
    turns = {**foot_turns(body, pose, time_s, contacts), **hand_turns(body, pose)}
    return Extremities(MappingProxyType(turns))
