"""Reference motions: the files that are read, what is refused, and takes that name one."""

import json
from pathlib import Path

import numpy as np
import pytest
from keymark.core.body.human import HUMAN
from keymark.core.errors import InputError
from keymark.core.take.reference import ReferenceMotion, read_reference

JOINTS = [
    "left_ear",
    "right_ear",
    *(
        f"{side}_{part}"
        for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
        for side in ("left", "right")
    ),
]
HEADER = [f"{name}_3D{axis}" for name in JOINTS for axis in "XYZ"]


def write(folder: Path, rows: list[list[float]], header: list[str] = HEADER) -> Path:
    lines = [",".join(header), *(",".join(map(str, row)) for row in rows)]
    file = folder / "network.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def row(seed: int) -> list[float]:
    return np.random.default_rng(seed).normal(size=len(HEADER)).round(4).tolist()


def test_a_csv_of_mhr70_is_read_with_z_up_and_zeros_absent(tmp_path: Path) -> None:
    read = read_reference(write(tmp_path, [row(1), [0.0] * len(HEADER), row(2)]))
    assert read.fps is None
    assert np.isnan(read.points_m[1]).all()
    x, y, z = row(1)[HEADER.index("left_knee_3DX") :][:3]
    np.testing.assert_allclose(read.points_m[0, HUMAN.point_names.index("knee.L")], [x, z, -y])
    ears = np.array(row(1)[:6]).reshape(2, 3).mean(axis=0)
    np.testing.assert_allclose(read.points_m[0, 0], [ears[0], ears[2], -ears[1]])


@pytest.mark.parametrize(
    ("header", "rows", "sentence"),
    [
        (HEADER[3:], [row(1)[3:]] * 3, "has no column left_ear_3DX"),
        (HEADER, [row(1), row(2)[:-1]], "line 3 has 41 columns; it must have 42"),
        (HEADER, [row(1), ["tall", *row(2)[1:]]], "line 3: could not convert string to float: 'tall'"),
        (HEADER, [row(1)], "has 1 frames; it must have 2"),
        (HEADER, [[0.0] * len(HEADER)] * 4, "a performer is in 0 of its frames"),
        (HEADER, [[float("nan")] * len(HEADER)] * 4, "a performer is in 0 of its frames"),
    ],
)
def test_a_csv_that_is_none_is_refused_with_one_sentence(
    tmp_path: Path, header: list[str], rows: list[list[float]], sentence: str
) -> None:
    with pytest.raises(InputError) as refused:
        read_reference(write(tmp_path, rows, header))
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"must end in \.csv"):
        read_reference(tmp_path / "motion.xyz")
    with pytest.raises(InputError, match="network.csv"):
        read_reference(tmp_path / "network.csv")
    (tmp_path / "motion.json").write_text(json.dumps({"schema": "none"}), encoding="utf-8")
    with pytest.raises(InputError, match="motion.json"):
        read_reference(tmp_path / "motion.json")
    with pytest.raises(ValueError, match="shape"):
        ReferenceMotion(np.zeros((4, 12, 3)))


def test_a_clips_network_is_read_as_it_lies_beside_the_takes() -> None:
    folder = Path(__file__).resolve().parents[3].parent / "shared" / "takes" / "kick"
    if not (folder / "network_mhr70.csv").is_file():
        pytest.skip("no takes beside the repository")
    read = read_reference(folder / "network_mhr70.csv")
    assert read.points_m.shape == (104, 13, 3)
    assert np.isnan(read.points_m).all(axis=(1, 2)).sum() == 4
    known = read.points_m[np.isfinite(read.points_m).all(axis=(1, 2))]
    spans = known.max(axis=(1, 2)) - known.min(axis=(1, 2))
    assert 1.0 < np.median(spans) < 2.5
