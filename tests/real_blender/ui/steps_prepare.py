"""The session's first three steps: footage, markers, actor."""

from collections.abc import Callable
from pathlib import Path

import bpy
import cv2
import numpy as np
from _panel import controls
from driver import Steps, expect, turns, until
from mathutils import Matrix
from numpy.typing import NDArray
from person import Person, keymark
from steps_camera import find_camera

FARTHEST_COLOR = 25.0
"""Between a sleeve's color in one frame and over the whole clip, made equally bright, of 255."""
FRESH_CONTROLS = 12  # What the sidebar shows of a clip that was just loaded
HIGHER_PX = 100  # What the timeline is made higher by
ABOUT_PX = 5  # Side of the square about a click that a person sees wholly on the sleeve
SEARCH_PX = 0.06
"""How far from where a sleeve should be a person looks for its color, as a share of the picture's width."""


def start_empty(person: Person, raised_px: int = HIGHER_PX) -> Steps[None]:
    """A scene without anything, a timeline that is high enough to draw in, Keymark's tab in the sidebar.

    `raised_px` is 0 where the timeline stays as Blender opens it.
    """
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    yield from turns(5)
    viewport = person.hands.area("VIEW_3D")
    edge = viewport.x + 0.6 * viewport.width, viewport.y - 1
    height = viewport.height
    if raised_px:
        yield from person.hands.drag(edge, (edge[0], edge[1] + raised_px))
        lowered = height - person.hands.area("VIEW_3D").height
        expect(lowered > 0.5 * raised_px, "the timeline cannot be made higher")
    yield from person.hands.open_sidebar("VIEW_3D", "Keymark")
    person.step_done("Empty scene")
    yield from person.look("empty")


def clip(person: Person) -> Steps[None]:
    """The clip in an empty scene, seen through its camera as it truly stood."""
    yield from start_empty(person, raised_px=0)
    bpy.ops.keymark.load_footage(filepath=str(person.known.clip))
    stand_camera(person)
    yield from look_through_camera(person)


def performer(person: Person, keypoints: str) -> None:
    """An actor of the performer's height, and the keypoints of a file in the take's folder."""
    person.take.stature = person.known.body.actor.stature_m
    bpy.ops.keymark.load_keypoints(filepath=str(person.known.folder / keypoints))
    bpy.ops.keymark.build_actor()


def opened(person: Person, reconstructed: bool) -> Steps[None]:
    """The take opened from its files, and reconstructed, for a session that begins at a later step."""
    bpy.ops.keymark.open_take(filepath=str(person.known.folder))
    if reconstructed:
        bpy.ops.keymark.reconstruct()
    person.step_done("Open the take")
    yield from turns(3)
    yield from look_through_camera(person)


def footage(person: Person) -> Steps[None]:
    """Load the clip by the file browser, cancelled once; find the camera, and set it up as it truly stood."""
    file = person.known.clip
    clip = "keymark.load_footage", min(file.iterdir()) if file.is_dir() else file  # the first of many images
    yield from person.changes_nothing("cancelling the file browser", lambda: browse(person, *clip, "ESC"))
    yield from person.undoable("loading the footage", lambda: browse(person, *clip, "RET"))
    take, known = person.take, person.known
    expect(take.clip is not None and take.clip.frame_duration > 1, "the footage was not loaded")
    expect(person.scene.frame_end == known.frame_start + take.clip.frame_duration - 1, "the range is another")
    shown = controls()
    expect(len(shown) <= FRESH_CONTROLS, f"a fresh clip shows {len(shown)} controls: {shown}")
    yield from find_camera(person)
    stand_camera(person)
    person.step_done("Align the camera")
    yield from turns(2)
    yield from look_through_camera(person)
    yield from person.look("footage")


