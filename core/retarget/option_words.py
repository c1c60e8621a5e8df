"""Options of retargeting from the words of files and of the command line."""

from ..take.character_settings import CharacterOptions
from .options import LimbKeys, Placement, RetargetOptions, RootMotion

MM = 1000.0


def retarget_options(words: CharacterOptions) -> RetargetOptions:
    """The options that words ask for."""
    return RetargetOptions(
        root_motion=RootMotion(words.root_motion.replace("-", "_")),
        placement=Placement(words.place),
        arms=LimbKeys(words.arms),
        legs=LimbKeys(words.legs),
        plant_feet=words.plant_feet,
        reach_hands=words.reach_hands,
        tolerance_m=words.tolerance_mm / MM if words.tolerance_mm > 0.0 else None,
    )
