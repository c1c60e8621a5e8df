"""The camera from lines and upright things in its picture: height, tilt, roll and lens, with deviations.

Lines that are parallel in the world meet in a vanishing point: that of the verticals says how the camera is
tilted and rolled, and together with one of level lines, at right angles to it, how long the lens is (Caprile
& Torre 1990, *Using vanishing points for camera calibration*; Criminisi, Reid & Zisserman 2000, *Single view
metrology*). Here no vanishing point is computed, as it may be anywhere, at infinity too. Each line's ends are
held against the direction in which a line through its middle would run in the picture, in pixels, and each
upright thing's upper end against where it would be over the lower one. Least squares find the most probable
camera, given what is believed of any camera beforehand: that needs no special cases.

What the picture does not determine keeps its value, as little as leaves the rest determined, which is to have
a standard deviation of at most `DETERMINED` of what is believed beforehand. Stated deviations know that what
was kept may be wrong.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from ..arrays import Array, IndexArray
from ..numerics.robust import multivariate_cost
from ..numerics.vectors import unit
from .camera import Camera
from .camera_evidence import CLICK_STD_PX, CameraEvidence
from .camera_fields import CameraPlacement

HEIGHT, TILT, ROLL, LENS = "height", "tilt", "roll", "lens"
PARAMETERS = (HEIGHT, TILT, ROLL, LENS)
UNITS = {HEIGHT: (2, " m"), TILT: (1, "°"), ROLL: (1, "°"), LENS: (1, " mm")}
"""Decimals and unit of each in sentences."""
BELIEVED_STD = np.array([0.4, np.radians(15.0), np.radians(4.0), 0.35])
"""Of the logarithm of the height (from 0.6 to 3 m about 1.4 m, twice that deviation), tilt and roll (held in
hands, or on a slanting support), and of the logarithm of the focal length (17 to 70 mm about 35)."""
KNOWN_LENS_STD = 0.01  # of the logarithm of a known focal length: zooms state theirs to a hundredth
DETERMINED = 0.5  # largest ratio of a deviation found to that believed before
START_TILTS_RAD = np.radians([0.0, -25.0, -12.0, 12.0])  # tilts from which it starts
HEADING = len(PARAMETERS)
DIFFERENCE = 1e-5
EXPECTED_WEIGHT = 4.0  # degrees of freedom of the image noise believed beforehand
LEAST_RISE_M = 0.01  # least height of the camera above a point [m]


@dataclass(frozen=True, eq=False)
class CameraFit:
    """A camera as a picture shows it."""

    camera: Camera  # with the lens and the pose found; the place on the floor and the heading are as before
    std: dict[str, float]
    """Standard deviation of each of `PARAMETERS`: height [m], tilt and roll [rad], lens [mm]; of those kept,
    how open they are."""
    kept: tuple[str, ...]  # those of `PARAMETERS` that the picture does not determine, which kept their value
    misfit_px: float
    """Root of the mean square distance of the lines' and uprights' ends from where they should be [px]."""
    excess: float
    """Ratio of those distances' variance to what drawing and standing explain; about 1 where all agree."""

    @property
    def placement(self) -> CameraPlacement:
        """Height, tilt and roll found."""
        return CameraPlacement.of(self.camera.matrix_world)

    def in_words(self, name: str) -> str:
        """One of `PARAMETERS` in words, as `tilt -3.1 ± 0.6°`, with its deviation where it was found."""
        placement = self.placement
        digits, unit = UNITS[name]
        value = {
            HEIGHT: placement.height_m,
            TILT: float(np.degrees(placement.tilt_rad)),
            ROLL: float(np.degrees(placement.roll_rad)),
            LENS: self.camera.lens_mm,
        }[name]
        spread = f" ± {self.spread(name)}" if name not in self.kept else ""
        return f"{name} {value:.{digits}f}{spread}{unit}"

    def spread(self, name: str) -> str:
        """The standard deviation of one of `PARAMETERS` in its unit."""
        digits, unit = UNITS[name]
        return f"{np.degrees(self.std[name]) if unit == '°' else self.std[name]:.{digits}f}"


