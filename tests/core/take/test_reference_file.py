"""Reference motions: the files that are read, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from keymark.core.errors import InputError
from keymark.core.take.reference import ReferenceMotion, read_reference


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must end in"):
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
