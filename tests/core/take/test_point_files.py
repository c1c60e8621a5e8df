"""Files of points: csv, npy, TRC and C3D, read by their names and refused in one sentence."""

from pathlib import Path

import numpy as np
import pytest
from _elsewhere import write_mhr70
from _performances import stepping
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.errors import InputError
from keymark.core.take.point_files import MEDIAPIPE, read_points, write_c3d, write_trc
from keymark.core.take.reference import read_reference


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
    found, rate = read_points(file)
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
    found, rate = read_points(tmp_path / "body.npy")
    np.testing.assert_allclose(found, points, atol=1e-9)
    assert rate is None
    names = [name.removeprefix("body_").removesuffix("_x") for name in header[2:] if name.endswith("_x")]
    rows = [",".join(header)]
    for frame in range(12):
        cells = [str(value) for name in names for value in values[frame, MEDIAPIPE.index(name)]]
        rows.append(",".join([str(frame), str(frame / 25.0), *cells]))
    (tmp_path / "body.csv").write_text("\n".join(rows))
    found, rate = read_points(tmp_path / "body.csv")
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
