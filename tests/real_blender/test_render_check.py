"""The motion's body, rendered, shows its markers where the footage does: all done by a real Blender."""

from pathlib import Path

import pytest
import render_check
from installed_blender import Blender
from keymark.core.markers.region_tracks import RegionTracks


@pytest.fixture(scope="module")
def rendered(
    blender: Blender, demo_take: Path, repository: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, RegionTracks]:
    """The demonstration take converted and rendered from both sides, and its markers extracted."""
    folder = tmp_path_factory.mktemp("render_check")
    keyframes = demo_take / render_check.KEYFRAMES
    words = ["convert", demo_take, "--keyframes", keyframes, "--output", folder / "out", "--quiet"]
    done = blender.run("--command", "keymark", *words, "--no-report")
    assert done.returncode == 0, done.stdout + done.stderr
    script = repository / "tests" / "render_motion.py"
    tracks = {}
    for view in render_check.VIEWS:
        images = folder / view.name
        images.mkdir()
        camera = view.camera(demo_take, folder)
        options = ["-b", "--factory-startup", "--python-exit-code", "1", "--python", script, "--"]
        blend = folder / "out" / "motion.blend"
        done = blender.run(*options, blend, camera, images, str(render_check.STEP))
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        tracks[view.name] = render_check.extract(images, demo_take)
    return tracks


@pytest.mark.parametrize("view", render_check.VIEWS, ids=lambda view: view.name)
def test_the_body_covers_its_markers(
    rendered: dict[str, RegionTracks], demo_take: Path, view: render_check.View
) -> None:
    render_check.assert_agreement(rendered[view.name], demo_take, view)


@pytest.mark.parametrize("view", render_check.VIEWS, ids=lambda view: view.name)
def test_a_late_motion_is_noticed(
    rendered: dict[str, RegionTracks], demo_take: Path, view: render_check.View
) -> None:
    render_check.assert_lateness_fails(rendered[view.name], demo_take, view)