def stand_camera(person: Person) -> None:
    """Set the camera up as it truly stood."""
    camera, known = person.take.camera, person.known.camera
    camera.matrix_world = Matrix(known.matrix_world.tolist())
    camera.data.sensor_fit, camera.data.sensor_width = "HORIZONTAL", known.sensor_width_mm
    camera.data.lens = known.lens_mm
    camera.data.shift_x, camera.data.shift_y = known.shift_x, known.shift_y


def look_through_camera(person: Person) -> Steps[None]:
    """Numpad 0, and Home to fit its frame to the region; what was loaded by its button is so already."""
    view = person.hands.area("VIEW_3D").spaces.active
    if view.region_3d.view_perspective == "CAMERA":
        return
    yield from person.hands.move_over("VIEW_3D")
    yield from person.hands.press("NUMPAD_0")
    yield from until(lambda: view.region_3d.view_perspective == "CAMERA", "the camera's view")
    yield from person.hands.press("HOME")
    yield from turns(20)  # the view glides there


def markers(person: Person) -> Steps[None]:
    """Pick the usual five markers from the footage, by a button and five clicks."""
    yield from person.changes_nothing("cancelling the clicks", lambda: _pick(person, 2, "ESC"))
    before = person.hands.clicks
    yield from person.undoable("picking the markers", lambda: _pick(person, len(person.known.markers)))
    print(f"{person.hands.clicks - before} clicks to pick the markers")
    names = [style.segment for style in person.known.markers]
    found = [marker.segment for marker in person.take.markers]
    expect(found == names, f"the markers are {found}, the performer wears {names}")
    check_colors(person)
    expect(bpy.context.window_manager.keymark_show_masks, "picking does not show the masks")
    yield from person.look("markers")
    yield from person.hands.click_button("keymark.show_masks")


def check_colors(person: Person) -> None:
    """Expect every marker to have nearly the color of its sleeve, be it in shade where it was picked."""
    apart = []
    for marker, style in zip(person.take.markers, person.known.markers, strict=True):
        picked, known = np.array(marker.color), np.array(style.color_srgb, dtype=float)
        apart.append(float(np.abs(picked * (known @ picked) / (picked @ picked) - known).max()))
    expect(max(apart) < FARTHEST_COLOR, f"the picked colors are up to {apart} from the sleeves'")


def actor(person: Person) -> Steps[None]:
    """Build the actor from the performer's height, and give it the performer's lengths."""
    actor = person.known.body.actor
    yield from person.hands.fill("stature", f"{actor.stature_m:.3f}")
    found = person.take.stature
    expect(abs(found - actor.stature_m) < 1e-3, f"the height is {found}, not {actor.stature_m}")
    yield from person.undoable("building", lambda: person.hands.click_button("keymark.build_actor"))
    yield from person.look("actor")
    lengths = person.take.lengths
    lengths.symmetric = False
    for name, value in actor.segments_m.items():
        setattr(lengths, name.replace(".", "_"), value)
    person.step_done("Write the lengths")
    yield from person.undoable("applying lengths", lambda: person.hands.invoke("keymark.apply_lengths"))


def browse(person: Person, command: str, file: Path, key: str) -> Steps[None]:
    """Open the file browser by its button, go to a file, and press a key there."""
    yield from choose_file(person, lambda: person.hands.click_button(command), file, key)


def choose_file(
    person: Person, ask: Callable[[], Steps[None]], file: Path, key: str, closes: bool = True
) -> Steps[None]:
    """Do what opens the file browser, go to a file, or a folder, and press a key there, which closes it."""
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    yield from ask()
    kinds = {"FILE_BROWSER"}
    yield from until(lambda: kinds & {a.type for a in person.hands.window.screen.areas}, "the file browser")
    browser = person.hands.area("FILE_BROWSER").spaces.active
    yield from until(lambda: browser.params is not None, "the file browser's folder")
    browser.params.directory = str(file if file.is_dir() else file.parent).encode()
    if not file.is_dir():
        browser.params.filename = file.name
    yield from turns(5)
    yield from person.hands.move_over("FILE_BROWSER")
    if key == "RET":
        yield from person.look("file_browser")
    yield from person.hands.press(key)
    if closes:
        yield from until(
            lambda: not kinds & {a.type for a in person.hands.window.screen.areas}, "the viewport"
        )
    yield from turns(3)


