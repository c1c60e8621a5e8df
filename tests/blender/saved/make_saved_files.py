"""How the files in the folders beside this one were made: those of `0.1.0` by Keymark 0.1.0 in Blender 4.5.

Usage: python tests/blender/saved/make_saved_files.py FOLDER, with the Python of .venv-test

They are not to be made again: `test_files_of_earlier_versions.py` opens what that version has written. The
script stays to show how, and to make the like with a later version; so it asks for nothing but operators.
FOLDER gets `scene.blend` with what it holds in `scene.json`, `gestures.json`, which is the library made in
that scene, and `shoot`, whose one take is the scene's, with the record of its conversion in `results`.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import bpy
import cv2
import numpy as np
from mathutils import Matrix, Vector

TESTS = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TESTS))

from _boot import load_package  # noqa: E402

FRAMES, FPS, SIZE = 32, 20.0, (160, 120)
STATURE_M = 1.72
LENS_MM, SENSOR_MM = 36.0, 36.0
CAMERA_PLACE, CAMERA_TURN = (0.0, -4.2, 1.0), (np.pi / 2.0, 0.0, 0.0)
STEPS = {
    1: "standing",
    5: "knee lift: rising left",
    9: "knee lift: high left",
    13: "knee lift: rising left",
    17: "standing",
    21: "knee lift: rising right",
    25: "knee lift: high right",
    29: "knee lift: rising right",
    32: "standing",
}
"""What the performer does, by frame: postures of the library `aerobic`."""
POSED = (1, 17)
"""The frames that an animator has posed."""
WORN = {
    "trunk": (30, 140, 60),
    "forearm.L": (220, 40, 40),
    "forearm.R": (40, 70, 220),
    "shin.L": (230, 200, 30),
    "shin.R": (200, 50, 200),
}
HIDDEN = ("forearm.R", range(20, 28))
"""A marker, and the frames in which nothing is seen of its color."""
REMOVED = (22.0, 27.0)
"""Frames whose match the animator does not want."""
BARE = (80, 78, 75)
WIDTHS_PX = {"thigh": 9, "shin": 7, "upper_arm": 6, "forearm": 5, "head": 11}
CURVES_AT = (1.0, 14.5, 25.0)
"""Frames at which every curve's value is noted."""
PREVIEW_PX = 16
DIGITS = 5
UNSAID = ("rna_type", "turns")
"""Properties that are not noted: what Blender adds, and joint angles, which the Actions' curves show."""
CLIP_TIME_S = 1_600_000_000
"""When the clip was changed last; clips are known again by that, too."""

Color = tuple[int, int, int]
Poses = dict[int, dict[str, Matrix]]


def empty_scene() -> bpy.types.Scene:
    """A scene without anything in it."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene


def active_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The take at work."""
    return scene.keymark.takes[scene.keymark.active_take]


def perform(clip: Path) -> Poses:
    """Film an actor that goes through the steps; returns its pose at every posed frame, by bone."""
    scene = empty_scene()
    bpy.ops.keymark.build_actor(stature=STATURE_M)
    for frame, posture in STEPS.items():
        scene.frame_set(frame)
        bpy.ops.keymark.apply_posture(library="aerobic", posture=posture, place="WORLD")
        bpy.ops.keymark.store_keyframe()
    actor = active_take(scene).armature
    noise = np.random.default_rng(5)
    writer = cv2.VideoWriter(str(clip), cv2.VideoWriter.fourcc(*"mp4v"), FPS, SIZE)
    if not writer.isOpened():
        raise SystemExit(f"{clip} cannot be written")
    poses: Poses = {}
    for frame in range(1, FRAMES + 1):
        scene.frame_set(frame)
        shown = actor.evaluated_get(bpy.context.evaluated_depsgraph_get())
        marker, frames = HIDDEN
        writer.write(drawn(shown, {**WORN, marker: BARE} if frame in frames else WORN, noise))
        if frame in POSED:
            poses[frame] = {bone.name: bone.matrix_basis.copy() for bone in actor.pose.bones}
    writer.release()
    os.utime(clip, (CLIP_TIME_S, CLIP_TIME_S))
    return poses


