"""The depth of a posture that a person has put right in the picture alone.

A posture dragged to where it is seen keeps the lean of limbs and trunk that was found, though exactly seen
points often contradict it. All postures that explain them are sought again, and what was found counts as much
as it was sure.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..body.posture import Posture
from ..estimate.clip_problem import uncalibrated
from ..estimate.keyframe_error import POINT_STD_M, found_std_m
from ..estimate.keypoint_evidence import KeypointEvidence
from ..evidence.keypoints import ObservedKeypoints
from ..evidence.regions import RegionModel
from ..footage.camera import Camera
from ..footage.keypoints.keypoints import Keypoints
from ..footage.region_tracks import RegionTracks
from ..prior.library import Library
from .frame_poses import ALIKE, likeliest_mean
from .frame_search import FrameShown, knowledge, search
from .inverse_kinematics import Pull, SightLine, pulled

EVIDENT = "person"  # source of points that a person vouches for
SEEN_M, KEPT_M = 0.003, 0.10  # how near points come to their lines of sight, and to their places along them
FREE = 1.0  # standard deviation of joints that may turn [rad], and of the hips' place [m]


def seen_at(body: Body, camera: Camera, frame: int, posture: Posture, places: Array) -> Posture:
    """A posture pulled to where the camera sees places (P, 3) of its points; lengths stay."""
    own = body.points(body.pose(posture))
    pulls = []
    for name, there, place in zip(body.skeleton.point_names, own, places, strict=True):
        line = SightLine.to(camera, place, frame)
        pulls.append(Pull(name, line.nearest(there), SEEN_M, line.direction, KEPT_M))
    joints = [joint.name for joint in body.skeleton.joints]
    return pulled(body, posture, pulls, {name: FREE for name in ["place", *joints]})


def with_likely_depth(
    body: Body,
    camera: Camera,
    frame: int,
    posture: Posture,
    found: Posture,
    confidence: float,
    libraries: Sequence[Library],
    floor_m: float | None = None,
) -> Posture:
    """The likeliest posture that is seen where a given one is.

    Args:
        body: The take's body.
        camera: The take's camera.
        frame: Index of the frame in the clip, which a moving camera's place depends on.
        posture: The given one, right across the line of sight.
        found: What was found, before a person put it right.
        confidence: Probability that its depth is about right.
        libraries: What is known of postures; without any posture the given one is returned.
        floor_m: Height of the floor in the world [m]; None where it is not known.
    """
    usable = [library for library in libraries if library.postures]
    places = body.points(body.pose(posture))
    pixels, depth = camera.project(places, frame)
    if not usable or not (np.isfinite(pixels).all() and (depth > 0.0).all()):
        return posture
    known, shown = knowledge(body, usable), _shown(body, camera, frame, pixels)
    every = search(known, shown, floor_m)
    sided = every.chosen(np.flatnonzero(~every.exchanged))  # left and right of a person's points are right
    sight = camera.sight(places, frame)
    before, among = (body.points(body.pose(each)) for each in (found, sided.posture))
    leaning = _leaning(among, sight) - _leaning(before, sight)
    _, along_m = found_std_m(np.array(confidence))
    believed = 0.5 * ((leaning / along_m) ** 2).sum(axis=-1) / ALIKE
    likeliest = likeliest_mean(known, shown, replace(sided, cost=sided.cost + believed), floor_m)
    return seen_at(body, camera, frame, likeliest, places)


def _leaning(places: Array, sight: Array) -> Array:
    """(..., P) depths [m] of points (..., P, 3) relative to their mean."""
    return np.asarray(((places - places.mean(axis=-2, keepdims=True)) * sight).sum(axis=-1))


def _shown(body: Body, camera: Camera, frame: int, pixels: Array) -> FrameShown:
    """A frame in which nothing but points (P, 2) of the body is seen [px]."""
    names = body.skeleton.point_names
    count = len(names)
    sources = (EVIDENT,) * count
    points = Keypoints(names, sources, pixels[None], np.ones((1, count)), np.full((1, count, 3), np.nan))
    seen = replace(KeypointEvidence.usual(body, camera, names, sources), std_m=np.full(count, POINT_STD_M))
    evidence = replace(uncalibrated(RegionModel(body, camera, ())), keypoints=seen)
    tracks = RegionTracks.unmarked(np.zeros(1), camera.resolution)
    return FrameShown(evidence, frame, tracks, points, ObservedKeypoints.of(points))
