"""A motion is brought onto characters of many makes, as Blender shows it, and leaves no other trace."""

from collections.abc import Callable
from dataclasses import replace

import bpy
import numpy as np
import pytest
from _armatures import build_character, retargeted
from _characters import plain_character, plain_map, shared_characters
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.errors import InputError
from keymark.core.keys.hermite import Spline
from keymark.core.progress import run
from keymark.core.retarget.character import Character
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.take.conversion_settings import LimbKeys, Placement, RetargetOptions, RootMotion
from keymark.operators.bridge.actions import curves_of, existing_channelbag
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.character.retarget import Retargeted, retarget
from scipy.spatial.transform import Rotation

FRAMES = 40
DENSE = RetargetOptions(tolerance_mm=0.0)


def shown(character: bpy.types.Object, made: Retargeted) -> dict[str, np.ndarray]:
    """(F, 4, 4) poses of the bones with roles, as Blender evaluates them."""
    found: dict[str, list[np.ndarray]] = {bone: [] for bone in made.motion.poses}
    for frame in made.keys.frames:
        bpy.context.scene.frame_set(int(frame))
        evaluated = character.evaluated_get(bpy.context.evaluated_depsgraph_get())
        for bone, poses in found.items():
            poses.append(np.array(evaluated.pose.bones[bone].matrix))
    return {bone: np.array(poses) for bone, poses in found.items()}


def farthest_m(character: bpy.types.Object, made: Retargeted) -> float:
    """Largest distance of any joint between what was solved and what Blender shows."""
    poses = shown(character, made)
    off = [poses[bone][:, :3, 3] - wanted[:, :3, 3] for bone, wanted in made.motion.poses.items()]
    return float(made.character.scale * np.linalg.norm(off, axis=-1).max())


def plain(**shape: object) -> tuple[bpy.types.Object, CharacterMap]:
    """A plain character in Blender and its map."""
    made = plain_character(**shape)  # type: ignore[arg-type]
    known = plain_map(made)
    if "root" in shape:
        known = replace(known, root=str(shape["root"]))
    return build_character(made), known


def on_root() -> tuple[bpy.types.Object, CharacterMap]:
    """Feet that hang on the root, as in many a game rig."""
    made = plain_character(root="root")
    bones = [replace(bone, parent=0) if bone.name.startswith("foot") else bone for bone in made.bones]
    return build_character(Character("Robot", tuple(bones))), plain_map(made)


