"""Motions in files: our own, and points of other programs; what is damaged is refused in one sentence."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _performances import stepping, write_mhr70
from _synthetic_take import BODY, edit_json, true_postures
from keymark.core.arrays import Array
from keymark.core.body.fingers import Hands
from keymark.core.body.human import HUMAN
from keymark.core.errors import ConversionError, InputError
from keymark.core.take.motion import Motion, read_motion, write_motion
from keymark.core.take.point_files import MEDIAPIPE, read_points, write_c3d, write_trc
from keymark.core.take.reference import read_reference

FRAMES = 10


@pytest.fixture
def motion() -> Motion:
    """A motion with uneven time stamps, a full covariance and diagnostics with gaps."""
    random = np.random.default_rng(3)
    posture = true_postures(FRAMES)
    root = 0.02 * random.normal(size=(FRAMES, 13, 3, 3))
    quality = random.random((FRAMES, 5))
    quality[2, 1] = np.nan
    return Motion(
        BODY,
        29.97,
        101,
        np.cumsum(random.uniform(0.02, 0.05, FRAMES)),
        posture,
        BODY.points(BODY.pose(posture)),
        root @ np.swapaxes(root, -1, -2),
        (0, 4, 9),
        "map",
        {"quality": quality, "posing_scale": np.array(1.25)},
        hands=Hands(*(random.random((FRAMES, 2, *shape)) for shape in ((5,), (3,), ()))),
    )


def test_a_motion_is_read_back(motion: Motion, tmp_path: Path) -> None:
    write_motion(motion, tmp_path / "motion.json")
    back = read_motion(tmp_path / "motion.json")
    assert (back.fps, back.frame_start, back.method) == (29.97, 101, "map")
    assert back.keyframe_indices == motion.keyframe_indices
    assert dict(back.body.actor.segments_m) == dict(BODY.actor.segments_m)
    assert np.allclose(back.time_s, motion.time_s, atol=1e-6, rtol=0)
    assert np.allclose(back.points, motion.points, atol=1e-6, rtol=0)
    assert np.abs(back.posture.minus(motion.posture)).max() < 3e-6
    assert np.allclose(back.point_covariance, motion.point_covariance, rtol=1e-5, atol=1e-12)
    assert np.allclose(back.diagnostics["quality"], motion.diagnostics["quality"], rtol=1e-5, equal_nan=True)
    assert back.diagnostics["posing_scale"] == pytest.approx(1.25)
    assert back.hands is not None and motion.hands is not None
    for name in ("curls", "bend", "sure"):
        np.testing.assert_allclose(getattr(back.hands, name), getattr(motion.hands, name), atol=1e-6)
    write_motion(motion.emptied(np.arange(FRAMES) != 0), tmp_path / "motion.json")
    absent = read_motion(tmp_path / "motion.json")
    assert absent.empty == (0,) and absent.hands is not None
    np.testing.assert_array_equal(absent.hands.curls[0], absent.hands.curls[1])
    shown = absent.without_absence().hands
    assert shown is not None and len(shown.sure) == FRAMES - 1
    write_motion(replace(motion, hands=None), tmp_path / "motion.json")
    assert read_motion(tmp_path / "motion.json").hands is None


def test_the_file_is_what_other_programs_expect(motion: Motion, tmp_path: Path) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is no JSON")

    write_motion(motion, tmp_path / "motion.json")
    value = json.loads((tmp_path / "motion.json").read_text(encoding="utf-8"), parse_constant=refuse)
    assert value["frame_start"] == 101 and value["fps"] == 29.97
    assert value["keyframes"] == [101, 105, 110]
    assert set(value["points"]) == set(value["sigma_m"]) == set(BODY.skeleton.point_names)
    assert set(value["posture"]) == set(BODY.skeleton.dof_names)
    assert np.shape(value["points"]["wrist.L"]) == (FRAMES, 3)
    wrist = BODY.skeleton.point_names.index("wrist.L")
    trace = np.trace(motion.point_covariance[:, wrist], axis1=-2, axis2=-1)
    assert np.allclose(value["sigma_m"]["wrist.L"], np.sqrt(trace), atol=1e-6)
    hips = 0.5 * (np.array(value["points"]["hip.L"]) + np.array(value["points"]["hip.R"]))
    assert np.allclose(value["posture"]["pelvis.location_x"], hips[:, 0], atol=2e-6)


def test_the_same_motion_gives_the_same_bytes(motion: Motion, tmp_path: Path) -> None:
    write_motion(motion, tmp_path / "a.json")
    write_motion(motion, tmp_path / "b.json")
    write_motion(motion, tmp_path / "b.json")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "b.json"]


def test_without_a_covariance_no_sigma_is_claimed(motion: Motion, tmp_path: Path) -> None:
    unknown = replace(motion, point_covariance=np.full((FRAMES, 13, 3, 3), np.nan))
    write_motion(unknown, tmp_path / "motion.json")
    assert "sigma_m" not in json.loads((tmp_path / "motion.json").read_text(encoding="utf-8"))
    assert np.isnan(read_motion(tmp_path / "motion.json").point_covariance).all()


def test_a_motion_with_gaps_is_not_written(motion: Motion, tmp_path: Path) -> None:
    points = motion.points.copy()
    points[6, 2, 1] = np.nan
    with pytest.raises(ConversionError, match="frame 107"):
        write_motion(replace(motion, points=points), tmp_path / "motion.json")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda v: v.update(schema_version=99), "schema_version is 99"),
        (lambda v: v.pop("time_s"), "time_s is missing"),
        (lambda v: v["time_s"].pop(), "time_s is"),
        (lambda v: v["points"].pop("head"), "head is missing"),
        (lambda v: v["points"]["head"].__setitem__(3, [0, 1]), "points: head is"),
        (lambda v: v["posture"]["elbow.L.flexion"].__setitem__(3, "x"), r"elbow\.L\.flexion is"),
        (lambda v: v.update(keyframes=[300]), r"keyframes is \[300\]"),
        (lambda v: v["actor"]["segments_m"].update(trunk=-1), "trunk is -1"),
        (lambda v: v["diagnostics"].update(quality="good"), "diagnostics: quality is 'good'"),
    ],
)
def test_a_damaged_motion_file_is_named(
    motion: Motion, tmp_path: Path, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    path = tmp_path / "motion.json"
    write_motion(motion, path)
    edit_json(path, change)
    with pytest.raises(InputError, match=sentence) as caught:
        read_motion(path)
    assert "motion.json" in str(caught.value)


@pytest.fixture(scope="module")
def points() -> Array:
    """(12, 13, 3) points, one of which is missing once."""
    body, posture = stepping()
    found = body.points(body.pose(posture[:12]))
    found[4, 2] = np.nan
    return found


@pytest.mark.parametrize(("write", "ending"), [(write_trc, "trc"), (write_c3d, "c3d")])
def test_what_is_written_is_read(tmp_path: Path, points: Array, write: object, ending: str) -> None:
    file = tmp_path / f"joints.{ending}"
    write(file, points, 60.0)  # type: ignore[operator]
    found, rate, _ = read_points(file)
    np.testing.assert_allclose(found, points, atol=1e-6)
    assert rate == 60.0 and [path.name for path in tmp_path.iterdir()] == [file.name]


def test_mhr70_is_upright_and_absent_frames_are_nan(tmp_path: Path, points: Array) -> None:
    given = np.nan_to_num(points)
    given[6] = 0.0
    write_mhr70(tmp_path / "motion.csv", given)
    found = read_reference(tmp_path / "motion.csv")
    assert found.fps is None and np.isnan(found.points_m[6]).all()
    np.testing.assert_allclose(found.points_m[7], given[7], atol=1e-6)


def test_freemocap_is_in_millimeters_and_has_no_names_in_its_npy(tmp_path: Path, points: Array) -> None:
    values = np.full((12, 553, 3), np.nan)
    header = ["frame", "timestamp"]
    for index, name in enumerate(HUMAN.point_names):
        stem, dot, side = name.partition(".")
        own = [f"{'left' if side == 'L' else 'right'}_{stem}"] if dot else ["left_ear", "right_ear"]
        for one in own:
            values[:, MEDIAPIPE.index(one)] = 1e3 * points[:, index]
            header += [f"body_{one}_{axis}" for axis in "xyz"]
    np.save(tmp_path / "body.npy", values)
    found, rate, _ = read_points(tmp_path / "body.npy")
    np.testing.assert_allclose(found, points, atol=1e-9)
    assert rate is None
    names = [name.removeprefix("body_").removesuffix("_x") for name in header[2:] if name.endswith("_x")]
    rows = [",".join(header)]
    for frame in range(12):
        cells = [str(value) for name in names for value in values[frame, MEDIAPIPE.index(name)]]
        rows.append(",".join([str(frame), str(frame / 25.0), *cells]))
    (tmp_path / "body.csv").write_text("\n".join(rows))
    found, rate, _ = read_points(tmp_path / "body.csv")
    np.testing.assert_allclose(found, points, atol=1e-6)
    assert rate == pytest.approx(25.0)


@pytest.mark.parametrize(
    "names",
    [
        [
            "Head",
            *(
                f"{side}{part}"
                for part in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
                for side in "LR"
            ),
        ],
        [
            "S1:nose",
            *(
                f"S1:{side}_{part}_study"
                for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
                for side in "lr"
            ),
        ],
    ],
)
def test_other_programs_names_are_known(tmp_path: Path, points: Array, names: list[str]) -> None:
    file = tmp_path / "joints.trc"
    write_trc(file, points, 30.0)
    lines = file.read_text().splitlines()
    lines[3] = "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t"
    file.write_text("\n".join(lines))
    np.testing.assert_allclose(read_points(file)[0], points, atol=1e-6)


def test_a_pickled_npy_is_never_loaded(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return Path.touch, (tmp_path / "sprung",)  # type: ignore[return-value]

    file = tmp_path / "trap.npy"
    np.save(file, np.array([Trap()], dtype=object), allow_pickle=True)
    with pytest.raises(InputError, match="cannot be read as an npy of numbers"):
        read_points(file)
    assert not (tmp_path / "sprung").exists()


def changed(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("LElbow", "Chin", "has no point for elbow.L"),
        ("\t60\t", "\t24\t", "DataRate is"),
        ("60\t60\t12", "x\t60\t12", "DataRate is"),
        ("mm", "m", "legs are"),
        ("PathFileType", "Path", "is no TRC"),
        ("0.016667", "soon", "must have numbers alone"),
    ],
)
def test_a_damaged_trc_is_refused(tmp_path: Path, points: Array, old: str, new: str, said: str) -> None:
    file = tmp_path / "joints.trc"
    write_trc(file, points, 60.0)
    if old == "\t60\t":
        old, new = "60\t60\t12", "24\t60\t12"
    changed(file, old, new)
    with pytest.raises(InputError, match=said) as caught:
        read_points(file)
    assert str(caught.value).count("\n") == 0


def test_other_columns_and_other_shapes_are_refused(tmp_path: Path, points: Array) -> None:
    (tmp_path / "other.csv").write_text("name,value\na,1\n")
    (tmp_path / "text.csv").write_text("hip_x,hip_y,hip_z\na,b,c\n")
    (tmp_path / "short.csv").write_text("hip_x,hip_y,hip_z\n1,2\n")
    np.save(tmp_path / "flat.npy", np.zeros((5, 3)))
    (tmp_path / "cut.c3d").write_bytes(b"\x02\x50" + bytes(600))
    write_c3d(tmp_path / "markers.c3d", points, 30.0, [f"M{number}" for number in range(13)])
    expected = {
        "other.csv": "must have numbers alone",
        "text.csv": "must have numbers alone",
        "short.csv": "line 2 has 2 columns",
        "flat.npy": r"has the shape \(5, 3\)",
        "cut.c3d": "cannot be read as a C3D|has no points",
        "markers.c3d": "has no point for head",
    }
    for name, said in expected.items():
        with pytest.raises(InputError, match=said):
            read_points(tmp_path / name)


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must end in"):
        read_reference(tmp_path / "motion.xyz")
    with pytest.raises(InputError, match="network.csv"):
        read_reference(tmp_path / "network.csv")
    (tmp_path / "motion.json").write_text(json.dumps({"schema": "none"}), encoding="utf-8")
    with pytest.raises(InputError, match="motion.json"):
        read_reference(tmp_path / "motion.json")
