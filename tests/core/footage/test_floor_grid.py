"""The floor's grid in the picture."""

import numpy as np
import pytest
from keymark.core.footage.camera import Camera
from keymark.core.footage.camera_evidence import floor_grid
from keymark.core.footage.camera_fields import CameraPlacement

SIZE = (640, 480)


def camera(tilt: float, height_m: float = 1.5) -> Camera:
    return Camera(
        35.0, 36.0, SIZE, CameraPlacement(height_m, float(np.radians(tilt)), 0.0).matrix((0.3, 0.4))
    )


@pytest.mark.parametrize("tilt", [-60.0, -10.0, 0.0, 10.0])
def test_every_piece_lies_on_a_whole_meter_of_the_floor(tilt: float) -> None:
    seen = camera(tilt)
    grid = floor_grid(seen)
    assert len(grid.lines) > 20
    location, sight = seen.rays(grid.lines)
    floor = location + (-location[2] / sight[..., 2])[..., None] * sight
    off = np.abs(floor[..., :2] - np.round(floor[..., :2])).max(axis=1)
    assert off.min(axis=1).max() < 1e-6
    assert np.allclose(grid.depth_m, seen.depth(floor).min(axis=1))
    beside = np.abs(grid.lines - np.array(SIZE) / 2.0) / SIZE
    assert beside.max() <= 0.6 + 1e-9


def test_the_horizon_is_where_the_view_is_level() -> None:
    """In the middle of a level camera's picture, above it where the camera looks down, nowhere far down."""
    assert floor_grid(camera(0.0)).horizon[..., 1] == pytest.approx(240.0, abs=0.02)
    assert (floor_grid(camera(-10.0)).horizon[..., 1] < 150.0).all()
    assert len(floor_grid(camera(-60.0)).horizon) == 0


def test_a_camera_that_moves_sees_the_floor_from_each_pose() -> None:
    poses = np.stack([camera(0.0).matrix_world, camera(-20.0).matrix_world])
    moving = Camera(35.0, 36.0, SIZE, poses)
    assert np.allclose(floor_grid(moving, 1).lines, floor_grid(camera(-20.0)).lines)
