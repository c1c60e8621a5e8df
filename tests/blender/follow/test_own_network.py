"""A network of one's own in the preferences: *Detect Keypoints* and *Animate* use it or say what is wrong."""

from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path

import bpy
import numpy as np
import pytest
from _synthetic_take import BODY, true_postures
from keymark.core.detect.families.instant_hmr import LAYOUT
from keymark.core.files.json_file import read_json
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.session import see
from keymark.operators.animate import NOTHING
from keymark.operators.follow.evidence import keypoint_path
from keymark.operators.follow.load_keypoints import KEYMARK_AP_preferences, draw_network
from keymark.operators.library import registry
from keymark.operators.shell.results import EXTENSION
from keymark.operators.shell.takes import active_take

networks = pytest.importorskip("_networks", reason="onnx, which a real Blender lacks", exc_type=ImportError)


@pytest.fixture
def preferences(registered: None) -> Iterator[KEYMARK_AP_preferences]:
    """Those of an installed extension."""
    addon = bpy.context.preferences.addons.new()
    addon.module = EXTENSION
    yield addon.preferences
    bpy.context.preferences.addons.remove(addon)


@pytest.fixture
def clip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clip of dots, whom a stand-in for Keymark's own network sees."""
    (tmp_path / "clips").mkdir()
    networks.dotted_clip(tmp_path / "clips" / "dots.avi", LAYOUT)
    for module in ("keymark.core.detect.pose_network", see.__name__):
        monkeypatch.setattr(f"{module}.PoseNetwork", lambda: networks.DotNetwork(LAYOUT))
    monkeypatch.setattr("keymark.core.detect.closer_look._there", lambda _network: None)
    said = LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, true_postures(24), np.arange(24) / 30.0, said)
    monkeypatch.setattr(registry, "all_libraries", lambda: [library])
    return tmp_path / "clips" / "dots.avi"


def animate(clip: Path) -> object:
    return bpy.ops.keymark.animate(filepath=str(clip), stature=1.75, character=NOTHING)


def detect(clip: Path) -> object:
    if not bpy.context.scene.keymark.takes:
        bpy.ops.keymark.load_footage(filepath=str(clip))
    return bpy.ops.keymark.detect_keypoints()


@pytest.mark.parametrize("way", [animate, detect])
def test_a_chosen_network_looks_too_and_without_it_keymarks_own_alone(
    way: Callable, preferences: KEYMARK_AP_preferences, clip: Path
) -> None:
    file = networks.instant_hmr(clip.parents[1] / "body.onnx", LAYOUT.numbers)
    preferences.network = str(file)
    assert way(clip) == {"FINISHED"}
    (entry,) = active_take(bpy.context.scene).follow.files
    second = read_json(keypoint_path(entry))["second"]
    assert second["detector"] == "InstantHMR, 70 points, 224 x 224" and second["motion"]
    assert second["digest"] == sha256(file.read_bytes()).hexdigest()
    file.unlink()
    if way is animate:  # what it saw lies beside the clip
        assert way(clip) == {"FINISHED"}
    keypoint_path(entry).unlink()
    with pytest.raises(RuntimeError, match=r"body\.onnx: no such file"):
        way(clip)
    preferences.network = ""
    assert way(clip) == {"FINISHED"}
    (entry,) = active_take(bpy.context.scene).follow.files
    assert "second" not in read_json(keypoint_path(entry))


@pytest.mark.parametrize("way", [animate, detect])
@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (lambda whole: whole[:1000], "is no ONNX file, or a damaged one"),
        (lambda _: b"PK\x03\x04" + bytes(60), "zip"),
        (lambda _: b"", "is no ONNX file, or a damaged one .it has 0 graphs"),
    ],
)
def test_a_file_that_is_none_is_a_sentence_and_changes_nothing(
    way: Callable, content: Callable, sentence: str, preferences: KEYMARK_AP_preferences, clip: Path
) -> None:
    file = networks.instant_hmr(clip.parents[1] / "body.onnx", LAYOUT.numbers)
    file.write_bytes(content(file.read_bytes()))
    preferences.network = str(file)
    with pytest.raises(RuntimeError, match=rf"body\.onnx: .*{sentence}") as said:
        way(clip)
    assert len(str(said.value).strip().splitlines()) == 1
    assert list(clip.parent.iterdir()) == [clip]
    takes = bpy.context.scene.keymark.takes
    assert not (takes if way is animate else takes[0].follow.files)


class Drawn:
    """A layout that keeps what is drawn in it."""

    def __init__(self) -> None:
        self.shown: list[tuple[str, str]] = []

    def prop(self, _data: object, name: str, placeholder: str = "") -> None:
        """Draw a field."""
        self.shown.append((name, placeholder))


def test_the_field_is_drawn_where_it_can_be_remembered(preferences: KEYMARK_AP_preferences) -> None:
    layout = Drawn()
    draw_network(layout)
    assert layout.shown == [("network", "Keymark's Own")]
    bpy.context.preferences.addons[EXTENSION].module = "another"
    draw_network(layout)
    assert len(layout.shown) == 1
