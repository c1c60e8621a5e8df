"""A take whose camera turns or zooms, seen as if it stood still: in the mean view of the clip.

A camera that keeps its place sees every scene alike but for a homography of its picture. Keypoints, markers
and pictures are taken back by it, so that all that follows knows a camera that stands still.
"""

from dataclasses import replace
from functools import partial

import cv2
import numpy as np

from ..arrays import Array, Image
from ..camera.camera import Camera
from ..camera.camera_motion import ZOOMING, camera_motion, moved
from ..detect.keypoints import Keypoints, People
from ..markers.reading import Reading
from ..markers.region_tracks import RegionTracks
from ..progress import Job, Progress
from .take import Take

LOOKS = 30
"""Frames, evenly spaced, in which it is looked whether the camera moves at all; only then at every one."""


def camera_matrix(camera: Camera) -> Array:
    """(3, 3) matrix from directions, x right, y down, z away, to pixels."""
    column, row = camera.principal_point
    return np.array([[camera.focal_px, 0.0, column], [0.0, camera.focal_px, row], [0.0, 0.0, 1.0]])


def steadied(
    take: Take, reading: Reading, performer: Keypoints
) -> Job[tuple[Take, Reading, tuple[str, ...]]]:
    """The take and its reading as a camera that stands still would show them, where it only turns or zooms.

    Both as they are where it stands still, moves from its place, or shows too little of the background; with
    a sentence where it moves and is not followed. `performer`: what of the picture is no background.
    """
    yield Progress("Looking whether the camera moves", 0.0)
    album, tracks, camera = reading.album, reading.tracks, take.camera
    if album is None or camera.is_moving:
        return take, reading, ()
    count, matrix = tracks.frame_count, camera_matrix(camera)
    # Around the middle of an ellipse: to its edge.
    around = 2.0 * np.sqrt(np.diagonal(tracks.second_moment, axis1=-2, axis2=-1))
    places = np.concatenate([tracks.centroid - around, tracks.centroid + around, performer.pixel], axis=1)
    some = np.unique(np.linspace(0, count - 1, min(LOOKS, count)).astype(np.intp))
    noticed = camera_motion(album, some, places, matrix, camera.resolution)
    if noticed is None or not noticed.noticed:
        return take, reading, ()
    own = np.arange(count)[slice(*(reading.shot or (0, None)))]
    found = camera_motion(album, own, places, matrix, camera.resolution)
    if found is None or not found.noticed or not found.turns or len(found.frames) < len(own):
        lost = (
            f"the camera moves, by {noticed.moved_px:.0f} px of the picture, and is taken to stand still; "
            "one that only turns or zooms is followed, one that walks by Blender's camera solver"
        )
        return take, reading, (lost,)
    homography = np.tile(np.eye(3), (count, 1, 1))
    homography[own] = found.homography
    back = np.linalg.inv(homography)
    keypoints = tuple(_people(people, back) for people in take.keypoints)
    note = (
        f"the camera {'zooms' if found.zoom > 1.0 + ZOOMING else 'turns'}: its picture moves by up to "
        f"{found.moved_px:.0f} px, which was followed by the background"
    )
    steady = replace(
        reading,
        tracks=_tracks(tracks, back),
        album=album.warped(back),
        notes=(*reading.notes, note),
        steady=homography,
    )
    return replace(take, keypoints=keypoints), steady, ()


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


def steadied_picture(image: Image, factor: float, reading: Reading, frame: int) -> Image:
    """A picture of the clip, `factor` times smaller, as the steady camera would show it."""
    if reading.steady is None:
        return image
    size, scale = (image.shape[1], image.shape[0]), np.diag([factor, factor, 1.0])
    back = np.linalg.inv(reading.steady[frame] @ scale)
    return np.asarray(cv2.warpPerspective(image, back @ scale, size), dtype=np.uint8)


def _people(people: People, back: Array) -> People:
    frames = tuple(
        seen.moved(partial(moved, own)) if len(seen.pixel) else seen
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
