"""The job of a detector, with programs that work, fail, hang, flood and write where they should not."""

import os
import shlex
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from _shoot import write_video
from _synthetic_take import SIZE, true_postures
from keymark.core.errors import ConversionError, InputError
from keymark.core.progress import Progress, run
from keymark.operators.bridge.detector.detect_keypoints import Detection, detect_keypoints
from keymark.operators.bridge.detector.detector_command import parse_command
from keymark.operators.bridge.detector.detector_setting import Detector

FRAMES = 8
FAKE = Path(__file__).parents[2] / "_fake_detector.py"


def detector(how: str, time_limit_s: float = 60.0) -> Detector:
    """The fake detector as a command."""
    program = shlex.join([sys.executable, str(FAKE), how])
    command = f"{program} {{clip}} {{output}} {{width}} {{height}} {{frames}}"
    return Detector(parse_command(command, "--detector"), time_limit_s)


@pytest.fixture(autouse=True)
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for temporary ones, which must be empty in the end."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """A short clip in a folder of its own."""
    file = tmp_path / "take" / "clip.mp4"
    file.parent.mkdir()
    write_video(file, true_postures(FRAMES), seed=1)
    return file


def is_running(process: int) -> bool:
    """Whether a process is alive, and no zombie."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z"


def test_a_detector_that_works_gives_people_of_every_frame(clip: Path, temporary: Path) -> None:
    """Read, checked, in the clip's pixels; progress rises to the end; nothing is left behind."""
    steps: list[Progress] = []
    found = run(detect_keypoints(clip, detector("work"), frame_start=5), steps.append)
    assert isinstance(found, Detection) and found.frame_start == 5 and found.fps == pytest.approx(30.0)
    assert len(found.people.frames) == FRAMES and found.seen_frames == FRAMES - 1
    assert found.people.size == SIZE and found.people.source == "_fake_detector.py"
    assert found.people.frames[3].pixel[0, 0] == pytest.approx([0.3 * SIZE[0] + 3, 0.2 * SIZE[1]])
    assert np.isfinite(found.people.frames[0].pixel).all() and found.notes == ()
    fractions = [step.fraction for step in steps]
    assert fractions == sorted(fractions) and fractions[0] == 0.0 and fractions[-1] > 0.9
    assert list(temporary.iterdir()) == [] and os.listdir(clip.parent) == ["clip.mp4"]


def test_a_file_in_a_folder_of_the_programs_own_is_found(clip: Path) -> None:
    """Where a program chooses the name itself."""
    assert run(detect_keypoints(clip, detector("folder"))).seen_frames == FRAMES - 1


@pytest.mark.parametrize(
    ("how", "kind", "said"),
    [
        (
            "fail",
            ConversionError,
            "_fake_detector.py ended with exit status 3 (the network has \\x1b[31mno weights)",
        ),
        ("killed", ConversionError, "was killed by SIGKILL"),
        ("nothing", ConversionError, "ended well and wrote no keypoints"),
        ("flood", ConversionError, "was stopped: it said more than"),
        ("huge", ConversionError, "was stopped: it wrote more than 4 GiB"),
        ("overwrite", ConversionError, "the clip changed while"),
        ("garbage", InputError, "wrote what is unusable: keypoints.json: "),
        ("short", InputError, "wrote what is unusable: keypoints.json: "),
        ("turned", InputError, "size is [120, 160]"),
        ("nobody", InputError, "nobody is seen"),
        ("escape", InputError, "wrote keypoints.json as a link to"),
        ("folders", InputError, "into several folders (first"),
    ],
)
def test_a_detector_that_does_not_deliver_is_told_in_one_sentence(
    clip: Path, temporary: Path, how: str, kind: type[Exception], said: str
) -> None:
    """Whatever it does, its folder is gone afterwards."""
    with pytest.raises(kind) as caught:
        run(detect_keypoints(clip, detector(how)))
    assert said in str(caught.value) and str(caught.value).startswith(str(clip))
    assert "\n" not in str(caught.value) and list(temporary.iterdir()) == []