def fit_camera(camera: Camera, evidence: CameraEvidence, lens_is_known: bool = False) -> CameraFit:
    """Find the camera that took a picture, from the still one believed now; a known lens is kept."""
    problem = _Problem(camera, evidence, lens_is_known)
    everything = problem.descend()
    covariance = problem.covariance(everything)
    count = len(PARAMETERS)
    shares = np.sqrt(np.diag(covariance))[:count]
    # The fewest parameters are kept that leave the others determined: what a picture says of two together, as
    # of height and tilt by someone who stands in one place, holds for the one once the other is kept.
    kept = [index for index, std in enumerate(problem.believed_std[:count]) if std <= KNOWN_LENS_STD]
    while len(kept) < count:
        free = np.setdiff1d(np.arange(len(covariance)), kept)
        # Given those kept, the others have the inverse of what is left of the information.
        variance = np.diag(np.linalg.inv(np.linalg.inv(covariance)[np.ix_(free, free)]))
        uncertain = (np.sqrt(variance) / problem.believed_std[free])[free < count]
        if uncertain.max() <= DETERMINED:
            break
        kept.append(int(free[uncertain.argmax()]))
    kept.sort()
    best = problem.descend_from(everything, np.array(kept, dtype=np.intp))
    found = problem.camera_of(best)
    placement = CameraPlacement.of(found.matrix_world)
    unit = np.array([placement.height_m, 1.0, 1.0, found.lens_mm])
    off_px, _ = problem.residuals(best)
    return CameraFit(
        replace(found, matrix_world=placement.applied_to(camera.matrix_world)),
        dict(zip(PARAMETERS, map(float, shares * unit), strict=True)),
        tuple(PARAMETERS[index] for index in kept),
        float(np.sqrt(np.mean(off_px**2))) if off_px.size else 0.0,
        problem.excess(best),
    )


