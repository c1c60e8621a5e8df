"""A whole session with Keymark as a script: from an empty scene to an asset and a file for other programs.

Usage: blender --background --addons bl_ext.user_default.keymark --python docs/session.py -- FOLDER [LIBRARY]

Each call does what a button of the sidebar does. FOLDER gets `session.blend` and `motion.bvh`. The clip is
that of the demonstration take, whose shipped poses replace an animator's. With a LIBRARY, as in `aerobic`,
nothing is posed: its postures are found in the footage, or those of all libraries with `auto`. At the end
another character performs the motion: a skeleton that stands in for a rig of yours.
"""

import sys
from math import radians
from pathlib import Path

import bpy

DEMO = Path(__file__).resolve().parent.parent / "presets" / "demo" / "aerobic"
CAMERA_LOCATION = (0.75, -4.15, 1.32)
CAMERA_ROTATION = (radians(86.08), 0.0, radians(6.92))
LENS_MM, SENSOR_MM = 47.0, 36.0
SLEEVES = {
    "trunk": (134, 105),
    "forearm.L": (158, 124),
    "forearm.R": (109, 123),
    "shin.L": (146, 191),
    "shin.R": (125, 192),
}
"""A pixel of each sleeve in the clip's first frame, from the top left corner."""
HEIGHT_M = 1.684
LENGTHS_M = {
    "upper_arm_L": 0.292,
    "forearm_L": 0.249,
    "hand_L": 0.176,
    "thigh_L": 0.418,
    "shin_L": 0.409,
    "foot_L": 0.185,
    "shoulder_width": 0.345,
    "hip_width": 0.184,
    "trunk": 0.482,
    "neck_head": 0.238,
}
"""Lengths of the left side and the middle; the right side's follow the left's."""
SKELETON = {
    "Hips": (None, (0.0, 0.02, 0.62), (0.0, 0.02, 0.7)),
    "Spine": ("Hips", (0.0, 0.02, 0.7), (0.0, 0.02, 0.84)),
    "Chest": ("Spine", (0.0, 0.02, 0.84), (0.0, 0.02, 0.98)),
    "Neck": ("Chest", (0.0, 0.02, 0.98), (0.0, 0.01, 1.05)),
    "Head": ("Neck", (0.0, 0.01, 1.05), (0.0, 0.0, 1.25)),
    "Clavicle.L": ("Chest", (0.02, 0.02, 0.95), (0.12, 0.03, 0.95)),
    "UpperArm.L": ("Clavicle.L", (0.12, 0.03, 0.95), (0.27, 0.04, 0.8)),
    "Forearm.L": ("UpperArm.L", (0.27, 0.04, 0.8), (0.4, 0.02, 0.67)),
    "Hand.L": ("Forearm.L", (0.4, 0.02, 0.67), (0.48, 0.0, 0.59)),
    "Thigh.L": ("Hips", (0.08, 0.02, 0.6), (0.09, 0.01, 0.33)),
    "Shin.L": ("Thigh.L", (0.09, 0.01, 0.33), (0.1, 0.03, 0.07)),
    "Foot.L": ("Shin.L", (0.1, 0.03, 0.07), (0.1, -0.07, 0.02)),
    "Toe.L": ("Foot.L", (0.1, -0.07, 0.02), (0.1, -0.13, 0.02)),
}
"""Parent, head and tail of the bones of a child's skeleton with its arms half down, left side and middle."""


