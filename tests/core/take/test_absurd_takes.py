"""Takes whose numbers are valid one by one and absurd together: one sentence, or a motion."""

import json
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from _synthetic_take import MATRIX_WORLD, write_synthetic_take
from keymark.operators.cli.main import main

FRAMES = 12
Change = Callable[[dict[str, Any], list[dict[str, Any]]], object]


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_synthetic_take(tmp_path_factory.mktemp("takes") / "pristine", FRAMES, 4)


def camera(**fields: Any) -> Change:
    return lambda take, _: take["camera"].update(fields)


def camera_at(y_m: float) -> list[list[float]]:
    return [MATRIX_WORLD[0], [*MATRIX_WORLD[1][:3], y_m], *MATRIX_WORLD[2:]]


def moved(meters: float) -> Change:
    def change(_: dict[str, Any], rows: list[dict[str, Any]]) -> None:
        for row in rows:
            row["points"] = {name: [x + meters, y, z] for name, (x, y, z) in row["points"].items()}

    return change


def lengths(meters: float) -> Change:
    return lambda take, _: take["actor"].update(segments_m=dict.fromkeys(take["actor"]["segments_m"], meters))


def many_keyframes(count: int) -> Change:
    def change(take: dict[str, Any], rows: list[dict[str, Any]]) -> None:
        take.pop("frame_count")
        rows[:] = [{"frame": frame + 1, "points": rows[0]["points"]} for frame in range(count)]

    return change


def all_equal(_: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    for row in rows[1:]:
        row["points"] = rows[0]["points"]


def far_keyframe(take: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    take.pop("frame_count")
    rows.append({"frame": 10**6, "points": rows[0]["points"]})


REFUSED: dict[str, tuple[Change, str]] = {
    "frames": (lambda take, _: take.update(frame_count=10**6), "frame_count is 1000000"),
    "a keyframe far off": (far_keyframe, "keyframe 1000000 lies outside the clip"),
    "too many keyframes": (
        many_keyframes(20_001),
        "keyframes has 20001 of them; it must be a list of at most 20000",
    ),
    "more keyframes than frames": (many_keyframes(30), "lies outside the clip"),
    "lens": (camera(lens_mm=1e-9), "lens_mm is 1e-09"),
    "telescope": (camera(lens_mm=1e5), "not one point of any keyframe lies in the camera's picture"),
    "resolution": (camera(resolution=[10**9, 10**9]), "resolution is"),
    "camera inside": (camera(matrix_world=camera_at(0.02)), "behind the camera"),
    "camera at infinity": (camera(matrix_world=camera_at(-1e300)), "each must be within 1e"),
    "distortion": (camera(distortion=[1e300]), "distortion is"),
    "keyframes aside": (moved(900.0), "not one point of any keyframe lies in the camera's picture"),
    "colors": (lambda take, _: take["markers"]["trunk"].update(color_srgb=[0, 0, 0]), "matches nothing"),
}
CONVERTED: dict[str, Change] = {
    "rate": lambda take, _: take.update(fps=1000),
    "small": lengths(0.02),
    "large": lengths(2.0),
    "equal keyframes": all_equal,
    "tiny numbers": camera(shift_x=5e-324, shift_y=-0.0, distortion=[5e-324]),
    "more poses than frames": camera(matrix_world_frames=[MATRIX_WORLD] * 10_000),
}


def convert(pristine: Path, folder: Path, change: Change, method: str) -> int:
    """Change a take and convert it; a warning of numbers is an error."""
    take = Path(shutil.copytree(pristine, folder / "take"))
    said = json.loads((take / "take.json").read_text(encoding="utf-8"))
    posed = json.loads((take / "keyframes.json").read_text(encoding="utf-8"))
    change(said, posed["keyframes"])
    (take / "take.json").write_text(json.dumps(said), encoding="utf-8")
    (take / "keyframes.json").write_text(json.dumps(posed), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        words = ["convert", str(take), "--output", str(folder / "out"), "--quiet", "--no-report"]
        return main([*words, "--method", method])


@pytest.mark.usefixtures("no_blender")
@pytest.mark.parametrize("kind", REFUSED)
def test_contradictory_takes_are_refused(
    kind: str, pristine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change, sentence = REFUSED[kind]
    assert convert(pristine, tmp_path, change, "interpolation") == 2
    said = capsys.readouterr().err
    assert sentence in said and len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("no_blender")
@pytest.mark.parametrize("method", ["interpolation", "map", "ekf"])
@pytest.mark.parametrize("kind", CONVERTED)
def test_unusual_takes_convert(
    kind: str, method: str, pristine: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(pristine, tmp_path, CONVERTED[kind], method) == 0, capsys.readouterr().err
    assert (tmp_path / "out" / "motion.json").is_file()
