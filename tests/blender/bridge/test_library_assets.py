"""Keyframe libraries as pose assets: to files, to other armatures, and back."""

import json
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from _fuzz import changed
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.prior.library import (
    Library,
    LibraryMotion,
    LibraryPosture,
    MotionStep,
    read_library,
    write_library,
)
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.library import (
    HEADER,
    POSTURE,
    PoseAsset,
    add_assets,
    library_from_assets,
    read_library_blend,
    write_library_blend,
)
from keymark.operators.bridge.pose import read_posture

RandomPosture = Callable[[int], Posture]
ANGLE = 1e-6


@pytest.fixture
def library(random_posture: RandomPosture) -> Library:
    names = ("Left Heel Strike", "Midstance", "ÄÖ" * 30, "Toe-off, late")
    tags: tuple[tuple[str, ...], ...] = ((), ("swing", "a, b"), ("ß" * 40,), ("late",))
    postures = tuple(
        LibraryPosture(name, random_posture(seed), tags[seed]) for seed, name in enumerate(names)
    )
    steps = tuple(MotionStep(name, 0.123456789 * place) for place, name in enumerate(names))
    cycle = LibraryMotion("Cycle", steps, 1.05, True, (0.0, -1.1234567, 0.25))
    once = LibraryMotion("Once: again", steps[:2], 0.7)
    return Library(
        *("gait-1", "Gait: slow/fast", 3, "Ä. Author", "CC-BY-4.0", Actor.from_stature(1.81)),
        postures=postures,
        motions=(cycle, once),
        description="For tests.",
        sources=("Winter (2009)", "Perry; Burnfield (2010)"),
        tags=("walk",),
    )


def file_bytes(library: Library, folder: Path) -> bytes:
    write_library(folder / "x.json", library)
    return (folder / "x.json").read_bytes()


def test_a_library_file_comes_back_from_assets_to_the_last_byte(library: Library, tmp_path: Path) -> None:
    first = file_bytes(library, tmp_path)
    add_assets(read_library(tmp_path / "x.json"))
    (back,) = library_from_assets(bpy.data.actions)
    assert file_bytes(back, tmp_path) == first
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "work.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "work.blend"))
    (back,) = library_from_assets(bpy.data.actions)
    assert file_bytes(back, tmp_path) == first


def test_what_the_animator_changes_in_an_asset_counts(library: Library) -> None:
    actions = add_assets(library)
    stored = PoseAsset.of(actions[0]).posture().posture
    fcurve = next(
        curve
        for curve in actions[0].layers[0].strips[0].channelbags[0].fcurves
        if curve.data_path == 'pose.bones["forearm.L"].rotation_euler' and curve.array_index == 0
    )
    fcurve.keyframe_points[0].co[1] += 0.25
    actions[0].name = "Heel Contact"
    actions[0].asset_data.tags.new("mine")
    posture = PoseAsset.of(actions[0]).posture()
    assert posture.name == "Heel Contact" and posture.tags == ("mine",)
    flexion = HUMAN.dof_names.index("elbow.L.flexion")
    change = posture.posture.minus(stored)
    assert change[flexion] == pytest.approx(0.25, abs=ANGLE)
    pronation = HUMAN.dof_names.index("forearm.L.pronation")
    others = [i for i in range(HUMAN.dof_count) if i not in (flexion, pronation)]
    assert (change[others] == 0.0).all()
    (back,) = library_from_assets(actions)
    assert [step.posture for step in back.motions[0].steps][0] == "Heel Contact"


def test_a_deleted_asset_leaves_the_motions(library: Library) -> None:
    actions = add_assets(library)
    bpy.data.actions.remove(actions[0])
    (back,) = library_from_assets(bpy.data.actions)
    assert len(back.postures) == 3
    assert [step.time_s for step in back.motions[0].steps] == pytest.approx([0.0, 0.123456789, 0.246913578])
    assert len(back.motions[1].steps) == 1


