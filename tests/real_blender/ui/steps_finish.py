"""The session's end: review, finish, and what the armature shows."""

import json

import bpy
import numpy as np
from driver import Steps, expect, turns
from person import Person
from steps_reconstruct import cancelled, job

ENDS = {
    "head": ("head", "tail"),
    "shoulder": ("upper_arm", "head"),
    "elbow": ("forearm", "head"),
    "wrist": ("forearm", "tail"),
    "hip": ("thigh", "head"),
    "knee": ("shin", "head"),
    "ankle": ("shin", "tail"),
}
"""The bone whose end each principal point is."""


LARGEST_CHANGE_MM = 15.0
"""Mean distance between final and reconstructed motion; feet that are planted move their legs."""


def review(person: Person) -> Steps[None]:
    """Look at the motion and at what Keymark says of it; compare it from the side."""
    review = person.take.review
    expect(review.frame_count == person.take.clip.frame_duration, "the motion has no review")
    expect(0.0 <= review.confidence <= 1.0, f"the confidence is {review.confidence}")
    middle = (person.scene.frame_start + person.scene.frame_end) // 2
    person.scene.frame_set(middle)
    person.step_done("Go to the middle")
    yield from person.look("review")
    if len(review.weak_frames):
        yield from person.hands.invoke("keymark.jump_to_weak_frame", direction="NEXT")
        worst = round(person.take.review.weak_frames[0].frame)
        expect(person.scene.frame_current == worst, f"the weakest frame is {worst}")
        yield from person.look("weak_frame")
        yield from person.undoable("adding a keyframe", lambda: _pose_weak_frame(person))
        yield from person.hands.undo()
    person.hands.area("DOPESHEET_EDITOR").ui_type = "FCURVES"
    yield from turns(3)
    yield from person.hands.move_over("GRAPH_EDITOR")
    yield from person.hands.press("HOME")
    yield from person.look("confidence_curves")
    person.hands.area("GRAPH_EDITOR").ui_type = "TIMELINE"
    yield from turns(3)
    yield from in_the_clip_editor(person)


def _pose_weak_frame(person: Person) -> Steps[None]:
    yield from person.hands.invoke("keymark.pose_from_motion", where="WEAK")
    yield from person.hands.move_over("VIEW_3D")
    yield from person.hands.press("RET")  # joints can be dragged at once


def in_the_clip_editor(person: Person) -> Steps[None]:
    """The Movie Clip editor shows the same over the clip as it was filmed."""
    area = person.hands.area("VIEW_3D")
    area.ui_type = "CLIP_EDITOR"
    yield from turns(3)
    person.hands.area("CLIP_EDITOR").spaces.active.clip = person.take.clip
    yield from person.hands.open_sidebar("CLIP_EDITOR", "Keymark")
    yield from person.hands.move_over("CLIP_EDITOR")
    yield from person.hands.press("HOME")
    yield from person.look("clip_editor")
    person.hands.area("CLIP_EDITOR").ui_type = "VIEW_3D"
    yield from turns(3)


def finish(person: Person) -> Steps[None]:
    """Bake few keys, mark the asset, export; and write down the points of both motions."""
    reconstructed = yield from shown_points(person)
    write_points(person, "motion.json", reconstructed)
    bake = "keymark.bake_motion"
    yield from person.changes_nothing("cancelling the bake", lambda: cancelled(person, bake))
    yield from person.undoable("baking", lambda: job(person, bake))
    settings = person.take.finish
    expect(settings.action is not None, "there is no final Action")
    expect(settings.keys_after < settings.keys_before, f"{settings.keys_after} keys are no fewer")
    yield from person.look("finish")
    final = yield from shown_points(person)
    apart = 1000.0 * np.linalg.norm(final - reconstructed, axis=-1).mean()
    print(f"{settings.keys_after} of {settings.keys_before} keys, {apart:.1f} mm from the motion")
    expect(apart < LARGEST_CHANGE_MM, f"the final motion is {apart:.1f} mm from the reconstructed one")
    bpy.ops.wm.save_as_mainfile(filepath=str(person.folder / "session.blend"))
    person.step_done("Save")
    yield from turns(3)
    yield from person.undoable("marking the asset", lambda: person.hands.invoke("keymark.mark_asset"))
    expect(person.take.finish.action.asset_data is not None, "the final Action is no asset")
    file = person.folder / "motion.bvh"
    file.unlink(missing_ok=True)
    yield from person.changes_nothing("exporting", lambda: _export(person, str(file)))
    expect(file.is_file() and file.read_text().startswith("HIERARCHY"), f"{file} is no BVH file")
    yield from person.look("finished")


def _export(person: Person, file: str) -> Steps[None]:
    area, region = person.hands.area("VIEW_3D"), person.hands.region("VIEW_3D", "WINDOW")
    with bpy.context.temp_override(window=person.hands.window, area=area, region=region):
        bpy.ops.keymark.export_motion(format="BVH", filepath=file)
    yield from turns(3)


def shown_points(person: Person) -> Steps[np.ndarray]:
    """The 13 points (F, 13, 3) [m] that the armature shows, frame by frame."""
    scene, names = person.scene, person.known.body.skeleton.point_names
    now, rows = scene.frame_current, []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        rows.append(_points(person.take.armature, names))
        if frame % 20 == 0:
            yield
    scene.frame_set(now)
    return np.array(rows)


def write_points(person: Person, file_name: str, places: np.ndarray) -> None:
    points = {
        name: np.round(places[:, i], 6).tolist()
        for i, name in enumerate(person.known.body.skeleton.point_names)
    }
    text = json.dumps({"frame_start": person.scene.frame_start, "points": points})
    (person.folder / file_name).write_text(text, encoding="utf-8")


def _points(armature_object: bpy.types.Object, names: tuple[str, ...]) -> list[list[float]]:
    places = []
    for name in names:
        part, _, side = name.partition(".")
        bone, end = ENDS[part]
        pose_bone = armature_object.pose.bones[f"{bone}.{side}" if side else bone]
        places.append(list(armature_object.matrix_world @ getattr(pose_bone, end)))
    return places