@dataclass(frozen=True, eq=False)
class _Problem:
    """The estimation problem.

    Its unknowns x are changes of `PARAMETERS` (logarithms of height and lens), then, where there are any, the
    heading of the level lines relative to the camera, then what the uprights have in common: the logarithm of
    their lengths, and their lean [rad].
    """

    camera: Camera
    evidence: CameraEvidence
    lens_is_known: bool

    @property
    def has_level_lines(self) -> bool:
        return bool(len(self.evidence.along) or len(self.evidence.across))

    @property
    def believed_std(self) -> Array:
        """(X,) standard deviation of each unknown beforehand; endless of the heading."""
        std = BELIEVED_STD.copy()
        if self.lens_is_known:
            std[PARAMETERS.index(LENS)] = KNOWN_LENS_STD
        heading = [np.inf] if self.has_level_lines else []
        uprights = self.evidence.uprights
        return np.array([*std, *heading, *np.maximum([uprights.common_std, uprights.common_lean_rad], 1e-6)])

    def camera_of(self, x: Array) -> Camera:
        """The camera of x, above the world's origin and looking along +Y."""
        now = CameraPlacement.of(self.camera.matrix_world)
        higher, tilted, rolled, longer = map(float, x[: len(PARAMETERS)])
        height = max(now.height_m, LEAST_RISE_M) * float(np.exp(higher))
        placement = CameraPlacement(height, now.tilt_rad + tilted, now.roll_rad + rolled)
        lens_mm = self.camera.lens_mm * float(np.exp(longer))
        return replace(self.camera, lens_mm=lens_mm, matrix_world=placement.matrix())

    def residuals(self, x: Array) -> tuple[Array, Array]:
        """Of all lines and uprights (R,), in px and in standard deviations."""
        camera = self.camera_of(x)
        parts = [_line_residuals(camera, self.evidence.vertical, np.array([0.0, 0.0, 1.0]))]
        if self.has_level_lines:
            across, along = np.cos(x[HEADING]), np.sin(x[HEADING])
            parts.append(_line_residuals(camera, self.evidence.along, np.array([across, along, 0.0])))
            parts.append(_line_residuals(camera, self.evidence.across, np.array([-along, across, 0.0])))
        lines = np.concatenate(parts)
        px, scaled = self._upright_residuals(camera, float(np.exp(x[-2])), float(x[-1]))
        whitened = [lines / CLICK_STD_PX, scaled]
        room, placement = self.evidence.room, CameraPlacement.of(camera.matrix_world)
        if room is not None:
            turned = [placement.tilt_rad - room.tilt_rad, placement.roll_rad - room.roll_rad]
            off = [*turned, np.log(camera.focal_px / room.focal_px)]
            whitened.append(np.linalg.solve(np.linalg.cholesky(room.covariance), off))
        return np.concatenate([lines, px]), np.concatenate(whitened)

    def descend(self) -> Array:
        """The most probable x (X,), from the likeliest starts."""
        headings = np.arange(8) * np.pi / 8 if self.has_level_lines else np.zeros(1)
        starts = np.zeros((len(headings) * len(START_TILTS_RAD), len(self.believed_std)))
        starts[:, PARAMETERS.index(TILT)] = np.tile(START_TILTS_RAD, len(headings))
        if self.has_level_lines:
            starts[:, HEADING] = np.repeat(headings, len(START_TILTS_RAD))
        order = np.argsort([self._cost(start) for start in starts])[:3]  # the likeliest
        nothing = np.zeros(0, dtype=np.intp)
        return min((self.descend_from(starts[index], nothing) for index in order), key=self._cost)

    def descend_from(self, start: Array, kept: IndexArray) -> Array:
        """The most probable x (X,) near a start (X,), with the parameters of these indices as they were."""
        begin = start.copy()
        begin[kept] = 0.0
        free = np.setdiff1d(np.arange(len(start)), kept)

        def whole(values: Array) -> Array:
            x = begin.copy()
            x[free] = values
            return x

        found = least_squares(lambda values: self._rows(whole(values)), begin[free], method="lm")
        return whole(found.x)

    def _cost(self, x: Array) -> float:
        return float((self._rows(x) ** 2).sum())

    def covariance(self, x: Array) -> Array:
        """Covariance (X, X) at x, widened where residuals are larger than explained."""
        normal = self._normal(x)
        return np.asarray(np.linalg.inv(normal / max(1.0, self.excess(x)) + self._believed))

    def excess(self, x: Array) -> float:
        """Ratio of the residuals' variance at x to the expected one."""
        normal = self._normal(x)
        determined = float(np.trace(np.linalg.solve(normal + self._believed, normal)))
        squared = self._scaled(x) ** 2
        free = max(len(squared) - determined, 0.0)
        return (float(squared.sum()) + EXPECTED_WEIGHT) / (free + EXPECTED_WEIGHT)

    @property
    def _believed(self) -> Array:
        return np.diag(self.believed_std**-2.0)

    def _normal(self, x: Array) -> Array:
        """Normal matrix (X, X) of what the picture shows."""
        steps = DIFFERENCE * np.eye(len(x))
        rows = [self._scaled(x + sign * step) for step in steps for sign in (1.0, -1.0)]
        jacobian = ((np.array(rows[::2]) - np.array(rows[1::2])) / (2.0 * DIFFERENCE)).T
        return np.asarray(jacobian.T @ jacobian)

    def _scaled(self, x: Array) -> Array:
        """Residuals; where any are doubtful, their squares are twice the cost of Student's t."""
        _, scaled = self.residuals(x)
        if not self.evidence.uprights.doubtful:
            return scaled
        return np.asarray(np.sign(scaled) * np.sqrt(2.0 * multivariate_cost(scaled**2, 4.0, 1)))

    def _rows(self, x: Array) -> Array:
        return np.concatenate([self._scaled(x), x / self.believed_std])

    def _upright_residuals(self, camera: Camera, longer: float, lean_rad: float) -> tuple[Array, Array]:
        """Residuals (2 N,) of the upper ends, along and aside [px], and in standard deviations."""
        uprights = self.evidence.uprights
        location, sight = camera.rays(uprights.lower_px)
        rise = np.maximum(location[2] - uprights.lower_m, LEAST_RISE_M)
        lower = location + (rise / np.maximum(-sight[:, 2], 1e-3))[:, None] * sight
        upper = lower + (longer * uprights.length_m)[:, None] * np.array([0.0, 0.0, 1.0])
        shown, _ = camera.project(upper)
        shown = np.where(np.isfinite(shown), shown, camera.principal_point)  # of what is behind the camera
        drawn = uprights.upper_px - uprights.lower_px
        size = np.linalg.norm(drawn, axis=-1)
        upward = drawn / np.maximum(size, 1.0)[:, None]
        off = uprights.upper_px - shown
        aside = off[:, 0] * upward[:, 1] - off[:, 1] * upward[:, 0] - lean_rad * size
        px = np.concatenate([(off * upward).sum(-1), aside])
        # An error of the lower end moves the predicted upper one by the ratio of their rises to the camera.
        carried = (rise - uprights.length_m) / rise
        along = np.hypot(uprights.pixel_std * np.hypot(1.0, carried), uprights.length_std * size)
        across = np.hypot(uprights.pixel_std * np.sqrt(2.0), uprights.lean_std_rad * size)
        return px, px / np.concatenate([along, across])


def _line_residuals(camera: Camera, lines: Array, direction: Array) -> Array:
    """How far each line's ends lie from the line of that direction in space through its middle, (L,) [px].

    Both ends lie equally far; together they count as much as one that lies sqrt(2) times as far.
    """
    if not len(lines):
        return np.zeros(0)
    location, sight = camera.rays(lines.mean(axis=1))
    shown = camera.project_jacobian(location + sight) @ direction
    shown = unit(shown)
    half = 0.5 * (lines[:, 1] - lines[:, 0])
    return np.asarray(np.sqrt(2.0) * (half[:, 0] * shown[:, 1] - half[:, 1] * shown[:, 0]))
