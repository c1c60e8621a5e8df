"""A character map with every field."""

from dataclasses import replace

from _characters import plain_character, plain_map
from keymark.core.retarget.character_map import CharacterMap, IkControls, RoleBones, Setting, Switch


def full_map() -> CharacterMap:
    """A map of a plain character with controls, settings, soles and whatever else a map may hold."""
    plain = plain_map(plain_character(root="root"))
    roles = dict(plain.roles)
    roles["spine"] = RoleBones(("spine", "chest"), 0.8, "names", (0.25, 1.0))
    roles["toe.L"] = RoleBones(("toe.L",), 0.4, "shape")
    return replace(
        plain,
        title="Anna, größer",
        roles=roles,
        fk={"hips": ("torso",), "spine": (None, "chest control")},
        ik={
            "arm.L": IkControls("hand_ik.L", "elbow.L", None, Switch("hand_ik.L", 'IK "FK"', 0.0, 1.0)),
            "leg.R": IkControls("foot_ik.R", toe="toe_ik.R"),
        },
        settings=(
            Setting("torso", "neck_follow", 1.0),
            Setting("torso", "torso_parent", 2),
            Setting("hand_ik.L", "pole_vector", True),
        ),
        root="root",
        soles={"foot.L": ((0.1, 0.02, 0.0), (0.1, -0.1, 0.0)), "toe.L": ((0.105, -0.19, 0.0),)},
        rest_corrections={"upper_arm.L": (0.8, 0.0, 0.6, 0.0)},
        left_alone=("neck", "head"),
        preset="rigify",
        author="A. Person",
        license="CC0-1.0",
        description="For tests.",
        tags=("cartoon",),
    )