def active_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The active take; get it again after adding or removing takes, because Blender moves them in memory."""
    return scene.keymark.takes[scene.keymark.active_take]


def load_footage(scene: bpy.types.Scene) -> None:
    """Step 1, clip: load the clip and put its camera where the real one stood."""
    bpy.ops.keymark.load_footage(filepath=str(DEMO / "clip.mp4"))
    take = active_take(scene)
    take.camera.location, take.camera.rotation_euler = CAMERA_LOCATION, CAMERA_ROTATION
    take.camera.data.lens, take.camera.data.sensor_width = LENS_MM, SENSOR_MM


def pick_markers(take: bpy.types.PropertyGroup) -> None:
    """Step 2, what is followed: pick the usual five markers, each by one click on the footage in frame 1.

    In plain clothes `bpy.ops.keymark.load_keypoints(filepath=...)` takes its place.
    """
    clicks = [{"name": segment, "loc": pixel, "time": 1.0} for segment, pixel in SLEEVES.items()]
    bpy.ops.keymark.pick_markers(clicks=clicks)
    for marker in take.markers:
        print(f"{marker.name}: found in {marker.found} of {marker.sampled} frames")


def build_actor(take: bpy.types.PropertyGroup) -> None:
    """Step 2, performer: build the actor from the height, where they stand; then set the measured lengths."""
    bpy.ops.keymark.build_actor(stature=HEIGHT_M)
    for name, length in LENGTHS_M.items():
        setattr(take.lengths, name, length)
    bpy.ops.keymark.apply_lengths()


def animator(scene: bpy.types.Scene) -> tuple[bpy.types.Object, list[int]]:
    """The stand-in for an animator: an actor already posed over the footage, and the posed frames."""
    mine = scene.keymark.active_take
    bpy.ops.keymark.open_take(filepath=str(DEMO / "take.json"))
    theirs = active_take(scene)
    first_curve = theirs.keyframe_action.layers[0].strips[0].channelbags[0].fcurves[0]
    frames = [round(key.co.x) for key in first_curve.keyframe_points]
    armature = theirs.armature
    bpy.ops.keymark.remove_take()  # the objects stay
    scene.keymark.active_take = mine
    return armature, frames


def pose_keyframes(scene: bpy.types.Scene) -> None:
    """Step 3, poses: propose frames; then fit, correct and store the pose of each."""
    bpy.ops.keymark.propose_keyframes()
    print("Proposed:", sorted(proposal.frame for proposal in active_take(scene).proposals))
    hand, frames = animator(scene)
    take = active_take(scene)
    for frame in frames:
        scene.frame_set(frame)
        bpy.ops.keymark.fit_pose(start="KEYFRAMES")  # a start to correct
        for bone in take.armature.pose.bones:  # the animator corrects it, in depth too
            bone.matrix_basis = hand.pose.bones[bone.name].matrix_basis
        bpy.ops.keymark.store_keyframe()
    bpy.data.objects.remove(hand)


def find_keyframes(scene: bpy.types.Scene, library: str) -> None:
    """Step 3 without posing: keyframes found with all libraries or a named one; correct the doubtful ones."""
    bpy.ops.keymark.pose_all(library=library)
    for match in active_take(scene).matching.matches:
        print(f"Frame {match.frame:g}: {match.candidate.name}, {match.confidence:.0%}")


def build_child(scene: bpy.types.Scene) -> bpy.types.Object:
    """The stand-in for your own character; a rig with controls, linked or appended, does as well."""
    armature = bpy.data.armatures.new("Child")
    child = bpy.data.objects.new("Child", armature)
    scene.collection.objects.link(child)
    bpy.context.view_layer.objects.active = child
    bpy.ops.object.mode_set(mode="EDIT")
    for name, (parent, head, tail) in SKELETON.items():
        for side, sign in (("L", 1.0), ("R", -1.0)) if name.endswith(".L") else ((None, 1.0),):
            bone = armature.edit_bones.new(name if side is None else f"{name[:-1]}{side}")
            bone.head, bone.tail = ((sign * end[0], *end[1:]) for end in (head, tail))
            above = f"{parent[:-1]}{side}" if parent and parent.endswith(".L") else parent
            bone.parent = armature.edit_bones[above] if above else None
    bpy.ops.object.mode_set(mode="OBJECT")
    return child


def let_perform(character: bpy.types.Object) -> None:
    """Step 5, character: recognize its bones, and give it the newest motion as an Action of its own."""
    bpy.ops.keymark.add_character(armature=character.name)
    added = active_take(bpy.context.scene).characters[0]
    for role in added.character_map.roles:
        print(f"{role.name}: {', '.join(entry.bone for entry in role.bones)} {role.doubt}")
    bpy.ops.keymark.retarget()
    for line in added.results[0].lines:
        print(line.text)


def session(scene: bpy.types.Scene, folder: Path, library: str = "") -> bpy.types.PropertyGroup:
    """All six steps; returns the take."""
    load_footage(scene)
    pick_markers(active_take(scene))
    build_actor(active_take(scene))
    if library:
        find_keyframes(scene, library)
    else:
        pose_keyframes(scene)
    bpy.ops.keymark.reconstruct()  # step 4: a new Action; the keyframes stay in theirs
    take = active_take(scene)
    for weak in take.review.weak_frames:  # the review
        print(f"Frame {weak.frame} is worth another keyframe")
    take.finish.tolerance_mm = 5.0
    bpy.ops.keymark.bake_motion()  # step 6, export: few keys, resting feet stand still
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "session.blend"))  # catalogs lie beside the file
    bpy.ops.keymark.mark_asset()
    bpy.ops.keymark.export_motion(format="BVH", filepath=str(folder / "motion.bvh"))
    let_perform(build_child(scene))
    bpy.ops.keymark.mark_result_asset()
    bpy.ops.wm.save_mainfile()
    return active_take(scene)


if __name__ == "__main__":
    folder_name, *libraries = sys.argv[sys.argv.index("--") + 1 :]
    output = Path(folder_name).resolve()
    output.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    session(bpy.context.scene, output, *libraries)
