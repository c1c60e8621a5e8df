"""A found posture that a person has put right in the picture alone: where it leans then.

Points set in the picture tell how a body leans, since leaning parts look shorter than they are. That needs
the performer's own lengths: average ones would bend straight limbs and lean upright trunks. With these,
points keep the depth that was found, as far as they may. With measured ones all postures that explain the
points are sought again, and what was found counts as much as it was sure.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..estimate.belief import JOINT_STD_DEG, picture_std_m
from ..estimate.clip_problem import uncalibrated
from ..estimate.keypoint_evidence import KeypointEvidence
from ..estimate.sigma import found_std_m
from ..markers.region_tracks import RegionTracks
from ..prior.library import Library
from ..terms.keypoints import ObservedKeypoints
from ..terms.region_model import RegionModel
from .frame_search import ALIKE, FrameSearch, FrameShown, Hypotheses
from .inverse_kinematics import Pull, SightLine, pulled
from .part_pools import part_pools

EVIDENT = "person"  # source of points that a person vouches for


def put_right(
    body: Body,
    camera: Camera,
    frame: int,
    found: Posture,
    shown: Posture,
    places: Mapping[str, Array],
    confidence: float,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    held: str | None = None,
) -> Posture:
    """The likeliest posture that is seen as a person has put it right in the picture.

    `found` is what it was before, its depth right with a probability of `confidence`; `shown` is about as it
    should be seen, from which to start. `places` (3,) [m] are where the camera sees points that a person has
    set, by name; the others are seen about where `shown` has them, and `held`, which is set just now, comes
    to lie on its sight. `libraries` are asked where the lengths are the performer's own.
    """
    names = body.skeleton.point_names
    is_set = np.array([name in places for name in names])
    start = body.points(body.pose(shown))
    seen = np.array([places.get(name, place) for name, place in zip(names, start, strict=True)])
    across_m, along_m = found_std_m(np.array(confidence))
    std_m = np.where(is_set, picture_std_m(body), across_m)
    near_m = np.where([name == held for name in names], 0.002, std_m)  # the point under the mouse stays there
    own = _pulled(body, camera, frame, found, shown, seen, near_m)
    usable = [library for library in libraries if library.postures]
    pixels, depth = camera.project(seen, frame)
    if body.actor.is_average or not usable or not (np.isfinite(pixels).all() and (depth > 0.0).all()):
        return own
    search = FrameSearch(part_pools(usable, body), _shown(body, camera, frame, pixels, std_m), floor_m)
    first = search.descended(Hypotheses(Posture.stack([own]), np.zeros(1), np.array([False])))
    found_anew = search.hypotheses()
    sided = found_anew.chosen(np.flatnonzero(~found_anew.exchanged))  # a person's left and right are right
    every = Hypotheses.concatenate([first, sided])
    sight = camera.sight(seen, frame)
    before, among = (body.points(body.pose(each)) for each in (found, every.posture))
    leaning = _leaning(among, sight) - _leaning(before, sight)
    believed = 0.5 * ((leaning / along_m) ** 2).sum(axis=-1) / ALIKE
    likeliest = search.likeliest_mean(replace(every, cost=every.cost + believed))
    return _pulled(body, camera, frame, likeliest, likeliest, seen, near_m)


def _pulled(
    body: Body, camera: Camera, frame: int, deep: Posture, start: Posture, seen: Array, std_m: Array
) -> Posture:
    """A posture pulled to the sights of places (P, 3), where its points keep the depth of another's."""
    there = body.points(body.pose(deep))
    pulls = []
    for name, own, place, std in zip(body.skeleton.point_names, there, seen, std_m, strict=True):
        line = SightLine.to(camera, place, frame)
        # Points come near to their depth; what is moved far across the sight may have come as far along it.
        kept_m = float(np.hypot(0.04, line.off_m(own)))
        pulls.append(Pull(name, line.nearest(own), float(std), line.direction, kept_m))
    free = {joint.name: np.radians(JOINT_STD_DEG[joint.name.split(".")[0]]) for joint in body.skeleton.joints}
    return pulled(body, start, pulls, {"place": 1.0, **free})  # the hips may come anywhere


def _leaning(places: Array, sight: Array) -> Array:
    """(..., P) depths [m] of points (..., P, 3) relative to their mean."""
    return np.asarray(((places - places.mean(axis=-2, keepdims=True)) * sight).sum(axis=-1))


def _shown(body: Body, camera: Camera, frame: int, pixels: Array, std_m: Array) -> FrameShown:
    """A frame in which nothing but points (P, 2) of the body is seen [px], with their errors (P,) [m]."""
    names = body.skeleton.point_names
    count = len(names)
    sources = (EVIDENT,) * count
    points = Keypoints(names, sources, pixels[None], np.ones((1, count)), np.full((1, count, 3), np.nan))
    seen = replace(KeypointEvidence.usual(body, camera, names, sources), std_m=std_m)
    evidence = uncalibrated(RegionModel(body, camera, ()), seen)
    tracks = RegionTracks.unmarked(np.zeros(1), camera.resolution)
    return FrameShown(evidence, frame, tracks, points, ObservedKeypoints.of(points))
