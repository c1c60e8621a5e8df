"""Tilt, roll and lens of the camera from the straight lines of a room, which nobody has drawn.

Most edges of what people build run in three directions at right angles, one of them plumb (the *Manhattan
world* of Coughlan & Yuille 1999). The camera is sought under which the largest share of the edges' length
runs in these: over a grid, then downhill. Two level directions tell the lens; the covariance says how well.
"""

import cv2
import numpy as np
from scipy.optimize import minimize

from ..arrays import Array, Image
from ..numerics.vectors import unit
from .camera import Camera
from .camera_evidence import RoomView
from .camera_fields import CameraPlacement

SEARCHED_SIDE_PX = 960  # pictures are enlarged to this: edges are found to a fraction of a pixel
SHORTEST = 0.05  # segment, by the height of the picture
MOST_SEGMENTS = 300
REPEATED = 4.0  # segments that one edge of a thing gives, and that err alike
KERNEL = float(np.radians(0.8))  # angle within which a segment runs in a direction
COARSE_KERNEL, COARSE_STEP = float(np.radians(3.0)), float(np.radians(3.0))
WIDEST_TILT, WIDEST_ROLL = float(np.radians(42.0)), float(np.radians(21.0))
LENSES = np.exp(np.linspace(-0.5, 0.5, 5))  # by the usual one
LENS_STD, LENS_COST = 0.3, 0.02
"""What is believed of the logarithm of the lens, in shares of the segments' length."""
LEAST_SHARE, FEWEST = 0.6, 12
"""Share of the segments' length that must run in the three directions, and number of segments: by chance a
fifth does, on photographs of animals, faces and things up to .54."""
FLOOR_STD = np.array([np.radians(0.5), np.radians(0.3), 0.03])
"""Of tilt, roll and lens: rooms are not built to a right angle exactly, and lenses distort."""


def find_room(picture: Image, factor: float, camera: Camera) -> RoomView | None:
    """The view that straight edges show; None where too few agree.

    `picture` has a pixel for `factor` of the camera's along either axis; `camera` has the usual lens, which
    counts as far as the edges leave it open.
    """
    lines = factor * find_segments(picture)
    return None if len(lines) < FEWEST else room_of(lines, camera)


def find_segments(picture: Image) -> Array:
    """(N, 2, 2) ends of straight edges in a picture [px], the longest first."""
    gray = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    scale = max(1.0, SEARCHED_SIDE_PX / max(gray.shape))
    if scale > 1.0:
        gray = cv2.resize(gray, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    found = cv2.createLineSegmentDetector().detect(gray)[0]
    lines = np.zeros((0, 2, 2)) if found is None else found.reshape(-1, 2, 2).astype(np.float64) / scale
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=-1)
    longest = np.argsort(-length, kind="stable")[:MOST_SEGMENTS]
    return np.asarray(lines[longest[length[longest] > SHORTEST * picture.shape[0]]])


