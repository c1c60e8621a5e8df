"""The five parts of the body that move about independently: the trunk with the head, arms and legs."""

TRUNK = "trunk"
LIMBS = ("arm.L", "arm.R", "leg.L", "leg.R")
_STEMS = {
    "arm": ("upper_arm", "forearm", "hand", "elbow", "wrist", "index", "thumb", "pinky"),
    "leg": ("thigh", "shin", "foot", "knee", "ankle", "heel", "toe", "small_toe"),
}
_LIMB_OF = {stem: limb for limb, stems in _STEMS.items() for stem in stems}


def limb_of(name: str) -> str:
    """The part of the body that a segment or a point of the body belongs to: `arm.L` ... `leg.R` or `trunk`.

    Shoulders and hips are the trunk's.
    """
    stem, _, side = name.partition(".")
    limb = _LIMB_OF.get(stem)
    return TRUNK if limb is None else f"{limb}.{side}"
