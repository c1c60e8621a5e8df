"""Descriptions of takes: their own file, `shoot.json` above, and the line of a list."""

import json
from pathlib import Path
from typing import Any

import pytest
from _synthetic_take import shoot_fields as usual_fields
from _synthetic_take import write_json, write_shoot, write_synthetic_take
from keymark.core.errors import InputError
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import (
    Description,
    describe,
    effective_settings,
    find_shoot_files,
    shoot_fields,
)
from keymark.core.take.take_file import read_take

FRAMES = 5


@pytest.fixture
def shoot(tmp_path: Path) -> Path:
    """A shoot's folder, root of all files of the test."""
    write_json(tmp_path / "shoot.json", {"root": True})
    return tmp_path


def take_in(folder: Path, **fields: Any) -> Path:
    """A take's folder with these fields in `take.json`."""
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / "take.json", fields)
    return folder


def settings_of(path: Path, **overrides: Any) -> ConversionSettings:
    """The settings of a take, some of them overridden."""
    return describe(path, overrides, "list.jsonl, line 1").settings


def test_the_nearest_file_counts(shoot: Path) -> None:
    write_json(
        shoot / "shoot.json", {"root": True, "method": "map", "floor_m": 1.0, "pictures": True, "fps": 24}
    )
    take = take_in(shoot / "day" / "take")
    assert settings_of(take).method == "map" and settings_of(take).pictures is True
    write_json(shoot / "day" / "shoot.json", {"method": "ekf", "pictures": False})
    assert settings_of(take).method == "ekf" and settings_of(take).pictures is False
    take_in(take, method="interpolation")
    assert settings_of(take).method == "interpolation" and settings_of(take).floor_m == 1.0
    assert settings_of(take, method="map").method == "map"
    assert describe(take).fields.source_of("fps") == str(shoot / "shoot.json")
    assert describe(take).files == (shoot / "shoot.json", shoot / "day" / "shoot.json", take / "take.json")


def test_nothing_is_inherited_from_above_a_root(shoot: Path) -> None:
    write_json(shoot / "shoot.json", {"root": True, "fps": 24, "method": "ekf"})
    (shoot / "day").mkdir()
    write_json(shoot / "day" / "shoot.json", {"root": True})
    take = take_in(shoot / "day" / "take")
    assert settings_of(take).method is None and not describe(take).fields.has("fps")


