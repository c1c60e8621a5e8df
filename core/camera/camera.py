"""The pinhole camera of the footage, in Blender's conventions, with lens distortion.

It looks along its local -Z with +Y up; *depth* is the distance along the viewing axis, positive in front.
Pixels are x right, y down, with the origin at the outer corner of the top left pixel. Sensor fit is
horizontal.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..files.fields import Fields
from .camera_fields import CameraFields, CameraPlacement


@dataclass(frozen=True, eq=False)
class Camera:
    """A fixed or moving pinhole camera with polynomial radial distortion."""

    lens_mm: float  # focal length in millimeters
    sensor_width_mm: float  # width of the sensor in millimeters; it spans the image's width
    resolution: tuple[int, int]  # image width and height in pixels (square pixels)
    matrix_world: Array  # camera to world, (4, 4) for a fixed camera, (F, 4, 4) for one pose a frame; meters
    shift_x: float = 0.0  # shift of the view to the right, in image widths
    shift_y: float = 0.0  # shift of the view upwards, in image widths (as in Blender, not heights)
    distortion: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """K1, k2, k3 of Blender's polynomial model, which takes undistorted normalized coordinates to
    distorted ones: x_d = x (1 + k1 r² + k2 r⁴ + k3 r⁶), r² = x² + y²."""

    def __post_init__(self) -> None:
        matrix = np.array(self.matrix_world, dtype=np.float64)
        matrix.setflags(write=False)
        object.__setattr__(self, "matrix_world", matrix)

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any], where: str = "camera") -> "Camera":
        """Read a camera from the `CameraFields` of `take.json`; `where` is their place for messages.

        Raises:
            InputError: A field is missing or invalid; the sentence names it.
        """
        read = CameraFields.of(Fields(fields, where))
        lens = (read.lens_mm, read.sensor_width_mm)
        size = (read.resolution[0], read.resolution[1])
        return cls(*lens, size, read.pose, read.shift_x, read.shift_y, read.distortion)

    def to_dict(self) -> dict[str, Any]:
        """The fields as in `take.json`; `from_dict` reads them back unchanged."""
        fields: dict[str, Any] = {
            "lens_mm": self.lens_mm,
            "sensor_width_mm": self.sensor_width_mm,
            "resolution": list(self.resolution),
            "shift_x": self.shift_x,
            "shift_y": self.shift_y,
        }
        if any(self.distortion):
            fields["distortion"] = list(self.distortion)
        fields["matrix_world_frames" if self.is_moving else "matrix_world"] = self.matrix_world.tolist()
        return fields

    @property
    def is_moving(self) -> bool:
        """Whether the camera has one pose a frame."""
        return self.matrix_world.ndim == 3

    @property
    def focal_px(self) -> float:
        """Focal length in pixels."""
        return self.lens_mm / self.sensor_width_mm * self.resolution[0]

    def pixels_per_meter(self, depth: ArrayLike) -> Array:
        """Pixels (...) of a meter across the view at depths (...) [m], of which the least counts as 0.1."""
        return np.asarray(self.focal_px / np.maximum(depth, 0.1))

    @property
    def principal_point(self) -> Array:
        """The principal point (2,) [px]: the image's center moved against the shifts."""
        width, height = self.resolution
        return np.array([width / 2 - self.shift_x * width, height / 2 + self.shift_y * width])

    def world_to_camera(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """Take world points (..., 3) to camera coordinates (..., 3) [m].

        Here and below, `frame` is the index of each point's pose, integers that broadcast to the leading
        axes; a fixed camera ignores it.
        """
        rotation, location = self.pose(frame)
        offset = np.asarray(points, dtype=np.float64) - location
        if rotation.ndim == 2:
            return np.asarray(offset @ rotation)
        return np.asarray(np.einsum("...ji,...j->...i", rotation, offset))

    def sight(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """Unit viewing directions (..., 3) of world points (..., 3), in world axes."""
        _, location = self.pose(frame)
        offset = np.asarray(points, dtype=np.float64) - location
        return np.asarray(offset / np.linalg.norm(offset, axis=-1, keepdims=True))

    def depth(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """The distance along the viewing axis (...) in meters of world points (..., 3)."""
        return -self.world_to_camera(points, frame)[..., 2]

    def depth_jacobian(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """Return d depth / d world point, (..., 3): the viewing direction, the same for every point."""
        rotation, _ = self.pose(frame)
        points = np.asarray(points, dtype=np.float64)
        shape = np.broadcast_shapes(points.shape, rotation[..., 2].shape)
        return np.array(np.broadcast_to(-rotation[..., 2], shape))

    def project(self, points: ArrayLike, frame: ArrayLike | None = None) -> tuple[Array, Array]:
        """Pixels (..., 2) of world points (..., 3), NaN for those not in front, and their depth (...) [m]."""
        x, y, depth = self._normalized(self.world_to_camera(points, frame))
        factor, _ = self._radial_factor(x * x + y * y)
        column, row = self.principal_point
        scale = self.focal_px * factor
        # Columns and rows lie in planes of their own in memory, as those who compute with them like best.
        return np.moveaxis(np.stack([column + scale * x, row - scale * y]), 0, -1), depth

    def project_jacobian(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """Return d pixel / d world point, (..., 2, 3) in pixels per meter; NaN behind the camera."""
        rotation, _ = self.pose(frame)
        return np.asarray(self.motion_jacobian(points, frame)[..., :3] @ np.swapaxes(rotation, -1, -2))

    def motion_jacobian(self, points: ArrayLike, frame: ArrayLike | None = None) -> Array:
        """Jacobian (..., 2, 6) of pixels by the rigid motion of the points' bodies, in the camera's own axes.

        This is the interaction matrix of visual servoing (Chaumette & Hutchinson 2006, *Visual servo control,
        part I*, eq. 11) for a camera that looks along -Z: px per meter of the velocity of the body's point
        that passes through the camera, and per radian of its angular velocity; NaN behind the camera.
        """
        x, y, depth = self._normalized(self.world_to_camera(points, frame))
        near = 1.0 / np.where(depth > 0.0, depth, np.nan)
        # Depth is -Z: moving along +Z brings the point nearer.
        rates = np.zeros((2, 6, *x.shape))
        across, up = rates
        across[0], across[2], across[3], across[4], across[5] = near, x * near, x * y, -1.0 - x * x, -y
        up[1], up[2], up[3], up[4], up[5] = near, y * near, 1.0 + y * y, -x * y, x
        if any(self.distortion):
            factor, slope = self._radial_factor(x * x + y * y)
            outward = 2.0 * slope * (x * across + y * up)
            across, up = factor * across + x * outward, factor * up + y * outward
            rates = np.stack([across, up])
        rates *= self.focal_px * np.array([1.0, -1.0]).reshape(2, *[1] * (rates.ndim - 1))
        return np.moveaxis(rates, (0, 1), (-2, -1))

    def rays(self, pixels: ArrayLike, frame: ArrayLike | None = None) -> tuple[Array, Array]:
        """Origin (3,) or (..., 3) [m] and unit direction (..., 3) of the lines of sight of pixels (..., 2).

        Directions are NaN for pixels the distortion polynomial reaches from nowhere.
        """
        rotation, location = self.pose(frame)
        offset = np.asarray(pixels, dtype=np.float64) - self.principal_point
        undistorted = self._undistort(offset / self.focal_px * np.array([1.0, -1.0]))
        camera = np.concatenate([undistorted, np.full((*undistorted.shape[:-1], 1), -1.0)], axis=-1)
        camera /= np.linalg.norm(camera, axis=-1, keepdims=True)
        return location, np.einsum("...ij,...j->...i", rotation, camera)

    def pose(self, frame: ArrayLike | None = None) -> tuple[Array, Array]:
        """The camera's orientation (..., 3, 3), its axes as columns, and its position (..., 3) [m]."""
        matrix = self.matrix_world[np.asarray(frame)] if self.is_moving else self.matrix_world
        return matrix[..., :3, :3], matrix[..., :3, 3]

    @staticmethod
    def _normalized(camera: Array) -> tuple[Array, Array, Array]:
        """Return x, y at unit depth, NaN behind the camera, and the depth."""
        depth = -camera[..., 2]
        before = np.where(depth > 0.0, depth, np.nan)
        return camera[..., 0] / before, camera[..., 1] / before, depth

    def _radial_factor(self, radius_squared: Array) -> tuple[Array, Array]:
        """The distortion factor and its derivative by the squared radius."""
        k1, k2, k3 = self.distortion
        factor = 1.0 + radius_squared * (k1 + radius_squared * (k2 + radius_squared * k3))
        return factor, k1 + radius_squared * (2.0 * k2 + 3.0 * k3 * radius_squared)

    def _undistort(self, distorted: Array) -> Array:
        """Invert the radial polynomial by Newton's method on the radius, from the distorted radius."""
        if not any(self.distortion):
            return distorted
        target = np.linalg.norm(distorted, axis=-1)
        radius = target.copy()
        with np.errstate(all="ignore"):  # a diverging pixel ends as NaN, which is its answer
            for _ in range(20):
                factor, slope = self._radial_factor(radius**2)
                radius = radius - (radius * factor - target) / (factor + 2.0 * radius**2 * slope)
            factor, slope = self._radial_factor(radius**2)
            found = np.abs(radius * factor - target) <= 1e-12 * (1.0 + target)
            # Past the fold of the polynomial a root exists that no light takes.
            found &= (radius >= 0.0) & (factor + 2.0 * radius**2 * slope > 0.0)
            scale = np.where(target > 0.0, radius / np.where(target > 0.0, target, 1.0), 1.0)
        return np.asarray(distorted * np.where(found, scale, np.nan)[..., None])


FULL_FRAME_MM = 36.0  # long side of the full-frame sensor that focal lengths are compared on [mm]

PHONE_MM = 26.0  # full-frame equivalent of a phone's main camera by its diagonal [mm]; makers state 24 to 28
STABILISED = 1.1  # crop factor of phones' video stabilization: a tenth is usual
WEBCAM_DEGREES = 68.0  # diagonal view of a webcam in 16 to 9: makers state 60 to 78

EYE_HEIGHT_M = 1.4


@dataclass(frozen=True)
class Lens:
    """A lens before anything is found."""

    lens_mm: float
    sensor_width_mm: float  # it spans the picture's width; of a guess its long side is that of full frame
    source: str  # who says so, in brackets after its number
    is_known: bool

    def put(self, size: tuple[int, int]) -> Camera:
        """A camera with this lens where cameras usually stand, for a picture of this size [px]."""
        pose = default_camera_pose(self.lens_mm, self.sensor_width_mm, size)
        return Camera(self.lens_mm, self.sensor_width_mm, size, pose)


def guess_lens(size: tuple[int, int]) -> Lens:
    """Guess a lens from the size of the picture (width, height) [px] as shown, after any rotation.

    An upright picture is a phone's; its focal length is stated for photographs of 4 to 3, whose long side a
    video keeps. A small one of 4 to 3 is a webcam's, which crops the sides of its 16 to 9 view.
    """
    width, height = size
    if height > width:
        photograph_mm = hypot(36.0, 24.0) * 4.0 / 5.0
        lens_mm, reason = STABILISED * PHONE_MM * FULL_FRAME_MM / photograph_mm, "a phone held upright"
    elif 3 * width == 4 * height and height <= 600:  # other cameras film larger, wider pictures
        focal_in_heights = 0.5 * hypot(16.0, 9.0) / 9.0 / np.tan(np.radians(WEBCAM_DEGREES / 2.0))
        lens_mm, reason = float(focal_in_heights * height / width * FULL_FRAME_MM), "a webcam"
    else:
        lens_mm, reason = 35.0, "a camera's usual zoom"  # between the wide end of a zoom and its middle
    sensor_mm = FULL_FRAME_MM * width / max(width, height)
    return Lens(round(lens_mm, 1), sensor_mm, f"a guess, as of {reason}", False)


def lens_of_equivalent(equivalent_mm: float, size: tuple[int, int]) -> tuple[float, float]:
    """Focal length and sensor width [mm] of a full-frame equivalent, for a picture of this size [px].

    It is an equivalent by the diagonal (CIPA DCG-001).
    """
    width, height = size
    sensor_mm = FULL_FRAME_MM / max(width, height)
    return equivalent_mm * hypot(width, height) * sensor_mm / hypot(36.0, 24.0), sensor_mm * width


def default_camera_pose(lens_mm: float, sensor_width_mm: float, size: tuple[int, int]) -> Array:
    """Initial pose of a camera: (4, 4) camera to world [m].

    At eye height, looking level along +Y at the world's origin, from a distance at which the floor there and
    a performer with outstretched arms are within a picture of `size` (width, height).
    """
    across = 0.45 * sensor_width_mm / lens_mm  # a performer at the origin fills nine tenths of the picture
    down = across * size[1] / size[0]
    distance = max(EYE_HEIGHT_M / down, 1.0 / across)  # half the arm span of an adult [m]
    return CameraPlacement(EYE_HEIGHT_M, 0.0, 0.0).matrix((0.0, -distance))
