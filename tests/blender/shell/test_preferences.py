"""The extension's preferences: a detector's command and its time limit."""

from collections.abc import Iterator

import bpy
import pytest
from keymark.core.errors import InputError
from keymark.operators.shell import preferences
from keymark.operators.shell.preferences import EXTENSION, KEYMARK_AP_preferences, preferred_detector


@pytest.fixture(autouse=True)
def no_detector(monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment names none."""
    monkeypatch.delenv("KEYMARK_DETECTOR", raising=False)


@pytest.fixture
def own(registered: None) -> Iterator[KEYMARK_AP_preferences]:
    """The preferences, as they are where the extension is enabled."""
    addon = bpy.context.preferences.addons.new()
    addon.module = EXTENSION
    yield addon.preferences
    bpy.context.preferences.addons.remove(addon)


def test_they_are_registered_for_the_extension_itself(registered: None) -> None:
    """Blender finds them by the name of the extension, and every field has its tooltip."""
    assert EXTENSION == "keymark" and KEYMARK_AP_preferences.is_registered
    properties = KEYMARK_AP_preferences.bl_rna.properties
    for name in ("detector", "detector_minutes"):
        assert properties[name].description and not properties[name].description.endswith(".")
    assert "{clip}" in properties["detector"].description


def test_without_the_extension_there_is_no_detector(registered: None) -> None:
    """As in the Python module, and where it is only run from a folder."""
    assert preferences.preferences() is None and preferred_detector() is None


def test_the_detector_of_the_preferences(own: KEYMARK_AP_preferences) -> None:
    """None where the field is empty; else its words and its limit."""
    assert preferred_detector() is None
    own.detector, own.detector_minutes = "find --fast {clip} {output}", 7
    detector = preferred_detector()
    assert detector is not None and detector.time_limit_s == 420.0
    assert detector.command.words == ("find", "--fast", "{clip}", "{output}")
    own.detector = "find {output}"
    with pytest.raises(InputError, match="the detector of Keymark's preferences: has no {clip}"):
        preferred_detector()


def test_the_environment_goes_before_the_preferences(
    own: KEYMARK_AP_preferences, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Studios set it for all machines; the time limit stays that of the preferences."""
    own.detector, own.detector_minutes = "mine {clip}", 3
    monkeypatch.setenv("KEYMARK_DETECTOR", "theirs {clip}")
    detector = preferred_detector()
    assert detector is not None and detector.command.words[0] == "theirs" and detector.time_limit_s == 180.0
