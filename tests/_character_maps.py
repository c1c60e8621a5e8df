"""A character map and a record of retargeting with every field."""

from dataclasses import replace

from _characters import plain_character, plain_map
from keymark.core.retarget.maps.character_map import CharacterMap, IkControls, RoleBones, Setting, Switch
from keymark.core.retarget.retarget_record import RECOGNIZED, RetargetRecord, UsedCharacter, UsedMap
from keymark.core.take.character_settings import RetargetOptions


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


def full_record() -> RetargetRecord:
    """A record with every field."""
    return RetargetRecord(
        keymark="1.0.0",
        take="walk",
        character=UsedCharacter("anna.blend", "rig", "ef" * 32),
        map=UsedMap("Anna", RECOGNIZED, "rigify"),
        action="walk on rig",
        frames=8,
        frame_start=1,
        fps=30.0,
        size=0.987,
        options=RetargetOptions(root_motion="in-place", tolerance_mm=2.5),
        roles=full_map().roles,
        limbs={"arm.L": "fk", "leg.L": "both"},
        quality={"skate_mm_per_frame": 0.012, "hands_mm": None},
        doubts=("toe.L may be another bone",),
        notes=("A note.",),
        files={"character.blend": "ab" * 32},
    )
