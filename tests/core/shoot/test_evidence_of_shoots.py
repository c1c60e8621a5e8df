"""Keypoints and evidence of many takes: names that every take has, sidecars of clips, lists, digests."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from _synthetic_take import edit_json, true_postures, write_json, write_keypoints, write_shoot
from keymark.core.errors import InputError
from keymark.core.shoot.discovery import open_shoot
from keymark.core.take.conversion_record import conversion_digest
from keymark.core.take.conversion_settings import NO_SETTINGS, ConversionSettings
from keymark.core.take.description import Description, describe, effective_settings
from keymark.core.take.take import evidence_of
from keymark.core.take.take_file import read_described, read_take
from keymark.operators.cli.batch.worker_process import Job

FRAMES = 8


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A shoot of two clips and a folder, all with keypoints of two detectors; tests must not change it."""
    folder = write_shoot(tmp_path_factory.mktemp("evidence") / "shoot", 3, FRAMES)
    every = true_postures(FRAMES + 3)
    for take, start in enumerate(("day1/take01.", "day1/take02.", "day1/take03/")):
        posture = every[take : take + FRAMES]
        write_keypoints(folder / f"{start}keypoints.json", posture)
        write_keypoints(folder / f"{start}pose.json", posture, detector="other")
    return folder


@pytest.fixture
def shoot(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "shoot"))


def names(shoot: Path, defaults: ConversionSettings = NO_SETTINGS) -> list[list[str]]:
    """Paths of the files that each take's conversion reads its keypoints from."""
    found = []
    for take in open_shoot(shoot).takes:
        described = take.describe()
        settings = effective_settings(described, defaults)
        people = read_described(described, settings.keyframes, settings=settings).keypoints
        folder = shoot if shoot.is_dir() else shoot.parent
        found.append([Path(one.file).relative_to(folder).as_posix() for one in people])
    return found


def test_sidecars_of_clips_are_found(shoot: Path) -> None:
    own = ["day1/take01.keypoints.json", "day1/take02.keypoints.json", "day1/take03/keypoints.json"]
    assert names(shoot) == [[name] for name in own]


def test_a_shoot_names_the_file_of_every_take(shoot: Path) -> None:
    others = ["day1/take01.pose.json", "day1/take02.pose.json", "day1/take03/pose.json"]
    assert names(shoot, ConversionSettings(keypoints=(Path("pose.json"),))) == [[name] for name in others]
    edit_json(shoot / "shoot.json", keypoints=["pose.json", "keypoints.json"])
    assert [one[0] for one in names(shoot)] == others
    assert names(shoot)[0] == ["day1/take01.pose.json", "day1/take01.keypoints.json"]
    edit_json(shoot / "day1" / "take02.take.json", keypoints="take01.pose.json")
    assert names(shoot)[1] == ["day1/take01.pose.json"]
    edit_json(shoot / "day1" / "take02.take.json", keypoints=None)
    assert names(shoot)[1] == ["day1/take02.keypoints.json"]


def test_a_take_without_the_file_is_refused(shoot: Path) -> None:
    (shoot / "day1" / "take02.pose.json").unlink()
    edit_json(shoot / "shoot.json", keypoints="pose.json")
    assert len(read_take(shoot / "day1" / "take01.mp4").keypoints) == 1
    with pytest.raises(InputError, match=r"take02\.pose\.json"):
        read_take(shoot / "day1" / "take02.mp4")


def test_evidence_is_inherited(shoot: Path) -> None:
    edit_json(shoot / "shoot.json", evidence=["markers"])
    edit_json(shoot / "day1" / "take02.take.json", markers=None, evidence=None)
    kinds = [evidence_of(read_take(take.path)) for take in open_shoot(shoot).takes]
    assert kinds == [("markers",), ("keypoints", "contours"), ("markers",)]
    line = {"take": "day1/take01.mp4", "evidence": ["keypoints"], "keypoints": "take01.pose.json"}
    (shoot / "list.jsonl").write_text(json.dumps(line), encoding="utf-8")
    assert names(shoot / "list.jsonl") == [["day1/take01.pose.json"]]
    (take,) = open_shoot(shoot / "list.jsonl").takes
    assert evidence_of(read_described(take.describe())) == ("keypoints",)


def test_a_worker_gets_the_settings(shoot: Path) -> None:
    defaults = ConversionSettings(keypoints=(Path("a.json"), Path("b")), evidence=("keypoints", "contours"))
    job = Job(open_shoot(shoot).takes[0], shoot / "out", defaults)
    assert Job.from_line(job.to_line()).defaults == defaults
    assert Job.from_line(Job(job.take, job.folder, NO_SETTINGS).to_line()).defaults == NO_SETTINGS


def digest(described: Description, **chosen: Any) -> str:
    settings = effective_settings(described, ConversionSettings(**chosen))
    return conversion_digest(described, settings, (), described.folder / "out", "1")


def test_the_digest_follows_content_and_choice(shoot: Path) -> None:
    clip = shoot / "day1" / "take01.mp4"
    digests = [digest(describe(clip))]
    digests += [digest(describe(clip), evidence=kinds) for kinds in (("markers",), ("keypoints",))]
    digests.append(digest(describe(clip), keypoints=(Path("pose.json"),)))
    write_keypoints(shoot / "day1" / "take01.keypoints.json", true_postures(FRAMES), detector="newer")
    digests.append(digest(describe(clip)))
    assert len(set(digests)) == len(digests)
    assert digest(describe(clip), evidence=("markers",)) == digests[1]
    edit_json(shoot / "shoot.json", evidence=["markers"])
    assert digest(describe(clip)) == digests[1]


def test_a_take_without_keypoints_has_the_digest_it_had(tmp_path: Path) -> None:
    clip = write_shoot(tmp_path / "shoot", 1, FRAMES) / "day1" / "take01.mp4"
    before = digest(describe(clip))
    assert digest(describe(clip), keypoints=None, evidence=None) == before
    write_keypoints(clip.with_name("take01.pose.json"), true_postures(FRAMES))
    assert digest(describe(clip)) == before


def test_the_files_of_a_folder_count(shoot: Path) -> None:
    clip, folder = shoot / "day1" / "take01.mp4", shoot / "day1" / "take01.openpose"
    folder.mkdir()
    for frame in range(FRAMES):
        write_json(folder / f"take01_{frame:012d}_keypoints.json", {"people": []})
    edit_json(shoot / "day1" / "take01.take.json", keypoints="take01.openpose")
    before = digest(describe(clip))
    (folder / f"take01_{FRAMES - 1:012d}_keypoints.json").unlink()
    fewer = digest(describe(clip))
    write_json(folder / f"take01_{0:012d}_keypoints.json", {"people": [], "version": 1.3})
    assert len({before, fewer, digest(describe(clip))}) == 3
