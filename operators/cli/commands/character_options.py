"""Options that the commands for characters share: the character, its map, and how a motion is put onto it."""

import argparse

from ....core.take.character_words import LIMB_KEYS, PLACEMENTS, ROOT_MOTIONS

CHARACTER_HELP = (
    "the character's file (.blend, .fbx, .glb, .gltf or .vrm), and after a colon the name of its armature "
    "where it has several"
)
MAP_HELP = (
    "character map, by title or file; auto, the default: a saved one that knows the character's bones, else "
    "recognition; none: recognition"
)


def add_retarget_options(parser: argparse.ArgumentParser) -> None:
    """Add how the motion is put onto the character."""
    parser.add_argument(
        "--limbs",
        choices=LIMB_KEYS,
        help="controls of arms and legs that are keyed; both, the default, shows IK. A limb without IK "
        "controls is keyed in FK",
    )
    parser.add_argument("--arms", choices=LIMB_KEYS, help="of the arms, where it is not that of --limbs")
    parser.add_argument("--legs", choices=LIMB_KEYS, help="of the legs, where it is not that of --limbs")
    parser.add_argument(
        "--root-motion",
        choices=ROOT_MOTIONS,
        default=ROOT_MOTIONS[0],
        help="where the way over the ground goes: on the hips, nowhere, or on the root bone "
        "(default: %(default)s)",
    )
    parser.add_argument(
        "--place",
        choices=PLACEMENTS,
        default=PLACEMENTS[0],
        help="where the character performs: where the performer stood and faced, or where it stands itself "
        "(default: %(default)s)",
    )
    parser.add_argument("--no-plant-feet", action="store_true", help="let resting feet move")
    parser.add_argument(
        "--no-reach-hands", action="store_true", help="let hands miss what the performer's reached"
    )
    parser.add_argument(
        "--tolerance",
        metavar="MM|none",
        default="5",
        help="largest distance of any joint from the motion in millimeters, for few keys; none keeps a key "
        "on every frame (default: %(default)s)",
    )