def test_a_path_with_dots_inherits_from_no_other_shoot(shoot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (shoot / "day1").mkdir()
    write_json(shoot / "day1" / "shoot.json", {"method": "ekf"})
    take = take_in(shoot / "day2" / "take")
    monkeypatch.chdir(shoot / "day1")
    description = describe(Path("..") / "day2" / "take")
    assert description.settings.method is None and len(description.files) == 2
    monkeypatch.chdir(take)
    assert describe(Path()).name == "take"
    (take / "inner").mkdir()
    monkeypatch.chdir(take / "inner")
    assert describe(Path("..")).name == "take"


def test_a_shoot_file_that_is_no_file_is_refused(shoot: Path) -> None:
    take = take_in(shoot / "day" / "take")
    (shoot / "day" / "shoot.json").mkdir()
    with pytest.raises(InputError, match=r"shoot\.json: is a folder, no file"):
        describe(take)


def test_options_of_the_command_line_are_defaults_in_a_batch(shoot: Path) -> None:
    take = take_in(shoot / "take", method="ekf")
    chosen = effective_settings(describe(take), ConversionSettings(method="map", floor_m=0.5))
    assert chosen == ConversionSettings(method="ekf", floor_m=0.5)


def test_a_library_is_used_beside_existing_keyframes(shoot: Path) -> None:
    take = take_in(shoot / "take", library="walking")
    assert effective_settings(describe(take)).keyframes is None
    write_json(take / "keyframes.json", {"keyframes": []})
    assert effective_settings(describe(take)).keyframes == take / "keyframes.json"


def test_auto_keyframes_are_the_same_as_the_library_auto(shoot: Path) -> None:
    plain = settings_of(take_in(shoot / "plain"), library="auto")
    auto = describe(take_in(shoot / "auto", keyframes="auto"))
    assert auto.settings == plain == ConversionSettings(library="auto")
    assert not auto.fields.has("keyframes") and auto.fields.source_of("library").endswith("take.json")
    write_json(auto.folder / "keyframes.json", {"keyframes": []})
    assert effective_settings(describe(auto.folder)).keyframes == auto.folder / "keyframes.json"
    write_json(shoot / "shoot.json", {"root": True, "keyframes": "auto"})
    posed = describe(take_in(shoot / "posed", keyframes="mine.json"))
    assert (posed.settings.keyframes, posed.settings.library) == (posed.folder / "mine.json", "auto")
    line = describe(posed.folder, {"keyframes": "auto"}, "list.jsonl, line 1")
    assert line.settings == posed.settings


def test_the_nearer_of_library_and_auto_keyframes_counts(shoot: Path) -> None:
    write_json(shoot / "shoot.json", {"root": True, "keyframes": "auto"})
    assert settings_of(take_in(shoot / "walk", library="walking")).library == "walking"
    assert settings_of(take_in(shoot / "all")).library == "auto"
    for name in ("library", "keyframes"):
        assert settings_of(take_in(shoot / name, **{name: None})) == ConversionSettings()
    write_json(shoot / "shoot.json", {"root": True, "library": "walking"})
    assert settings_of(take_in(shoot / "jump", keyframes="auto")).library == "auto"
    assert settings_of(take_in(shoot / "own", keyframes=None)).library == "walking"


def test_auto_keyframes_and_a_library_in_one_file_are_refused(shoot: Path) -> None:
    take = take_in(shoot / "take", keyframes="auto", library="walking")
    with pytest.raises(InputError, match=r"take\.json: keyframes is 'auto' and library is 'walking'; the"):
        describe(take)
    assert settings_of(take_in(shoot / "both", keyframes="auto", library="auto")).library == "auto"
    write_json(shoot / "shoot.json", {"root": True, "keyframes": "posed.json"})
    with pytest.raises(InputError, match=r"shoot\.json: keyframes is 'posed\.json'; .*must be auto"):
        describe(take_in(shoot / "other"))


def test_paths_are_relative_to_the_file_that_gives_them(shoot: Path) -> None:
    write_json(shoot / "shoot.json", {"root": True, "library": "ours.json"})
    take = take_in(shoot / "take")
    assert settings_of(take).library == str(shoot / "ours.json")
    assert settings_of(take, library="own.JSON").library == str(take / "own.JSON")
    assert settings_of(take, library="walking").library == "walking"
    assert settings_of(take, keyframes="posed/a.json").keyframes == take / "posed" / "a.json"


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"library": "../ours.json"}, "library is '../ours.json'; it must be"),
        ({"library": "/etc/passwd"}, "library is '/etc/passwd'; it must be"),
        ({"library": "..\\x"}, "library is"),
        ({"library": "a/b"}, "library is 'a/b'"),
        ({"library": "x" * 300}, "library is 'xxx"),
        ({"library": 7}, "library is 7"),
        ({"keyframes": "../keyframes.json"}, "keyframes is '../keyframes.json'"),
        ({"clip": "../clip.mp4"}, "clip is '../clip.mp4'"),
        ({"method": "magic"}, "method is 'magic'; it must be one of map, ekf, interpolation"),
        ({"pictures": 1}, "pictures is 1; it must be true or false"),
        ({"floor_m": 1e9}, "floor_m is 1000000000.0; it must be a number from -1000 to 1000 m"),
    ],
)
def test_a_wrong_setting_is_named_with_its_file(fields: dict[str, Any], said: str, shoot: Path) -> None:
    take = take_in(shoot / "take", **fields)
    with pytest.raises(InputError, match=said) as caught:
        describe(take)
    assert str(caught.value).startswith(str(take / "take.json"))
    with pytest.raises(InputError, match=r"^list\.jsonl, line 1: "):
        describe(take_in(shoot / "other"), fields, "list.jsonl, line 1")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ({"root": 1}, "root is 1; it must be true or false"),
        ({"schema_version": 2}, "schema_version is 2, made by a newer Keymark; this one reads up to 1"),
        ({"schema_version": 0}, "schema_version is 0"),
        ({"actr": {}}, "unknown field 'actr' \\(is 'actor' meant\\?\\)"),
        ({"clip": "a.mp4"}, "unknown field 'clip'"),
    ],
)
def test_a_mistake_in_a_shoot_file_is_named(content: dict[str, Any], said: str, tmp_path: Path) -> None:
    write_json(tmp_path / "shoot.json", content)
    with pytest.raises(InputError, match=said) as caught:
        shoot_fields(*find_shoot_files(tmp_path).popitem())
    assert str(caught.value).startswith(str(tmp_path / "shoot.json"))


