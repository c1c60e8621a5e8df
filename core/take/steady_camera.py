"""A take whose camera turns or zooms, seen as if it stood still: in the mean view of the clip.

A camera that keeps its place sees every scene alike but for a homography of its picture. Keypoints, markers
and pictures are taken back by it, so that all that follows knows a camera that stands still.
"""

from dataclasses import replace

import cv2
import numpy as np

from ..arrays import Array, Image
from ..camera.camera import Camera
from ..camera.camera_motion import ZOOMING, CameraMotion, camera_motion, moved
from ..detect.keypoints import People
from ..markers.reading import Reading
from ..markers.region_tracks import RegionTracks
from ..progress import Job, Progress
from .performer_keypoints import performer_keypoints
from .take import Take

LOOKS = 30
"""Frames, evenly spaced, in which it is looked whether the camera moves at all."""


def background_motion(take: Take, reading: Reading, every: bool = False) -> CameraMotion | None:
    """How the camera of a take moves that is said to stand still; None where it does, or nothing tells.

    It is looked at `LOOKS` frames, and only if `every` and it moves in all of them.
    """
    album, count = reading.album, reading.tracks.frame_count
    if album is None or take.camera.is_moving or reading.steady is not None:
        return None
    places = performer_keypoints(replace(take, keyframes=()), None, reading.tracks).pixel
    tracks = reading.tracks
    around = 2.0 * np.sqrt(
        np.diagonal(tracks.second_moment, axis1=-2, axis2=-1)
    )  # of an ellipse: to its edge
    places = np.concatenate([tracks.centroid - around, tracks.centroid + around, places], axis=1)
    some = np.unique(np.linspace(0, count - 1, min(LOOKS, count)).astype(np.intp))
    camera = take.camera
    found = camera_motion(album, some, places, camera_matrix(camera), camera.resolution)
    if found is None or not found.noticed or not every:
        return found if found is not None and found.noticed else None
    return camera_motion(album, np.arange(count), places, camera_matrix(camera), camera.resolution)


def camera_matrix(camera: Camera) -> Array:
    """(3, 3) matrix from directions, x right, y down, z away, to pixels."""
    column, row = camera.principal_point
    return np.array([[camera.focal_px, 0.0, column], [0.0, camera.focal_px, row], [0.0, 0.0, 1.0]])


def steadied(take: Take, reading: Reading) -> Job[tuple[Take, Reading]]:
    """The take and its reading as a camera that stands still would show them, where it only turns or zooms.

    Both as they are where it stands still, moves from its place, or shows too little of the background.
    """
    yield Progress("Looking whether the camera moves", 0.0)
    found = background_motion(take, reading, every=True)
    count = reading.tracks.frame_count
    if found is None or not found.turns or len(found.frames) < count or reading.album is None:
        return take, reading
    back = np.linalg.inv(found.homography)
    keypoints = tuple(_people(people, back) for people in take.keypoints)
    note = (
        f"the camera {'zooms' if found.zoom > 1.0 + ZOOMING else 'turns'}: its picture moves by up to "
        f"{found.moved_px:.0f} px, which was followed by the background"
    )
    steady = replace(
        reading,
        tracks=_tracks(reading.tracks, back),
        album=reading.album.warped(back),
        notes=(*reading.notes, note),
        steady=found.homography,
    )
    return replace(take, keypoints=keypoints), steady


def camera_notes(take: Take, reading: Reading) -> tuple[str, ...]:
    """A sentence on a camera that moves and is not followed."""
    found = background_motion(take, reading)
    if found is None:
        return ()
    return (
        f"the camera moves, by {found.moved_px:.0f} px of the picture, and is taken to stand still; the "
        "command line follows one that only turns or zooms, Blender's camera solver one that walks",
    )


def followed_camera(take: Take, reading: Reading) -> Camera:
    """The take's camera as it turned, one pose a frame; as it is where it did not, or zooms."""
    if reading.steady is None:
        return take.camera
    matrix, camera = camera_matrix(take.camera), take.camera
    turn = np.linalg.inv(matrix) @ reading.steady @ matrix
    left, sizes, right = np.linalg.svd(turn)
    if (sizes[:, 0] / sizes[:, 2]).max() > 1.0 + ZOOMING:
        return camera
    turn = left @ right  # nearest rotation: the rest is the fit's noise
    turn *= np.sign(np.linalg.det(turn))[:, None, None]
    flip = np.diag([1.0, -1.0, -1.0])  # Blender's cameras look along -Z, with Y upward
    pose = np.tile(camera.matrix_world, (len(turn), 1, 1))
    pose[:, :3, :3] = pose[:, :3, :3] @ np.swapaxes(flip @ turn @ flip, -1, -2)
    return replace(camera, matrix_world=pose)


def steadied_picture(image: Image, reading: Reading, frame: int) -> Image:
    """A picture of the clip as the steady camera would show it."""
    if reading.steady is None:
        return image
    size = image.shape[1], image.shape[0]
    return np.asarray(cv2.warpPerspective(image, np.linalg.inv(reading.steady[frame]), size), dtype=np.uint8)


def _people(people: People, back: Array) -> People:
    frames = tuple(
        replace(seen, pixel=moved(own, seen.pixel)) if len(seen.pixel) else seen
        for seen, own in zip(people.frames, back, strict=False)
    )
    return replace(people, frames=(*frames, *people.frames[len(frames) :]))


def _tracks(tracks: RegionTracks, back: Array) -> RegionTracks:
    place, around = tracks.centroid, 0.5 * np.eye(2)
    ends = [(moved(back[:, None], place + side), moved(back[:, None], place - side)) for side in around]
    local = np.stack([after - before for after, before in ends], axis=-1)  # (F, M, 2, 2)
    return replace(
        tracks,
        centroid=moved(back[:, None], place),
        second_moment=local @ tracks.second_moment @ np.swapaxes(local, -1, -2),
        area=tracks.area * np.abs(np.linalg.det(np.nan_to_num(local))),
    )
