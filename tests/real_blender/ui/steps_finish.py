"""The session's end: review, finish, and what the armature shows."""

import json

import numpy as np
from driver import Steps
from person import Person

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


def review(person: Person) -> Steps[None]:
    """Look at the motion and at what Keymark says of it."""
    yield from person.look("review")


def finish(person: Person) -> Steps[None]:
    """Write down where the armature's points are in every frame."""
    yield from write_points(person)


def write_points(person: Person) -> Steps[None]:
    """Write `motion.json`: the 13 points [m] that the armature shows, frame by frame."""
    scene, names = person.scene, person.known.body.skeleton.point_names
    rows = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        rows.append(_points(person.take.armature, names))
        if frame % 20 == 0:
            yield
    points = {name: np.round(np.array(rows)[:, i], 6).tolist() for i, name in enumerate(names)}
    text = json.dumps({"frame_start": scene.frame_start, "points": points})
    (person.folder / "motion.json").write_text(text, encoding="utf-8")


def _points(armature_object: object, names: tuple[str, ...]) -> list[list[float]]:
    places = []
    for name in names:
        part, _, side = name.partition(".")
        bone, end = ENDS[part]
        pose_bone = armature_object.pose.bones[f"{bone}.{side}" if side else bone]
        places.append(list(armature_object.matrix_world @ getattr(pose_bone, end)))
    return places
