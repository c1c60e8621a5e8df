"""What to follow of a performer in plain clothes: keypoints of a detector, and points by hand."""

import bpy
import numpy as np
from driver import Steps, expect
from person import Person, keymark
from steps_prepare import browse, click_pixel

POINTS = ("wrist.L", "wrist.R")  # Clicked on one after the other, in the order in which they are asked for
NEAR_PX = 2.0  # How far a click may land from where the person meant to click, in pixels of the footage


def keypoints(person: Person) -> Steps[None]:
    """Load what a detector has found, and click on two points that it may have missed."""
    loading = "keymark.load_keypoints", person.known.folder / "keypoints.json"
    before = person.hands.clicks
    yield from person.changes_nothing("cancelling the file browser", lambda: browse(person, *loading, "ESC"))
    yield from person.undoable("loading keypoints", lambda: browse(person, *loading, "RET"))
    expect(len(person.take.follow.files) == 1, "no keypoints were loaded")
    label = keymark("operators.follow.evidence").keypoints_label(person.take)
    print(f"{person.hands.clicks - before} clicks to load keypoints, once cancelled; seen: {label}")
    expect(label.partition(" of ")[0] not in ("", "0"), f"the panel says {label!r} of keypoints")
    yield from person.look("keypoints")
    yield from person.changes_nothing("cancelling clicks", lambda: _click(person, "ESC"))
    yield from person.undoable("clicking on points", lambda: _click(person, "RET"))
    clicked = {click.point: np.array(click.pixel) for click in person.take.follow.clicks}
    expect(tuple(clicked) == POINTS, f"clicked on {tuple(clicked)}")
    away = [np.abs(clicked[point] - _pixel(person, point)).max() for point in POINTS]
    expect(max(away) < NEAR_PX, f"clicks landed {away} pixels from where they were meant")
    yield from person.look("clicked")
    yield from person.undoable("removing a click", lambda: _remove(person, POINTS[1]))


def _click(person: Person, end: str) -> Steps[None]:
    """The button, a click on each point as it is asked for, and a key."""
    yield from person.hands.click_button("keymark.click_point")
    expect(person.jobs(), "nothing waits for a click")
    for point in POINTS:
        while person.take.follow.clicked_point != point:
            yield from person.hands.press("TAB")
        yield from click_pixel(person, _pixel(person, point))
        if end == "RET" and point == POINTS[0]:
            yield from person.look("clicking")
    yield from person.hands.press(end)
    expect(not person.jobs(), f"{end} does not end the clicks")


def _remove(person: Person, point: str) -> Steps[None]:
    yield from person.hands.click_button("keymark.remove_clicks", f"point='{point}'".replace("'", '"'))


def _pixel(person: Person, point: str) -> np.ndarray:
    """Where a person sees a joint in the first keyframe, which the scene shows."""
    known = person.known
    keyframe = known.keyframes[0]
    expect(keyframe.index == person.scene.frame_current - known.frame_start, "not at the first keyframe")
    places = known.body.points(known.body.pose(keyframe.posture))
    pixel, _ = known.camera.project(places)
    return pixel[known.body.skeleton.point_names.index(point)]


def clip_editor(person: Person) -> Steps[None]:
    """The Movie Clip editor has the same step, where tracks are made; a track with a name is followed."""
    take = person.take
    track = take.clip.tracking.tracks.new(name="Left Knee", frame=1)
    width, height = take.clip.size
    x, y = _pixel(person, "knee.L")
    track.markers[0].co = x / width, 1.0 - y / height
    person.step_done("Track a knee")
    area = person.hands.area("VIEW_3D")
    area.ui_type = "CLIP_EDITOR"
    yield
    area = person.hands.area("CLIP_EDITOR")
    area.spaces.active.clip = take.clip
    yield from person.hands.open_sidebar("CLIP_EDITOR", "Keymark")
    yield from person.hands.move_over("CLIP_EDITOR")
    yield from person.hands.press("HOME")
    label = keymark("operators.follow.evidence").tracks_label(person.take)
    expect(label == "1 of 1", f"the panel says {label!r} of tracks")
    yield from person.look("tracks")
    person.hands.area("CLIP_EDITOR").ui_type = "VIEW_3D"
    yield
    bpy.context.view_layer.update()
