"""Files of earlier versions: they open as they were saved, and the work goes on in them.

Those in the folder `saved` were written by the version that it is called after, in Blender 4.5.
"""

import json
import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import pytest
from keymark.core.prior.library import library_digest, read_library
from keymark.core.shoot.discovery import take_path
from keymark.core.take.conversion_record import conversion_digest, is_up_to_date, read_record
from keymark.core.take.description import describe, effective_settings
from keymark.operators.shell.take_state import TakeState

SAVED = Path(__file__).resolve().parent / "saved"
VERSIONS = ("0.1.0",)
ROUNDED = 1e-5
"""Values were noted with five decimals."""
CLOSE = 1e-4
"""Difference between two Blenders' values of the same curve."""

pytestmark = pytest.mark.usefixtures("registered")


@dataclass(frozen=True)
class Saved:
    """A copy of the files of one version, and what its scene held."""

    folder: Path
    held: dict[str, Any]

    @property
    def take(self) -> Path:
        """The folder of the take."""
        return self.folder / "shoot" / "take"

    def property(self, path: str) -> Any:
        """A property of the first take when it was saved."""
        return self.held["properties"][f"keymark.takes[0].{path}"]


@pytest.fixture(params=VERSIONS)
def saved(request: pytest.FixtureRequest, tmp_path: Path) -> Saved:
    """The files of a version, where they may be changed."""
    folder = Path(shutil.copytree(SAVED / request.param, tmp_path / "saved"))
    held = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
    # A clip is recognized by its modification time as well.
    os.utime(folder / "shoot" / "take" / "clip.mp4", (held["clip_time_s"],) * 2)
    return Saved(folder, held)


@pytest.fixture
def scene(saved: Saved) -> bpy.types.Scene:
    """The scene, opened."""
    bpy.ops.wm.open_mainfile(filepath=str(saved.folder / "scene.blend"))
    return bpy.context.scene


