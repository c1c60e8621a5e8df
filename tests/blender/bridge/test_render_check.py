"""The motion's body, rendered, shows its markers where the footage does: in this process' Blender."""

from pathlib import Path

import bpy
import pytest
import render_check
import render_motion
from keymark.core.markers.region_tracks import RegionTracks
from keymark.operators.cli.main import main

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def rendered(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, RegionTracks]:
    folder = tmp_path_factory.mktemp("render_check")
    take = repository / render_check.DEMO
    keyframes = take / render_check.KEYFRAMES
    words = ["convert", str(take), "--keyframes", str(keyframes), "--output", str(folder / "out"), "--quiet"]
    assert main([*words, "--no-report"]) == 0
    tracks = {}
    for view in render_check.VIEWS:
        images = folder / view.name
        images.mkdir()
        camera = view.camera(take, folder)
        render_motion.main(
            [str(folder / "out" / "motion.blend"), camera, str(images), str(render_check.STEP)]
        )
        tracks[view.name] = render_check.extract(images, take)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return tracks


@pytest.mark.parametrize("view", render_check.VIEWS, ids=lambda view: view.name)
def test_the_body_covers_its_markers(
    rendered: dict[str, RegionTracks], repository: Path, view: render_check.View
) -> None:
    render_check.assert_agreement(rendered[view.name], repository / render_check.DEMO, view)


@pytest.mark.parametrize("view", render_check.VIEWS, ids=lambda view: view.name)
def test_a_late_motion_is_noticed(
    rendered: dict[str, RegionTracks], repository: Path, view: render_check.View
) -> None:
    render_check.assert_lateness_fails(rendered[view.name], repository / render_check.DEMO, view)
