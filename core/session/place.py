"""Place: where the camera stands, by a performer who is upright on the floor and by the lines of the room.

Somebody of known height who stands or walks upright on the floor measures the room (`standing_moments`,
`camera_fit`), whose straight edges tell the camera's attitude (`room_lines`). The world's origin is where the
performer is in the middle of these moments. How high the camera stands is settled with the poses, which know
how far knees are bent.
"""

from dataclasses import replace

import numpy as np

from ..camera.camera import EYE_HEIGHT_M, Camera
from ..camera.camera_evidence import CameraEvidence, RoomView, Uprights
from ..camera.camera_fit import LENS, PARAMETERS, CameraFit, fit_camera
from ..camera.room_lines import find_room
from ..detect.standing_moments import standing_keypoints, turned_note
from ..errors import pluralize
from ..markers.reading import Reading
from ..progress import Job, Progress, stretch
from ..take.performer_keypoints import performer_keypoints
from ..take.presence import of_one_shot, seen_take
from ..take.steady_camera import steadied
from .session import FoundCamera, Inputs, Placed, Session, Sight, Stage

FEWEST_MOMENTS = 2
"""Upright moments that tell a camera by themselves; one is the same from high above and from low."""


def place(session: Session) -> Job[Placed]:
    """Find a camera that nobody has placed, take its turning back, and tell who performs when."""
    inputs, reading = session.inputs, session[Reading]
    take, found = replace(inputs.take, keypoints=session[Sight].checked), None
    take, reading = of_one_shot(take, reading, inputs.shot)
    anyone = performer_keypoints(replace(take, keyframes=()), reading.tracks)
    if inputs.open_lens is not None:
        yield Progress("Placing the camera", 0.0)
        uprights = standing_keypoints(anyone, take.body, take.fps)
        background = None if reading.glimpses is None else reading.glimpses.median()
        room = None if background is None else find_room(*background, take.camera)
        camera, fit = find_camera(take.camera, inputs.open_lens.is_known, uprights, room)
        take, found = replace(take, camera=camera), FoundCamera(fit, inputs.open_lens, len(uprights), room)
    take, steady, notes = yield from stretch(steadied(take, reading, anyone), 0.5, 1.0)
    turned = None if inputs.open_lens is None else turned_note(anyone)
    notes += () if turned is None else (turned,)
    return Placed(seen_take(take, steady, notes), found)


def _uses(inputs: Inputs) -> tuple[object, ...]:
    take = inputs.take
    posed = tuple(key for key in take.keyframes if key.matched is None)
    return inputs.shot, take.camera, take.body.actor.segments_m, take.fps, inputs.open_lens, posed


PLACE = Stage("place", place, _uses, lambda _inputs: 0.1)


def find_camera(
    put: Camera, lens_is_known: bool, uprights: Uprights, room: RoomView | None = None
) -> tuple[Camera, CameraFit | None]:
    """The camera that upright moments and a room show, with the performer about the world's origin.

    Where neither tells it, it is the camera as it was put, and there is no fit.
    """
    if room is None and len(uprights) < FEWEST_MOMENTS:
        return put, None
    fit = fit_camera(put, CameraEvidence(uprights=uprights, room=room), lens_is_known)
    location, sight = fit.camera.rays(uprights.lower_px)
    falls = sight[:, 2] < 0.0
    if not falls.any():
        return fit.camera, fit
    far = (location[2] - uprights.lower_m) / np.where(falls, -sight[:, 2], np.inf)
    ground = location[:2] + far[:, None] * sight[:, :2]
    pose = fit.camera.matrix_world.copy()
    pose[:2, 3] -= np.median(ground[falls], axis=0)
    return replace(fit.camera, matrix_world=pose), fit


def camera_in_words(camera: FoundCamera) -> str:
    """What was found of a camera, and what was assumed."""
    fit, lens = camera.fit, camera.lens
    if fit is None:
        return (
            f"assumed to be level at {EYE_HEIGHT_M:g} m, lens {lens.lens_mm:.1f} mm ({lens.source}); the "
            "performer stands upright at no two moments, and too few straight lines are seen, by which it "
            "would be found"
        )
    found = [fit.in_words(name) for name in PARAMETERS if name not in fit.kept]
    kept = [fit.in_words(name) for name in PARAMETERS if name in fit.kept and name != LENS]
    kept += [f"{fit.in_words(LENS)} ({lens.source})"] if LENS in fit.kept else []
    parts = [", ".join(found) or "nothing found"] + ([f"assumed: {', '.join(kept)}"] if kept else [])
    by = [f"{pluralize(camera.moments, 'moment')} in which the performer is upright"] * bool(camera.moments)
    by += ["the straight lines of the room"] * (camera.room is not None)
    return f"{'; '.join(parts)}; by {' and '.join(by)}"