def _pick(person: Person, count: int, key: str = "") -> Steps[None]:
    """The button, a click on each of the first markers as it is asked for, and a key."""
    yield from person.hands.click_button("keymark.pick_markers")
    expect(person.jobs(), "nothing waits for a click")
    for number in range(count):
        expect_asked(person, number)
        yield from click_pixel(person, sleeve_pixel(person, number))
    if key:
        yield from person.hands.press(key)
        expect(not person.jobs(), f"{key} does not end the clicks")
    else:
        yield from person.wait_for_job()


def expect_asked(person: Person, number: int) -> None:
    """Expect that one of the performer's markers is asked for, with whose left or right it is."""
    segment = person.known.markers[number].segment
    request = keymark("operators.shell.footage_view").shown_request()
    expect(request is not None, "nothing is asked for")
    title = keymark("operators.follow.properties").segment_title(segment)
    expect(title in request.title, f"{request.title!r} is asked for, not {title}")
    side = {"L": "own left", "R": "own right"}.get(segment[-1], "")
    expect(side in request.detail, f"the request for {segment} says {request.detail!r}")


def click_pixel(person: Person, pixel: NDArray[np.float64]) -> Steps[None]:
    """Click on a pixel of the footage in the viewport."""
    area, region = person.hands.area("VIEW_3D"), person.hands.region("VIEW_3D", "WINDOW")
    view = keymark("operators.shell.footage_view").footage_view(person.scene, person.take, area, region)
    expect(view is not None, "the viewport does not show the footage")
    x, y = view.to_region(pixel)
    yield from person.hands.click(region.x + x, region.y + y)


def sleeve_pixel(person: Person, number: int) -> NDArray[np.float64]:
    """A pixel [px] of the current frame where a person would click for a marker.

    That is where the colors about it are nearest to what the sleeve's is known to be, around where the first
    keyframe has the middle of the limb.
    """
    known = person.known
    style, keyframe = known.markers[number], known.keyframes[0]
    expect(keyframe.index == person.scene.frame_current - known.frame_start, "not at the first keyframe")
    points = dict(
        zip(
            known.body.skeleton.point_names, known.body.points(known.body.pose(keyframe.posture)), strict=True
        )
    )
    middle = np.mean([points[name] for name in _ends(style.segment)], axis=0)
    (center,), _ = known.camera.project(middle[None])
    clip = keymark("core.video.clip").Clip.open(known.clip, fps=known.fps)
    _, _, image = next(iter(clip.frames()))
    rows, columns = np.mgrid[: image.shape[0], : image.shape[1]]
    pixels = np.stack([columns, rows], axis=-1) + 0.5
    near = np.linalg.norm(pixels - center, axis=-1) < SEARCH_PX * image.shape[1]
    wrong = np.linalg.norm(image[..., ::-1].astype(float) - style.color_srgb, axis=-1)
    wrong = cv2.blur(wrong, (ABOUT_PX, ABOUT_PX))
    wrong[~near] = np.inf
    return pixels[np.unravel_index(np.argmin(wrong), wrong.shape)]


def _ends(segment: str) -> tuple[str, ...]:
    part, _, side = segment.partition(".")
    ends = {"trunk": ("hip.L", "hip.R", "shoulder.L", "shoulder.R"), "forearm": ("elbow", "wrist")}
    ends |= {"shin": ("knee", "ankle"), "upper_arm": ("shoulder", "elbow"), "thigh": ("hip", "knee")}
    return tuple(f"{name}.{side}" if side else name for name in ends[part])
