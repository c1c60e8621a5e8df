"""What a person chooses for retargeting."""

from dataclasses import dataclass
from enum import Enum

from ..take.conversion_settings import CharacterOptions


class RootMotion(Enum):
    """Where the way over the ground goes."""

    AS_FILMED = "as_filmed"  # on the hips: the character goes where the performer went
    IN_PLACE = "in_place"  # nowhere: the character stays where it begins, as on a treadmill
    ROOT_BONE = "root_bone"  # on the map's root bone: the hips keep only what they do about it


class Placement(Enum):
    """Where the character performs."""

    PERFORMER = "performer"  # where the performer stands and faces: the armature object is placed and turned
    CHARACTER = "character"
    """Where the character stands: its object stays, the motion begins there and is turned to its facing."""


class LimbKeys(Enum):
    """Which controls of a limb are keyed, and which of them shows."""

    FK = "fk"
    IK = "ik"
    BOTH = "both"  # both, showing IK


@dataclass(frozen=True)
class RetargetOptions:
    """Options of a retargeted motion."""

    root_motion: RootMotion = RootMotion.AS_FILMED
    placement: Placement = Placement.PERFORMER
    arms: LimbKeys = LimbKeys.BOTH
    legs: LimbKeys = LimbKeys.BOTH  # A limb without IK controls is keyed in FK whatever is chosen
    plant_feet: bool = True
    reach_hands: bool = True
    tolerance_m: float | None = 0.005
    """Largest distance of any joint, end or sole of the character from the motion [m]; None for a key on
    every frame."""


# --- Options of retargeting from the words of files and of the command line


def retarget_options(words: CharacterOptions) -> RetargetOptions:
    """The options that words ask for."""
    return RetargetOptions(
        root_motion=RootMotion(words.root_motion.replace("-", "_")),
        placement=Placement(words.place),
        arms=LimbKeys(words.arms),
        legs=LimbKeys(words.legs),
        plant_feet=words.plant_feet,
        reach_hands=words.reach_hands,
        tolerance_m=words.tolerance_mm / 1000.0 if words.tolerance_mm > 0.0 else None,
    )