def active_take(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The active take; looked up anew after every operator."""
    return scene.keymark.takes[scene.keymark.active_take]


DROPPED = (
    "].matching.ranking",  # libraries are not ranked, all of them take part
    "].turntable.",
    ".outdated",  # follows from the digest of what was made
    "].strength",  # of weak frames, which are in their order
    "keymark.libraries",  # the library is in its pose assets
    "keymark.active_library",
    "keymark.timeline.",
    "keymark.overlays.path_",
    "keymark.overlays.line_width",
    "keymark.overlays.uncertain_beyond",
)
"""Properties of then that nothing needs any more."""
REPLACED = {"].matching.library_name": "auto", "].matching.library": "auto"}
"""Values of then that say what another button says now: to find keyframes with all libraries is Pose All."""


def is_gone(path: str, value: Any) -> bool:
    """Whether a property of then, or what it said, is nothing that is kept in a file any more."""
    replaced = any(path.endswith(name) and value == said for name, said in REPLACED.items())
    return replaced or any(name in path for name in DROPPED)


def found(scene: bpy.types.Scene, path: str) -> Any:
    """The value under a path of a scene's properties, as JSON."""
    value: Any = scene
    for name, index in re.findall(r"(\w+)(?:\[(\d+)\])?", path.removesuffix(".len")):
        value = getattr(value, name)
        value = value[int(index)] if index else value
    if path.endswith(".len"):
        return len(value)
    if isinstance(value, bpy.types.ID):
        return value.name
    if isinstance(value, set):
        return sorted(value)
    return value if isinstance(value, bool | int | float | str) or value is None else list(value)


def is_same(value: Any, expected: Any) -> bool:
    """Whether a property has its value still."""
    if isinstance(expected, str | bool) or expected is None:
        return type(value) is type(expected) and value == expected
    if isinstance(expected, list) and any(isinstance(part, str) for part in expected):
        return bool(value == expected)
    return bool(value == pytest.approx(expected, rel=1e-6, abs=ROUNDED))


def curves(action: bpy.types.Action) -> dict[tuple[str, int], bpy.types.FCurve]:
    """An Action's curves by path and index."""
    (bag,) = action.layers[0].strips[0].channelbags
    return {(curve.data_path, curve.array_index): curve for curve in bag.fcurves}


def keys_by_type(curve: bpy.types.FCurve) -> dict[str, int]:
    """The number of keys of each type in a curve."""
    types = [key.type for key in curve.keyframe_points]
    return {kind: types.count(kind) for kind in sorted(set(types))}


def test_every_property_has_its_value(saved: Saved, scene: bpy.types.Scene) -> None:
    expected = saved.held["properties"]
    assert expected["keymark.takes.len"] == 2 and expected["keymark.takes[0].matching.matches.len"] >= 3
    differing = [
        f"{path}: {value} became {found(scene, path)}"
        for path, value in expected.items()
        if not is_gone(path, value) and not is_same(found(scene, path), value)
    ]
    assert differing == []
    for index, take in enumerate(scene.keymark.takes):
        assert TakeState(take).final_is_outdated is expected[f"keymark.takes[{index}].finish.outdated"]


def test_the_scene_is_set_up_as_it_was(saved: Saved, scene: bpy.types.Scene) -> None:
    expected = saved.held["scene"]
    assert [scene.frame_start, scene.frame_end, scene.frame_current] == expected["range"]
    assert scene.render.fps / scene.render.fps_base == pytest.approx(expected["rate"])
    assert [scene.render.resolution_x, scene.render.resolution_y] == expected["size"]
    assert sorted(thing.name for thing in scene.objects) == expected["objects"]
    bones = {bone.name: bone.length for bone in active_take(scene).armature.data.bones}
    assert bones == pytest.approx(expected["bones_m"], abs=ROUNDED)
    clip = active_take(scene).clip
    assert clip.filepath == "//shoot/take/clip.mp4" and list(clip.size) == expected["size"]


def test_every_action_has_its_curves(saved: Saved, scene: bpy.types.Scene) -> None:
    frames = saved.held["curves_at"]
    assert {action.name for action in bpy.data.actions} == set(saved.held["actions"])
    for name, expected in saved.held["actions"].items():
        action, asset = bpy.data.actions[name], bpy.data.actions[name].asset_data
        said = asset and [asset.author, asset.license, asset.catalog_id, [tag.name for tag in asset.tags]]
        assert (action.slots[0].identifier, said) == (expected["slot"], expected["asset"])
        now = curves(action)
        assert len(now) == len(expected["curves"])
        for path, index, types, values in expected["curves"]:
            curve = now[path, index]
            assert keys_by_type(curve) == types, f"{name}: {path}[{index}]"
            shown = [curve.evaluate(frame) for frame in frames]
            assert shown == pytest.approx(values, rel=CLOSE, abs=CLOSE), f"{name}: {path}[{index}]"


def test_what_was_found_of_the_markers_still_holds(saved: Saved, scene: bpy.types.Scene) -> None:
    take = active_take(scene)
    assert len(take.markers) == 5 and all(marker.has_readout(take) for marker in take.markers)
    os.utime(saved.take / "clip.mp4")
    bpy.ops.wm.open_mainfile(filepath=str(saved.folder / "scene.blend"))
    take = active_take(bpy.context.scene)
    assert not any(marker.has_readout(take) for marker in take.markers)


def test_the_motion_is_reconstructed_and_finished_anew(saved: Saved, scene: bpy.types.Scene) -> None:
    before = set(bpy.data.actions)
    matched = saved.property("matching.matches.len")
    assert bpy.ops.keymark.reconstruct() == {"FINISHED"}
    take = active_take(scene)
    assert TakeState(take).final_is_outdated and take.review.frame_count == scene.frame_end
    assert take.notes[0].text.startswith(f"2 of {2 + matched} keyframes are posed")
    # Intervals of found keyframes, also of one library, follow from their confidence now, and these are
    # not too sure of themselves.
    assert -0.15 < take.review.confidence - saved.property("review.confidence") < 0.1
    assert bpy.ops.keymark.bake_motion() == {"FINISHED"}
    settings = active_take(scene).finish
    assert (
        not TakeState(active_take(scene)).final_is_outdated and 0 < settings.keys_after < settings.keys_before
    )
    assert settings.furthest_mm <= settings.tolerance_mm == saved.property("finish.tolerance_mm")
    assert set(bpy.data.actions) == before


def test_matches_are_accepted_and_others_chosen(saved: Saved, scene: bpy.types.Scene) -> None:
    action = active_take(scene).keyframe_action
    (path,) = {path for path, _ in curves(action) if path.endswith('["pelvis"].location')}
    matched = saved.property("matching.matches.len")
    assert keys_by_type(curves(action)[path, 2]) == {"GENERATED": matched, "KEYFRAME": 2}
    active_take(scene).matching.shown_match = 1
    assert scene.frame_current == saved.property("matching.matches[1].frame")
    value = curves(action)[path, 2].evaluate(scene.frame_current)
    assert bpy.ops.keymark.replace_match(candidate=2) == {"FINISHED"}
    assert curves(action)[path, 2].evaluate(scene.frame_current) != pytest.approx(value, abs=1e-6)
    assert active_take(scene).matching.matches[1].candidate.name == saved.property(
        "matching.matches[1].candidates[2].name"
    )
    assert keys_by_type(curves(action)[path, 2]) == {"GENERATED": matched, "KEYFRAME": 2}
    assert bpy.ops.keymark.accept_match() == {"FINISHED"}
    assert keys_by_type(curves(action)[path, 2]) == {"GENERATED": matched - 1, "KEYFRAME": 3}


def test_footage_is_matched_again_beside_what_is_posed(saved: Saved, scene: bpy.types.Scene) -> None:
    take = active_take(scene)
    poses = {key.co.x: key.co.y for key in keyed(take) if key.type == "KEYFRAME"}
    assert bpy.ops.keymark.pose_all(library=take.matching.library_name) == {"FINISHED"}
    take = active_take(scene)
    assert {key.co.x: key.co.y for key in keyed(take) if key.type == "KEYFRAME"} == poses
    assert len(poses) == 2 and len(take.matching.matches) == saved.property("matching.matches.len") == 5
    assert 0.0 < take.matching.fit < 1.0  # A probability now; files of 0.1.0 hold a share of the footage.


def keyed(take: bpy.types.PropertyGroup) -> list[bpy.types.Keyframe]:
    """The keys of one curve of the keyframes."""
    return list(next(iter(curves(take.keyframe_action).values())).keyframe_points)


def test_the_review_leads_to_its_weak_frames(saved: Saved, scene: bpy.types.Scene) -> None:
    count = saved.property("review.weak_frames.len")
    assert count >= 1
    for frame in [saved.property(f"review.weak_frames[{row}].frame") for row in range(count)]:
        assert bpy.ops.keymark.jump_to_weak_frame(direction="NEXT") == {"FINISHED"}
        assert scene.frame_current == frame
    assert bpy.ops.keymark.jump_to_weak_frame(direction="NEXT") == {"CANCELLED"}
    before = len(keyed(active_take(scene)))
    assert bpy.ops.keymark.pose_from_motion(where="WEAK") == {"FINISHED"}
    assert len(keyed(active_take(scene))) == before + 1


def test_the_library_in_the_file_is_in_its_pose_assets(saved: Saved, scene: bpy.types.Scene) -> None:
    written = json.loads((saved.folder / "shoot" / "gestures.json").read_text(encoding="utf-8"))
    path = saved.folder / "saved.json"
    assert bpy.ops.keymark.export_library(filepath=str(path), source="ASSETS") == {"FINISHED"}
    assert json.loads(path.read_text(encoding="utf-8")) == written


def test_the_motion_is_exported(saved: Saved, scene: bpy.types.Scene) -> None:
    path = saved.folder / "motion.bvh"
    assert bpy.ops.keymark.export_motion(format="BVH", filepath=str(path)) == {"FINISHED"}
    assert f"Frames: {scene.frame_end}" in path.read_text(encoding="utf-8")


def test_the_take_opens_from_its_folder(saved: Saved) -> None:
    assert bpy.ops.keymark.open_take(filepath=str(saved.take)) == {"FINISHED"}
    take = active_take(bpy.context.scene)
    assert [marker.name for marker in take.markers] == [
        saved.property(f"markers[{row}].name") for row in range(5)
    ]
    posed = json.loads((saved.take / "keyframes.json").read_text(encoding="utf-8"))["keyframes"]
    assert [round(key.co.x) for key in keyed(take)] == [row["frame"] for row in posed]
    assert len(posed) == 2 + saved.property("matching.matches.len")


def test_a_library_file_reads_the_same(saved: Saved) -> None:
    path = saved.folder / "shoot" / "gestures.json"
    written = json.loads(path.read_text(encoding="utf-8"))
    assert read_library(path).to_json() == written
    assert len(written["postures"]) == 3 and len(written["motions"]) == 2


def test_a_batch_converts_anew_what_an_earlier_version_has_converted(saved: Saved) -> None:
    results = saved.folder / "results" / "take"
    record = read_record(results)
    assert record.keymark in VERSIONS and record.library == "gestures"
    library = read_library(saved.folder / "shoot" / "gestures.json")

    def now() -> str:
        description = describe(take_path(saved.take))
        settings = effective_settings(description)
        libraries = [library_digest(library)]
        return conversion_digest(description, settings, libraries, results, record.keymark)

    before = now()
    assert before != record.digest
    assert not is_up_to_date(results, record.digest)
    for name in record.files:
        (results / name).touch()
    assert is_up_to_date(results, record.digest)
    keyframes = saved.take / "keyframes.json"
    keyframes.write_text(keyframes.read_text(encoding="utf-8") + " ", encoding="utf-8")
    assert now() != before