def pixel(point: Vector) -> tuple[float, float]:
    """Where the camera, which looks along +Y, sees a point of the world."""
    near = (point.x - CAMERA_PLACE[0], point.y - CAMERA_PLACE[1], point.z - CAMERA_PLACE[2])
    scale = SIZE[0] * LENS_MM / SENSOR_MM / near[1]
    return SIZE[0] / 2.0 + scale * near[0], SIZE[1] / 2.0 - scale * near[2]


def bone_ends(actor: bpy.types.Object, name: str) -> list[tuple[float, float]]:
    """Pixels of both ends of a bone."""
    bone = actor.pose.bones[name]
    return [pixel(actor.matrix_world @ end) for end in (bone.head, bone.tail)]


def drawn(actor: bpy.types.Object, worn: dict[str, Color], noise: np.random.Generator) -> np.ndarray:
    """The actor as thick lines, (height, width, 3) blue, green, red."""
    image = np.full((SIZE[1], SIZE[0], 3), 150, dtype=np.uint8)
    hips, neck = bone_ends(actor, "pelvis")[0], bone_ends(actor, "head")[0]
    lines = [([hips, neck], worn["trunk"], 15)]
    for bone in actor.pose.bones:
        width = WIDTHS_PX.get(bone.name.partition(".")[0])
        if width is not None:
            lines.append((bone_ends(actor, bone.name), worn.get(bone.name, BARE), width))
    for ends, color, width in lines:
        tips = [tuple(round(16.0 * (value - 0.5)) for value in end) for end in ends]
        cv2.line(image, tips[0], tips[1], color[::-1], width, cv2.LINE_AA, 4)
    return np.clip(image + noise.normal(0.0, 1.0, image.shape), 0, 255).astype(np.uint8)


def prepare(scene: bpy.types.Scene, clip: Path) -> None:
    """Footage, camera, markers with the colors they are filmed in, actor, proposals."""
    bpy.ops.keymark.load_footage(filepath=str(clip))
    take = active_take(scene)
    take.camera.location, take.camera.rotation_euler = CAMERA_PLACE, CAMERA_TURN
    take.camera.data.lens, take.camera.data.sensor_width = LENS_MM, SENSOR_MM
    bpy.ops.keymark.add_usual_markers()
    for marker in take.markers:
        marker.color = [value / 255.0 for value in WORN[marker.segment]]
    take.markers[1].name = "Red Sleeve"
    bpy.ops.keymark.check_markers()
    bpy.ops.keymark.build_actor(stature=STATURE_M)
    take = active_take(scene)
    take.lengths.symmetric = False
    take.lengths.hand_L = 0.195
    bpy.ops.keymark.apply_lengths()
    take.keyframe_count = 7
    bpy.ops.keymark.propose_keyframes()


def pose(scene: bpy.types.Scene, poses: Poses) -> None:
    """Key what an animator has posed, and let the rest be matched."""
    actor = active_take(scene).armature
    for frame, matrices in poses.items():
        scene.frame_set(frame)
        for name, matrix in matrices.items():
            actor.pose.bones[name].matrix_basis = matrix
        bpy.ops.keymark.store_keyframe()
    matching = active_take(scene).matching
    matching.library, matching.floor = "aerobic", "HEIGHT"
    bpy.ops.keymark.pose_all(library="aerobic", floor="HEIGHT", floor_height=0.0)
    for frame in REMOVED:
        matching = active_take(scene).matching
        matching.active_match = [match.frame for match in matching.matches].index(frame)
        bpy.ops.keymark.remove_match()
    active_take(scene).matching.active_match = 1
    bpy.ops.keymark.replace_match(candidate=0)