def test_a_detector_that_hangs_is_stopped_with_all_that_it_started(clip: Path, temporary: Path) -> None:
    """At the time limit; the sentence tells what it said last."""
    with pytest.raises(ConversionError, match=r"stopped after .* minutes.*: waiting for a model"):
        run(detect_keypoints(clip, detector("hang", time_limit_s=1.5)))
    assert not is_running(int((clip.parent / "started").read_text()))
    assert list(temporary.iterdir()) == [] and not _children_of(os.getpid())


def test_closing_the_job_ends_the_program(clip: Path, temporary: Path) -> None:
    """As Esc in Blender and Ctrl-C on the command line do."""
    with closing(detect_keypoints(clip, detector("hang"))) as job:
        for _ in job:
            if (clip.parent / "started").exists() and (clip.parent / "started").read_text():
                break
        process = int((clip.parent / "started").read_text())
        assert is_running(process)
    assert not is_running(process) and list(temporary.iterdir()) == []


def test_a_program_that_ignores_sigterm_is_killed(clip: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After its grace period."""
    monkeypatch.setattr("keymark.operators.bridge.detector.detector_process.GRACE_S", 0.2)
    with pytest.raises(ConversionError, match="stopped after"):
        run(detect_keypoints(clip, detector("stubborn", time_limit_s=1.0)))
    assert not _children_of(os.getpid())


def test_a_child_that_outlives_the_program_is_ended_too(clip: Path) -> None:
    """And does not keep the job waiting."""
    assert run(detect_keypoints(clip, detector("leave"))).seen_frames == FRAMES - 1
    child = int((clip.parent / "started").read_text())
    deadline = time.monotonic() + 10.0
    while is_running(child) and time.monotonic() < deadline:
        pass
    assert not is_running(child)


def test_what_it_writes_beside_the_clip_is_noted(clip: Path) -> None:
    """The keypoints are good all the same."""
    found = run(detect_keypoints(clip, detector("beside")))
    assert len(found.notes) == 1 and found.notes[0].startswith(f"{clip.parent / 'drawn.avi'} appeared while")


def test_what_cannot_be_started_is_told(clip: Path, tmp_path: Path) -> None:
    """A file that may be executed and is no program."""
    file = tmp_path / "broken"
    file.write_bytes(b"\x7fELF nonsense")
    file.chmod(0o755)
    with pytest.raises(InputError, match="cannot be started"):
        run(detect_keypoints(clip, Detector(parse_command(f"{file} {{clip}}", "--detector"))))


def test_the_program_runs_in_its_own_folder_without_keymarks_settings(
    clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may use every processor, and what the user has set."""
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    monkeypatch.setenv("MKL_NUM_THREADS", "6")
    told = tmp_path / "told.txt"
    script = tmp_path / "tell.py"
    script.write_text(
        "import os, sys\n"
        f"open({str(told)!r}, 'w').write('|'.join([os.getcwd(), os.environ.get('OPENBLAS_NUM_THREADS', ''), "
        "os.environ['MKL_NUM_THREADS'], sys.stdin.read()]))\n"
    )
    command = parse_command(
        shlex.join([sys.executable, str(script)]) + " {clip} {output_folder}", "--detector"
    )
    with pytest.raises(ConversionError, match="wrote no keypoints"):
        run(detect_keypoints(clip, Detector(command)))
    folder, blas, mkl, standard_input = told.read_text().split("|")
    assert folder.startswith(str(tmp_path / "temporary")) and (blas, mkl, standard_input) == ("", "6", "")


def _children_of(process: int) -> list[str]:
    """The living children of a process."""
    file = Path(f"/proc/{process}/task/{process}/children")
    return [child for child in file.read_text().split() if is_running(int(child))] if file.exists() else []
