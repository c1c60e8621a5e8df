"""A real Blender, driven from outside: BLENDER names the binary; all it writes goes to temporary folders."""

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from installed_blender import Blender

PLATFORM = {"Linux": "linux-x64", "Windows": "windows-x64", "Darwin": "macos-arm64"}[platform.system()]
SCREEN = ["xvfb-run", "-a", "-s", "-screen 0 1920x1080x24 +extension GLX"]


@pytest.fixture(scope="session")
def blender_binary() -> Path:
    """The program that BLENDER names; skips where it names none."""
    name = os.environ.get("BLENDER")
    if not name:
        pytest.skip("BLENDER names no Blender to test with")
    found = shutil.which(name)
    if found is None:
        pytest.fail(f"BLENDER={name} is no program")
    return Path(found).absolute()


@pytest.fixture(scope="session")
def python_of_blender(blender_binary: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The version of Blender's own Python, as `3.13`, by which a zip is chosen."""
    script = "import sys; print('ANSWER', '%d.%d' % sys.version_info[:2])"
    asked = Blender((str(blender_binary),), tmp_path_factory.mktemp("asked"))
    done = asked.run("-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", script)
    (answer,) = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    return answer.split(" ")[1]


@pytest.fixture(scope="session")
def built_package(repository: Path) -> Callable[[str], Path]:
    """Builds the zip of the extension for this machine and a Python, from the tree as it stands."""

    def build(python: str) -> Path:
        words = ["--platform", PLATFORM, "--python", python]
        builder = [sys.executable, str(repository / "tools" / "build_package.py"), *words]
        done = subprocess.run(builder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return Path(done.stdout.strip())

    return build


@pytest.fixture(scope="session")
def package(built_package: Callable[[str], Path], python_of_blender: str) -> Path:
    """The zip for this machine and this Blender."""
    return built_package(python_of_blender)


@pytest.fixture
def bare_blender(blender_binary: Path, tmp_path: Path) -> Blender:
    """A Blender as a new user has it."""
    return Blender((str(blender_binary),), tmp_path / "user")


@pytest.fixture(scope="session")
def blender(blender_binary: Path, package: Path, tmp_path_factory: pytest.TempPathFactory) -> Blender:
    """A Blender with the extension installed from its zip and enabled."""
    installed = Blender((str(blender_binary),), tmp_path_factory.mktemp("user"))
    done = installed.install(package)
    assert done.returncode == 0, done.stdout + done.stderr
    return installed


@pytest.fixture(scope="session")
def blender_on_screen(blender: Blender) -> Blender:
    """The same with a virtual screen, for what only a window shows; skips where there is none."""
    beside = Path(blender.command[0]).with_name("blender-screen")
    if beside.is_file():
        return Blender((str(beside),), blender.user)
    if shutil.which(SCREEN[0]) is None:
        pytest.skip("no xvfb-run for a virtual screen")
    return Blender((*SCREEN, *blender.command), blender.user)


@pytest.fixture(scope="session")
def demo_take(repository: Path) -> Path:
    """The demonstration take that comes with the extension."""
    take = repository / "presets" / "demo" / "aerobic"
    assert (take / "take.json").is_file(), f"{take} is no take"
    return take