def finish(scene: bpy.types.Scene) -> None:
    """The motion, with its review, and the final Action."""
    bpy.ops.keymark.reconstruct()
    settings = active_take(scene).finish
    settings.tolerance_mm, settings.shared, settings.stray_mm = 12.0, "WHOLE_POSE", 30.0
    settings.tags, settings.author, settings.license = "keymark, knee lift", "A. Person", "CC-BY-4.0"
    settings.description, settings.catalog = "Knees lifted in turn", "Keymark/Aerobic"
    bpy.ops.keymark.bake_motion()


def make_library(scene: bpy.types.Scene) -> None:
    """A library of three postures and two motions."""
    bpy.ops.keymark.new_library(title="Gestures", author="A. Person", license="CC0-1.0")
    library = scene.keymark.libraries[0]
    library.description, library.tags, library.version = "Made to be opened later", "arms, knees", 3
    library.sources.add().text = "A short clip"
    for name, frame, tags in (("Upright", 1, "rest"), ("Left Knee", 9, "knee, left"), ("Right Knee", 25, "")):
        scene.frame_set(frame)
        bpy.ops.keymark.add_posture(posture=name, tags=tags)
    bpy.ops.keymark.add_motion(motion="Lift", duration_s=1.25)
    bpy.ops.keymark.add_motion(motion="March", duration_s=1.6, cyclic=True)
    march = scene.keymark.libraries[0].motions[1]
    march.travel_y, march.travel_turn = -0.4, 0.1


def dress(scene: bpy.types.Scene) -> None:
    """Settings unlike the defaults, views from other sides, and a second performer."""
    overlays, timeline = scene.keymark.overlays, scene.keymark.timeline
    overlays.show_paths, overlays.show_legend, overlays.path_points = True, False, {"ankle.L", "head"}
    overlays.path_before, overlays.path_after, overlays.opacity = 7, 9, 0.6
    overlays.line_width, overlays.uncertain_beyond = 2.5, 0.04
    timeline.show_speed, timeline.show_weak_frames = False, False
    bpy.ops.keymark.set_up_turntable(side="RIGHT", lens=40.0)
    views = active_take(scene).turntable
    views.reference_view, views.reference_offset = "FRONT", 3
    bpy.ops.keymark.add_performer()
    other = active_take(scene)
    other.name, other.method, other.stature, other.live_preview = "Partner", "ekf", 1.6, False
    other.finish.keys, other.finish.plant_feet = "EVERY_FRAME", False
    scene.keymark.active_take = 0
    scene.frame_set(5)


def held(scene: bpy.types.Scene) -> dict[str, Any]:
    """What the file holds: every property by its path, and what the data-blocks say."""
    properties: dict[str, Any] = {}
    add_group(properties, "keymark", scene.keymark)
    return {
        "clip_time_s": CLIP_TIME_S,
        "curves_at": CURVES_AT,
        "properties": properties,
        "scene": {
            "range": [scene.frame_start, scene.frame_end, scene.frame_current],
            "rate": scene.render.fps / scene.render.fps_base,
            "size": [scene.render.resolution_x, scene.render.resolution_y],
            "objects": sorted(thing.name for thing in scene.objects),
            "bones_m": bones_m(active_take(scene).armature),
        },
        "actions": {action.name: action_held(action) for action in bpy.data.actions},
    }


def add_group(found: dict[str, Any], path: str, group: bpy.types.PropertyGroup) -> None:
    """Note a group's properties and those of the groups in it."""
    for definition in group.bl_rna.properties:
        if definition.identifier in UNSAID:
            continue
        value, name = getattr(group, definition.identifier), f"{path}.{definition.identifier}"
        if definition.type == "COLLECTION":
            found[f"{name}.len"] = len(value)
            for number, item in enumerate(value):
                add_group(found, f"{name}[{number}]", item)
        elif isinstance(value, bpy.types.PropertyGroup):
            add_group(found, name, value)
        else:
            found[name] = plain(value)