def room_of(lines: Array, camera: Camera) -> RoomView | None:
    """The view that segments (N, 2, 2) [px] show; None where too few agree."""
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=-1)
    weight = length / length.sum()
    sights = np.stack(
        [*np.moveaxis(lines - camera.principal_point, -1, 0), np.zeros(lines.shape[:2])], axis=-1
    )

    def normals(focal_px: float) -> Array:
        """(N, 3) of the planes through the camera's center and each segment, in the camera's axes."""
        ray = sights * [1.0, -1.0, 0.0] / focal_px - [0.0, 0.0, 1.0]
        return unit(np.cross(ray[:, 0], ray[:, 1]))

    def offsets(x: Array) -> Array:
        """(N, 3) sines of the angles between each segment's plane and the room's directions."""
        return np.asarray(normals(camera.focal_px * np.exp(x[3])) @ _directions(*x[:3]).T)

    def agreement(x: Array, kernel: float) -> float:
        return float(np.exp(-((offsets(x) / kernel) ** 2)).max(axis=1) @ weight)

    def cost(x: Array, kernel: float) -> float:
        # With another direction taken for the plumb one a camera that lies on its side fits as well.
        if np.any(np.abs(x[:2]) > [WIDEST_TILT + COARSE_STEP, WIDEST_ROLL + COARSE_STEP]):
            return np.inf
        return LENS_COST * (x[3] / LENS_STD) ** 2 - agreement(x, kernel)

    def refined(x: Array) -> Array:
        for kernel in (2.0 * KERNEL, KERNEL):
            corners = np.vstack([x, x + np.diag([0.02, 0.02, 0.03, 0.1])])
            options = {"initial_simplex": corners, "xatol": 1e-4, "fatol": 1e-5, "maxiter": 300}
            x = minimize(cost, x, args=(kernel,), method="Nelder-Mead", options=options).x
        return x

    starts = _starts([(lens, normals(camera.focal_px * lens)) for lens in LENSES], weight)
    best = min(map(refined, starts), key=lambda x: cost(x, KERNEL))
    share = agreement(best, KERNEL)
    if share < LEAST_SHARE:
        return None

    own = np.arange(len(lines)), np.abs(offsets(best)).argmin(axis=1)  # the direction that each runs in
    runs = np.abs(offsets(best)[own]) < 2.0 * KERNEL
    step = 1e-4 * np.eye(4)
    changes = [offsets(best + each)[own] - offsets(best - each)[own] for each in step]
    slopes = np.stack(changes, axis=-1)[runs] / 2e-4
    worth = weight / np.square(weight).sum() * 2.0 / (REPEATED * KERNEL**2)
    information = slopes.T @ (worth[runs, None] * slopes) + np.diag([1e-3, 1e-3, 1e-3, LENS_STD**-2.0 * 1e-2])
    covariance = np.linalg.inv(information)[np.ix_([0, 1, 3], [0, 1, 3])] + np.diag(FLOOR_STD**2)
    tilt_rad, roll_rad = map(float, best[:2])
    return RoomView(tilt_rad, roll_rad, camera.focal_px * float(np.exp(best[3])), covariance, share)


def _directions(tilt: float, roll: float, heading: float) -> Array:
    """(3, 3) the room's directions in the camera's axes, the plumb one first."""
    cos, sin = np.cos(heading), np.sin(heading)
    room = np.array([[0.0, 0.0, 1.0], [cos, sin, 0.0], [-sin, cos, 0.0]])
    return np.asarray(room @ CameraPlacement(0.0, tilt, roll).rotation())


def _starts(planes: list[tuple[float, Array]], weight: Array) -> list[Array]:
    """The likeliest of a coarse grid: tilt, roll, heading and logarithm of the lens, none near another."""
    tilts = np.arange(-WIDEST_TILT, WIDEST_TILT + 0.01, COARSE_STEP)
    rolls = np.arange(-WIDEST_ROLL, WIDEST_ROLL + 0.01, COARSE_STEP)
    headings = np.arange(0.0, np.pi / 2, 1.5 * COARSE_STEP)
    found: list[tuple[float, Array]] = []
    axes = np.array([[_directions(tilt, roll, 0.0) for roll in rolls] for tilt in tilts])  # (T, R, 3, 3)
    for lens, normal in planes:
        off = axes @ normal.T  # (T, R, 3, N)
        plumb = np.exp(-((off[:, :, 0] / COARSE_KERNEL) ** 2))
        for heading in headings:
            along = np.cos(heading) * off[:, :, 1] + np.sin(heading) * off[:, :, 2]
            across = np.cos(heading) * off[:, :, 2] - np.sin(heading) * off[:, :, 1]
            level = np.exp(-((np.minimum(np.abs(along), np.abs(across)) / COARSE_KERNEL) ** 2))
            score = np.maximum(plumb, level) @ weight - LENS_COST * (np.log(lens) / LENS_STD) ** 2
            for index in np.argsort(-score, axis=None)[:3]:
                row, column = np.unravel_index(index, score.shape)
                place = np.array([tilts[row], rolls[column], heading, np.log(lens)])
                found.append((float(score[row, column]), place))
    kept: list[Array] = []
    for _, place in sorted(found, key=lambda one: -one[0]):
        if all(np.abs(place[:2] - one[:2]).max() > COARSE_STEP * 1.5 for one in kept):
            kept.append(place)
    return kept[:6]