def test_the_curves_pose_an_actor_as_the_library_does(library: Library) -> None:
    body = Body(library.actor)
    actor = build_armature(bpy.context.scene, body)
    for action, posture in zip(add_assets(library), library.postures, strict=True):
        actor.pose.apply_pose_from_action(action, evaluation_time=1.0)
        shown = body.points(body.pose(read_posture(actor, body).posture))
        assert np.abs(shown - body.points(body.pose(posture.posture))).max() < 1e-5


def test_assets_are_seen_as_such(library: Library) -> None:
    action = add_assets(library)[1]
    data = action.asset_data
    assert (data.author, data.license, data.description) == ("Ä. Author", "CC-BY-4.0", "For tests.")
    assert {tag.name for tag in data.tags} == {"swing", "a, b"}
    assert tuple(action.preview.image_size) == (256, 256)
    assert action.use_fake_user
    assert tuple(action.frame_range) == (1.0, 1.0)


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        (HEADER, "{", "no valid JSON"),
        (HEADER, "[]", "must hold an object"),
        (HEADER, "{}", "schema"),
        (POSTURE, '{"postures": []}', "postures"),
        (POSTURE, '{"postures": 3}', "postures"),
        (POSTURE, '{"postures": [{"name": "a", "posture": {"pelvis.location_x": 1e999}}]}', "number"),
        (POSTURE, "[" * 100_000, "nested too deeply"),
    ],
)
def test_nonsense_in_an_asset_is_one_sentence(library: Library, name: str, value: str, sentence: str) -> None:
    action = add_assets(library)[0]
    action[name] = value
    with pytest.raises(InputError, match=sentence) as raised:
        library_from_assets([action])
    assert "\n" not in str(raised.value)


@pytest.fixture
def texts(library: Library) -> dict[str, str]:
    """Those that the first of two assets stores."""
    action = add_assets(library)[0]
    return {name: action[name] for name in (HEADER, POSTURE)}


@settings(max_examples=120, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_changed_texts_of_an_asset_are_refused_or_read(texts: dict[str, str], data: st.DataObject) -> None:
    actions = [bpy.data.actions[name] for name in ("Left Heel Strike", "Midstance")]
    for name, text in texts.items():
        actions[0][name] = text
    name = data.draw(st.sampled_from((HEADER, POSTURE)))
    actions[0][name] = json.dumps(data.draw(changed(json.loads(texts[name]))))
    try:
        assert library_from_assets(actions)
    except InputError as error:
        assert "\n" not in str(error)


def test_nonsense_in_curves_is_passed_over(library: Library) -> None:
    action = add_assets(library)[0]
    bag = action.layers[0].strips[0].channelbags[0]
    bag.fcurves.new('["evil"]', index=0).keyframe_points.insert(1, 5)
    for curve in bag.fcurves:
        if "location" in curve.data_path or "quaternion" in curve.data_path:
            curve.keyframe_points[0].co[1] = float("nan")
    posture = PoseAsset.of(action).posture().posture
    assert np.isfinite(posture.to_vector()).all()


@pytest.mark.parametrize("content", [b"", b"BLENDER", b"BLENDER-v405" + b"x" * 500, b"PK\x03\x04"])
def test_a_broken_blend_says_so_and_leaves_nothing(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "bad.blend"
    file.write_bytes(content)
    before = set(bpy.data.user_map())
    with pytest.raises(InputError, match="bad.blend"):
        read_library_blend(file)
    assert set(bpy.data.user_map()) == before


def test_a_cut_off_blend_says_so(library: Library, tmp_path: Path) -> None:
    write_library_blend(tmp_path / "a.blend", library)
    whole = (tmp_path / "a.blend").read_bytes()
    for share in (0.01, 0.3, 0.7, 0.99):
        (tmp_path / "b.blend").write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(InputError):
            read_library_blend(tmp_path / "b.blend")
    assert not len(bpy.data.actions)


def test_a_blend_without_libraries_is_refused(tmp_path: Path) -> None:
    action = bpy.data.actions.new("Other")
    action.asset_mark()
    bpy.data.libraries.write(str(tmp_path / "other.blend"), {action})
    bpy.data.actions.remove(action)
    with pytest.raises(InputError, match="holds no pose assets of a keyframe library"):
        read_library_blend(tmp_path / "other.blend")
    assert not len(bpy.data.actions)