def plain(value: Any) -> Any:
    """A property's value as JSON has it; a data-block by its name."""
    if isinstance(value, bpy.types.ID):
        return value.name
    if isinstance(value, set):
        return sorted(value)
    if isinstance(value, float):
        return round(value, DIGITS)
    if isinstance(value, bool | int | str) or value is None:
        return value
    return [round(part, DIGITS) for part in value]


def bones_m(armature_object: bpy.types.Object) -> dict[str, float]:
    """Length of each bone."""
    return {bone.name: round(bone.length, DIGITS) for bone in armature_object.data.bones}


def action_held(action: bpy.types.Action) -> dict[str, Any]:
    """An Action's curves, and what it is as an asset."""
    (bag,) = action.layers[0].strips[0].channelbags
    asset = action.asset_data
    return {
        "slot": action.slots[0].identifier,
        "asset": asset and [asset.author, asset.license, asset.catalog_id, [tag.name for tag in asset.tags]],
        "curves": [curve_held(curve) for curve in bag.fcurves],
    }


def curve_held(curve: bpy.types.FCurve) -> list[Any]:
    """A curve's path and index, how many keys of which types it has, and its value at some frames."""
    types = [key.type for key in curve.keyframe_points]
    counts = {kind: types.count(kind) for kind in sorted(set(types))}
    values = [round(curve.evaluate(frame), DIGITS) for frame in CURVES_AT]
    return [curve.data_path, curve.array_index, counts, values]


def save(folder: Path, scene: bpy.types.Scene) -> None:
    """Write the .blend, with pictures of assets that are no larger than they need be."""
    path = str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True, relative_remap=True)
    bpy.ops.keymark.mark_asset()
    for action in bpy.data.actions:
        if action.preview is not None:
            action.preview.image_size = (PREVIEW_PX, PREVIEW_PX)
    bpy.ops.wm.save_mainfile(compress=True)
    Path(f"{path}1").unlink()


def read_back(folder: Path) -> None:
    """Write down what the .blend holds when it is opened."""
    bpy.ops.wm.open_mainfile(filepath=str(folder / "scene.blend"))
    found = held(bpy.context.scene)
    text = json.dumps(found, separators=(",", ":"))
    (folder / "scene.json").write_text(text + "\n", encoding="utf-8")


def convert(folder: Path) -> None:
    """Convert the take with the library that was made; of the results only their record is kept."""
    from keymark.operators.cli.main import main

    shoot, results = folder / "shoot", folder / "results" / "take"
    fields = {"schema_version": 1, "root": True, "library": "gestures.json", "pictures": False}
    (shoot / "shoot.json").write_text(json.dumps(fields) + "\n", encoding="utf-8")
    words = ["convert", str(shoot / "take"), "--output", str(results), "--quiet"]
    if main(words) != 0:
        raise SystemExit("the take was not converted")
    for file in results.iterdir():
        if file.name != "conversion.json":
            file.unlink()


def make(folder: Path) -> None:
    """Make all files."""
    take = folder / "shoot" / "take"
    take.mkdir(parents=True)
    poses = perform(take / "clip.mp4")
    scene = empty_scene()
    prepare(scene, take / "clip.mp4")
    pose(scene, poses)
    finish(scene)
    make_library(scene)
    dress(scene)
    bpy.ops.keymark.export_library(filepath=str(folder / "shoot" / "gestures.json"))
    bpy.ops.keymark.save_take(directory=str(folder / "saved"))
    for name in ("take.json", "keyframes.json"):
        shutil.move(folder / "saved" / name, take / name)
    shutil.rmtree(folder / "saved")
    save(folder, scene)


if __name__ == "__main__":
    load_package().register()
    FOLDER = Path(sys.argv[1]).resolve()
    if sys.argv[2:] == ["read"]:
        read_back(FOLDER)
    else:
        make(FOLDER)
        convert(FOLDER)
        subprocess.run([sys.executable, __file__, str(FOLDER), "read"], check=True)
    sys.stdout.flush()
    os._exit(0)  # Blender's module may crash or hang where Python ends with operators registered