def test_fields_about_a_shoot_file_itself_are_not_inherited(tmp_path: Path) -> None:
    said = {"$schema": "shoot.schema.json", "schema_version": 1, "root": True, "fps": 24}
    write_json(tmp_path / "shoot.json", said)
    assert shoot_fields(*find_shoot_files(tmp_path).popitem()) == {"fps": 24}


def described(folder: Path, name: str) -> Description:
    return describe(folder / "day1" / name)


def test_a_bare_clip_is_described_by_its_shoot_and_its_sidecar_files(tmp_path: Path) -> None:
    folder = write_shoot(tmp_path / "shoot", 1, FRAMES)
    beside = folder / "day1" / "take01.take.json"
    write_json(beside, {"actor": {"height_m": 1.6}, "clip": "other.mp4"})
    found = described(folder, "take01.mp4")
    assert (found.name, found.file, found.inherits) == ("take01", beside, True)
    assert found.clip == folder / "day1" / "take01.mp4"
    assert found.keyframes == folder / "day1" / "take01.keyframes.json"
    take = read_take(found.path)
    assert take.fps == pytest.approx(30.0) and take.frame_start == 1
    assert take.body.actor.stature_m == pytest.approx(1.6)


def test_a_clip_that_nothing_describes_is_refused(tmp_path: Path) -> None:
    write_json(tmp_path / "shoot.json", {"root": True})
    (tmp_path / "clip.mp4").touch()
    (tmp_path / "shoot.json").unlink()
    if any((folder / "shoot.json").exists() for folder in tmp_path.parents):
        pytest.skip("a shoot lies above the folder for tests")
    with pytest.raises(
        InputError, match=r"nothing describes this clip; clip\.take\.json beside it, or shoot\.json"
    ):
        describe(tmp_path / "clip.mp4")


@pytest.mark.parametrize("path", ["none", "none/deeper", "x" * 300, "a\0b"])
def test_an_impossible_path_is_refused(path: str, shoot: Path) -> None:
    with pytest.raises(InputError, match=r"a take is a folder that holds take\.json"):
        describe(shoot / path)


def test_links_may_lead_anywhere_in_the_shoot_but_not_out_of_it(tmp_path: Path) -> None:
    folder = tmp_path / "shoot"
    folder.mkdir()
    write_json(folder / "shoot.json", {"root": True, "library": "ours.json"})
    take = take_in(folder / "take")
    (folder / "footage.mp4").touch()
    (tmp_path / "private").write_text(json.dumps({}), encoding="utf-8")
    try:
        (take / "clip.mp4").symlink_to(folder / "footage.mp4")
    except OSError:
        pytest.skip("no links here")
    assert describe(take).clip == take / "clip.mp4"
    for path in (take / "clip.mp4", take / "keyframes.json", folder / "ours.json", take / "take.json"):
        before = path.read_bytes() if path.exists() and not path.is_symlink() else None
        path.unlink(missing_ok=True)
        path.symlink_to(tmp_path / "private")
        with pytest.raises(InputError, match=f"^{path}: leads by a link to .*private"):
            describe(take)
        path.unlink()
        if before is not None:
            path.write_bytes(before)
    (take / "frames").mkdir()
    (take / "frames" / "1.png").symlink_to(tmp_path / "private")
    take_in(take, clip="frames")
    with pytest.raises(InputError, match=r"1\.png: leads by a link"):
        describe(take)


def test_what_the_camera_lacks_is_missing_in_the_file_that_describes_it(tmp_path: Path) -> None:
    shoot = write_shoot(tmp_path / "shoot", takes=1)
    fields = usual_fields()
    del fields["camera"]["lens_mm"]
    write_json(shoot / "shoot.json", fields)
    with pytest.raises(InputError) as error:
        read_take(shoot / "day1" / "take01.mp4")
    assert str(error.value).startswith(f"{shoot / 'shoot.json'}: camera: lens_mm is missing")


def test_a_named_keyframe_file_that_is_missing_is_told_with_the_file_that_names_it(shoot: Path) -> None:
    take = write_synthetic_take(shoot / "take", 8)
    fields = json.loads((take / "take.json").read_text(encoding="utf-8"))
    write_json(take / "take.json", {**fields, "keyframes": "walking"})
    with pytest.raises(InputError) as error:
        read_take(take)
    named = f"{take / 'walking'}: no such file ({take / 'take.json'} names it)"
    assert str(error.value).startswith(named)