def turned_object() -> tuple[bpy.types.Object, CharacterMap]:
    """An object that stands askew, by quaternions, on a parent of another size."""
    made, known = plain()
    parent = bpy.data.objects.new("Stand", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale, parent.rotation_euler, parent.location = (2.0,) * 3, (0.3, 0.2, 1.0), (1.0, 0.0, 2.0)
    made.parent, made.scale = parent, (0.5,) * 3
    made.rotation_mode, made.rotation_quaternion = "QUATERNION", (0.7, 0.1, 0.3, 0.5)
    made.delta_location, made.delta_rotation_quaternion = (0.1, 0.2, 0.3), (0.9, 0.1, -0.2, 0.3)
    bpy.context.view_layer.update()
    return made, known


def about_an_axis() -> tuple[bpy.types.Object, CharacterMap]:
    """An object that stands by axis and angle, in which mode Blender leaves the delta of other modes out."""
    made, known = plain()
    made.delta_rotation_euler = (0.2, 0.1, 0.4)
    made.rotation_mode, made.rotation_axis_angle = "AXIS_ANGLE", (1.3, 0.2, 0.4, 0.8)
    bpy.context.view_layer.update()
    return made, known


def in_modes() -> tuple[bpy.types.Object, CharacterMap]:
    """Bones in every rotation mode."""
    made, known = plain()
    modes = ("XYZ", "ZYX", "YXZ", "AXIS_ANGLE", "QUATERNION", "XZY", "ZXY", "YZX")
    for number, bone in enumerate(made.pose.bones):
        bone.rotation_mode = modes[number % len(modes)]
    return made, known


def with_flags() -> tuple[bpy.types.Object, CharacterMap]:
    """Bones that inherit no rotation, move along their parent's axes, and an ancestor that is posed."""
    made, known = plain(root="root")
    for name in ("shin.L", "forearm.R", "chest"):
        made.data.bones[name].use_inherit_rotation = False
    for name in ("hips", "shin.L"):
        made.data.bones[name].use_local_location = False
    made.data.bones["thigh.R"].inherit_scale = "NONE"
    made.pose.bones["root"].location = (0.2, 0.1, -0.3)
    made.pose.bones["root"].rotation_quaternion = (0.9, 0.2, 0.3, 0.1)
    bpy.context.view_layer.update()
    return made, known


@pytest.mark.parametrize(
    "make",
    [
        plain,
        lambda: plain(scale=0.01, arms_down_deg=50.0, roll_rad=1.2),
        lambda: plain(turn=Rotation.from_euler("xyz", [90, 0, 35], degrees=True).as_matrix()),
        lambda: plain(without=("shoulder", "toe", "neck")),
        on_root,
        turned_object,
        about_an_axis,
        in_modes,
        with_flags,
    ],
)
def test_blender_shows_what_was_solved(
    make: Callable[[], tuple[bpy.types.Object, CharacterMap]], source: SegmentMotion
) -> None:
    character, known = make()
    modes = [bone.rotation_mode for bone in character.pose.bones]
    made = retargeted(character, known, source, DENSE)
    assert farthest_m(character, made) < 1e-4
    assert modes == [bone.rotation_mode for bone in character.pose.bones]
    assert made.notes == ()
    few = retargeted(character, known, source, RetargetOptions())
    assert farthest_m(character, few) < 0.005
    assert few.quality.keys < 0.4 * made.quality.keys
    assert few.quality.keys == sum(values.size for one in few.keys.controls for values in one.values)
    assert few.quality.skate_mm is None or few.quality.skate_mm < 0.08
    assert few.quality.penetration_mm is not None and few.quality.penetration_mm < 2.0


def test_bones_scaled_in_the_pose_are_keyed_at_one(source: SegmentMotion) -> None:
    character, known = plain(root="root")
    for name, scale in (("root", 1.2), ("hips", 0.8), ("head", 1.3), ("finger.L", 2.0)):
        character.pose.bones[name].scale = (scale,) * 3
    made = retargeted(character, known, source, DENSE)
    assert farthest_m(character, made) < 1e-4
    assert [note for note in made.notes if "Scaled in its pose: bone 'hips', 'root', 'head'" in note]
    assert character.pose.bones["finger.L"].scale[0] == 2.0
    action = character.animation_data.action
    curve = next(
        one for one in existing_channelbag(action, character).fcurves if one.data_path.endswith("scale")
    )
    assert [point.co[1] for point in curve.keyframe_points] == [1.0]
    bones = {name: character.pose.bones[name].scale[0] for name in ("root", "hips", "head")}
    assert set(bones.values()) == {1.0}
    made.write(bpy.context.scene, action)
    assert farthest_m(character, made) < 1e-4


def test_the_character_stands_where_the_performer_does(source: SegmentMotion) -> None:
    character, known = turned_object()
    made = retargeted(character, known, source, DENSE)
    bpy.context.scene.frame_set(11)
    hips = character.matrix_world @ character.pose.bones["hips"].head
    thighs = 0.5 * (source.start["thigh.L"] + source.start["thigh.R"])[0]
    assert np.linalg.norm((np.array(hips) - thighs)[:2]) < 0.08
    assert character.scale[0] == pytest.approx(0.5)
    assert made.keys.placement
    character, known = plain()
    character.location = (3.0, 1.0, 0.0)
    bpy.context.view_layer.update()
    made = retargeted(character, known, source, replace(DENSE, place=Placement.CHARACTER))
    assert made.keys.placement == ()
    assert tuple(character.location) == (3.0, 1.0, 0.0)


def test_the_way_goes_onto_the_root_bone(source: SegmentMotion) -> None:
    character, known = plain(root="root")
    options = replace(DENSE, root_motion=RootMotion.ROOT_BONE)
    made = retargeted(character, known, source, options)
    root = next(one for one in made.keys.controls if one.control.name == "root")
    assert root.location is not None
    assert np.ptp(np.asarray(root.location), axis=0).max() > 0.05
    assert farthest_m(character, made) < 1e-4


def test_connected_bones_cannot_be_moved_and_it_is_said(source: SegmentMotion) -> None:
    made = plain_character()
    bones = [
        replace(bone, connected=True) if bone.name.startswith(("shin", "foot")) else bone
        for bone in made.bones
    ]
    character = build_character(Character("Connected", tuple(bones)))
    assert character.data.bones["foot.L"].use_connect
    done = retargeted(character, plain_map(made), source, DENSE)
    assert farthest_m(character, done) < 1e-4  # nothing needs to move
    assert all(one.location is None for one in done.keys.controls if one.control.name != "hips")


def test_what_keeps_bones_from_their_poses_is_said(source: SegmentMotion) -> None:
    character, known = plain()
    bones = character.pose.bones
    bones["shin.L"].lock_rotation = (False, True, True)
    bones["neck"].constraints.new("LIMIT_ROTATION").use_limit_x = True
    bones["head"].driver_add("rotation_quaternion", 1).driver.expression = "0.1"
    made = retargeted(character, known, source, RetargetOptions())
    said = "\n".join(made.notes)
    assert "Drivers win over the keys of bone 'head'" in said
    assert "Constraints change the keyed pose of bone 'neck'" in said
    assert "Locked and keyed all the same: bone 'shin.L'" in said
    curves = character.animation_data.action.layers[0].strips[0].channelbags[0].fcurves
    assert curves.find('pose.bones["head"].rotation_quaternion', index=1) is None
    assert curves.find('pose.bones["head"].rotation_quaternion', index=2) is not None


@pytest.fixture
def known(rigify: bpy.types.Object) -> CharacterMap:
    """The map of Rigify's basic human."""
    return recognize(read_character(rigify)).character_map


def test_a_control_rig_performs_in_ik_and_in_fk(
    rigify: bpy.types.Object, known: CharacterMap, source: SegmentMotion
) -> None:
    before = {key: rigify.pose.bones["thigh_parent.L"][key] for key in ("IK_FK", "IK_Stretch", "pole_vector")}
    made = retargeted(rigify, known, source, RetargetOptions(arms=LimbKeys.BOTH, legs=LimbKeys.BOTH))
    quality = made.quality
    assert quality.ik_fk_mm is not None and 0.01 < quality.ik_fk_mm < 1.0
    assert quality.skate_mm is not None and quality.skate_mm < 0.05
    assert quality.penetration_mm is not None and quality.penetration_mm < 2.0
    assert quality.legs_deg is not None and quality.legs_deg < 3.0
    assert made.quality.keys < 0.3 * made.quality.dense_keys
    modes = {bone: rigify.pose.bones[bone].rotation_mode for bone in ("shoulder.L", "torso")}
    assert modes == {"shoulder.L": "YXZ", "torso": "QUATERNION"}
    action = rigify.animation_data.action
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    switch = curves.find('pose.bones["thigh_parent.L"]["IK_FK"]')
    assert [tuple(key.co) for key in switch.keyframe_points] == [(11.0, 0.0)]
    rigify.animation_data.action = None
    assert before["IK_FK"] == 0.0


@pytest.mark.parametrize("kind", ["Rigify", "mixamo"])
def test_the_median_curve_has_a_key_in_a_fifth_of_the_frames(
    rigify: bpy.types.Object, source: SegmentMotion, kind: str
) -> None:
    others = shared_characters()
    if kind not in {"Rigify", *others}:
        pytest.skip("no shared characters")
    character = rigify if kind == "Rigify" else build_character(others[kind])
    made = retargeted(
        character, recognize(read_character(character)).character_map, source, RetargetOptions()
    )
    curves = curves_of(character.animation_data.action, character).values()
    keys = np.median([len(curve.keyframe_points) for curve in curves])
    assert 2 < keys <= 0.2 * len(made.keys.frames)
    assert made.quality.skate_mm is not None and made.quality.skate_mm < 0.1


@pytest.mark.parametrize("keys", [LimbKeys.FK, LimbKeys.IK])
def test_limbs_are_keyed_in_one_way_alone(
    rigify: bpy.types.Object, known: CharacterMap, source: SegmentMotion, keys: LimbKeys
) -> None:
    made = retargeted(rigify, known, source, RetargetOptions(arms=keys, legs=keys))
    names = {one.control.name for one in made.keys.controls}
    assert ("thigh_fk.L" in names) == (keys is LimbKeys.FK)
    assert ("foot_ik.L" in names) == (keys is LimbKeys.IK)
    assert made.keys.properties["thigh_parent.L", "IK_FK"] == (1.0 if keys is LimbKeys.FK else 0.0)
    ankles = ("ORG-foot.L", "ORG-foot.R", "ORG-hand.L", "ORG-hand.R")
    poses = shown(rigify, made)
    for bone in ankles:
        off = poses[bone][:, :3, 3] - made.motion.poses[bone][:, :3, 3]
        assert np.linalg.norm(off, axis=-1).max() < 0.006


def test_retargeting_leaves_no_trace_until_it_is_written(
    rigify: bpy.types.Object,
    known: CharacterMap,
    source: SegmentMotion,
    state: Callable[[bpy.types.Object], object],
) -> None:
    action = bpy.data.actions.new("Own")
    slot = action.slots.new(id_type="OBJECT", name="Other")
    data = rigify.animation_data_create()
    data.action, data.action_slot = action, slot
    rigify.pose.bones["hips"].rotation_quaternion = (0.9, 0.1, 0.2, 0.3)
    rigify.pose.bones["hand_ik.L"].location = (0.1, 0.02, 0.3)
    bpy.context.scene.frame_set(7, subframe=0.25)
    bpy.context.view_layer.update()
    before = state(rigify)
    job = retarget(rigify, source, 11.0 + np.arange(FRAMES), known, RetargetOptions())
    stages = {next(job).stage for _ in range(40)}
    assert len(stages) > 3
    job.close()
    assert state(rigify) == before
    stages = set()
    run(
        retarget(rigify, source, 11.0 + np.arange(FRAMES), known, RetargetOptions()),
        lambda progress: stages.add(progress.stage),
    )
    assert "Measuring the character" in stages
    assert state(rigify) == before


def test_written_again_only_what_retargeting_made_is_replaced(source: SegmentMotion) -> None:
    character, known = plain()
    made = retargeted(character, known, source, RetargetOptions())
    action = character.animation_data.action
    assert action.use_frame_range and tuple(action.frame_range) == (11.0, 50.0)
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    own = curves.new('pose.bones["finger.L"].rotation_quaternion', index=2)
    own.keyframe_points.insert(3.0, 0.25)
    keys = {(curve.data_path, curve.array_index): len(curve.keyframe_points) for curve in curves}
    character.pose.bones["head"].rotation_mode = "XYZ"
    again = run(retarget(character, source, made.keys.frames, known, RetargetOptions()))
    assert again.write(bpy.context.scene, action) == action
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    paths = {(curve.data_path, curve.array_index): len(curve.keyframe_points) for curve in curves}
    assert ('pose.bones["finger.L"].rotation_quaternion', 2) in paths
    assert ('pose.bones["head"].rotation_quaternion', 0) not in paths
    assert ('pose.bones["head"].rotation_euler', 0) in paths
    assert paths['pose.bones["hips"].location', 0] == keys['pose.bones["hips"].location', 0]


def test_few_keys_are_splines_of_rotation_and_location_apart(source: SegmentMotion) -> None:
    character, known = plain()
    made = retargeted(character, known, source, RetargetOptions())
    hips = next(one for one in made.keys.controls if one.control.name == "hips")
    assert isinstance(hips.rotation, Spline) and isinstance(hips.location, Spline)
    assert len(hips.rotation.keys) < len(hips.location.keys)


def test_bad_input_is_refused(source: SegmentMotion) -> None:
    character, known = plain()
    frames = 1.0 + np.arange(FRAMES)
    other = replace(known, root="Wurzel")
    with pytest.raises(InputError, match="Wurzel"):
        run(retarget(character, source, frames, other, DENSE))
    with pytest.raises(InputError, match="single frame"):
        run(retarget(character, source, frames[:1], known, DENSE))
    made = run(retarget(character, source, frames, known, DENSE))
    character.constraints.new("LIMIT_LOCATION").name = "Fence"
    with pytest.raises(InputError, match="'Fence'"):
        run(retarget(character, source, frames, known, DENSE))
    run(retarget(character, source, frames, known, replace(DENSE, place=Placement.CHARACTER)))
    bpy.data.objects.remove(character)
    with pytest.raises(InputError, match="deleted meanwhile"):
        made.write(bpy.context.scene, "Steps")
