"""The rules of the house that no tool checks by itself: who may import whom, file sizes, one version."""

import re
import tomllib
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from _house import imports, modules

BLENDER_MODULES = {"bpy", "bpy_extras", "bl_math", "blf", "bmesh", "gpu", "gpu_extras", "mathutils"}
LINES_AT_MOST = 400

# The rooms of docs/architecture.md, the lowest first: imports run from a line to those above it alone, and
# rooms in one line do not know each other.
ROOMS = (
    ("core.arrays",),
    ("core.numerics",),
    ("core.errors",),
    ("core.progress", "core.files"),
    ("core.body",),
    ("core.video",),
    ("core.camera",),
    ("core.detect", "core.markers"),
    ("core.terms",),
    ("core.prior",),
    ("core.take",),
    ("core.estimate",),
    ("core.poses",),
    ("core.feet",),
    ("core.keys",),
    ("core.mend", "core.review"),
    ("core.retarget",),
    ("core.session",),
    ("core.api",),
    ("core.shoot",),
    ("core.report",),
    ("operators.bridge",),
    ("operators.shell",),
    ("operators.footage",),
    ("operators.follow",),
    ("operators.overlays",),
    ("operators.actor", "operators.library"),
    ("operators.keyframes", "operators.review"),
    ("operators.reconstruct",),
    ("operators.finish",),
    ("operators.character",),
    ("operators.takes", "operators.animate", "operators.cli"),
)
HEIGHTS = {room: height for height, rooms in enumerate(ROOMS) for room in rooms}


def room_of(name: str) -> str | None:
    """The room a module belongs to; None for the tops of core and operators, and outside the house."""
    parts = name.split(".")
    return ".".join(parts[:2]) if parts[0] in ("core", "operators") and len(parts) > 1 else None


def wrong_imports(name: str, is_package: bool, source: str, known: set[str]) -> list[str]:
    """What in one module breaks the rules, as sentences."""
    own = room_of(name)
    found = []
    for line, target in imports(name, is_package, source, known):
        room = room_of(target)
        if name.startswith("core") and target.split(".")[0] in BLENDER_MODULES:
            found.append(f"{name}:{line} imports {target}, but core knows nothing of Blender")
        elif name.startswith("core") and target.split(".")[0] == "operators":
            found.append(f"{name}:{line} imports {target}, but core knows nothing of the operators")
        elif target.split(".")[0] == "keymark" or target.startswith("(beyond the root)"):
            found.append(f"{name}:{line} imports {target}; inside the package imports are relative")
        elif room in HEIGHTS and own in HEIGHTS and room != own and HEIGHTS[room] >= HEIGHTS[own]:
            found.append(f"{name}:{line} imports {target}, which is no room below {own}")
    return found


def test_imports_run_in_one_direction_and_core_knows_no_blender(repository: Path) -> None:
    known = modules(repository, "core", "operators")
    assert "core.errors" in known
    wrong = []
    for name, file in known.items():
        wrong += wrong_imports(name, file.name == "__init__.py", file.read_text(encoding="utf-8"), set(known))
    assert wrong == []


def room_graph(sources: dict[str, tuple[bool, str]]) -> dict[str, set[str]]:
    """The rooms each room imports from; `sources` are (is package, source) by module name."""
    graph: dict[str, set[str]] = {}
    for name, (is_package, source) in sources.items():
        rooms = {room_of(target) for _, target in imports(name, is_package, source, set(sources))}
        own = room_of(name)
        if own:
            graph.setdefault(own, set()).update(room for room in rooms if room and room != own)
    return graph


def import_graph(sources: dict[str, tuple[bool, str]]) -> dict[str, set[str]]:
    """The modules each module imports, anywhere in it; `sources` are (is package, source) by module name."""
    return {
        name: {target for _, target in imports(name, is_package, source, set(sources)) if target in sources}
        for name, (is_package, source) in sources.items()
    }


def test_no_modules_import_each_other_in_a_circle(repository: Path) -> None:
    known = modules(repository, "core", "operators")
    sources = {
        name: (file.name == "__init__.py", file.read_text(encoding="utf-8")) for name, file in known.items()
    }
    order = list(TopologicalSorter(import_graph(sources)).static_order())
    assert (
        order.index("core.errors")
        < order.index("core.take.take")
        < order.index("operators.cli.commands.convert")
    )


def test_a_circle_is_found() -> None:
    sources = {
        "core.review.score": (False, "from ..take.motion import x"),
        "core.take.motion": (False, "def late():\n    from ..review import score"),
    }
    with pytest.raises(CycleError):
        list(TopologicalSorter(import_graph(sources)).static_order())


def test_every_room_has_a_height(repository: Path) -> None:
    rooms = {room_of(name) for name in modules(repository, "core", "operators")} - {None}
    assert rooms == set(HEIGHTS)


def test_the_rooms_themselves_form_no_circle(repository: Path) -> None:
    known = modules(repository, "core", "operators")
    for top in ("core", "operators"):
        assert not list(relative_imports(known[top], top, set(known)))


def relative_imports(file: Path, name: str, known: set[str]) -> Iterator[str]:
    """What a package's own file imports of the house."""
    for _, target in imports(name, True, file.read_text(encoding="utf-8"), known):
        if target.split(".")[0] in ("core", "operators"):
            yield target


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("core.body.skeleton", "import bpy"),
        ("core.body.skeleton", "def late():\n    from mathutils import Matrix"),
        ("core.body.skeleton", "from ...operators import bridge"),
        ("core.review.score", "from ...operators import bridge"),
        ("core.body.skeleton", "from ..camera import camera"),
        ("core.video.clip", "from ..take.take import Take"),
        ("core.errors", "from .body import skeleton"),
        ("core.estimate.kalman", "from ..review.score import score"),
        ("core.estimate.reconstruct", "from ..report import pictures"),
        ("core.estimate.reconstruct", "from keymark.core import errors"),
        ("core.take.take", "from ..shoot.shoot import Shoot"),
        ("operators.bridge.fcurves", "from ..cli.convert import run"),
        ("operators.shell.takes", "from ..footage.take_footage import update_clip_state"),
        ("operators.review.panel", "def late():\n    from ..keyframes import fit_pose"),
        ("operators.cli.convert", "from .....elsewhere import run"),
    ],
)
def test_a_wrong_import_is_found(name: str, source: str) -> None:
    known = {"core.report", "core.body.skeleton", "core.camera.camera", "operators.bridge", "core.errors"}
    assert len(wrong_imports(name, False, source, known)) == 1


@pytest.mark.parametrize(
    ("name", "source"),
    [
        (
            "core.body.skeleton",
            "import numpy as np\nfrom . import rotations\nfrom ..errors import InputError",
        ),
        ("core.terms.regions", "from ..body.kinematics import Body\nfrom ..camera import camera"),
        ("core.estimate.reconstruct", "from ..take.take import Take\nfrom . import kalman"),
        ("operators.bridge.fcurves", "import bpy\nfrom ...core.body import skeleton"),
        (
            "operators.cli.convert",
            "import bpy\nfrom ..bridge import fcurves\nfrom ...core.take import motion",
        ),
    ],
)
def test_a_right_import_passes(name: str, source: str) -> None:
    known = {"core.camera.camera", "core.body.skeleton", "core.body.rotations", "core.take.motion"}
    assert wrong_imports(name, False, source, known) == []


def test_no_file_is_longer_than_four_hundred_lines(repository: Path) -> None:
    files = modules(repository, "core", "operators", "tests", "benchmarks", "tools").values()
    long = {str(file): len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    assert {file: lines for file, lines in long.items() if lines > LINES_AT_MOST} == {}


def test_every_folder_of_the_package_is_a_package(repository: Path) -> None:
    folders = {file.parent for file in modules(repository, "core", "operators").values()}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").is_file()] == []


def test_nothing_below_tests_is_a_package(repository: Path) -> None:
    assert list((repository / "tests").rglob("__init__.py")) == []


def test_manifest_and_pyproject_agree(repository: Path) -> None:
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    settings = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))
    project = settings["project"]
    assert project["name"] == manifest["id"] == "keymark"
    assert "version" in project["dynamic"] and "version" not in project
    assert manifest["license"] == ["SPDX:" + project["license"]]
    oldest = ".".join(manifest["blender_version_min"].split(".")[:2])
    assert any(pin.startswith(f"bpy=={oldest}.") for pin in project["optional-dependencies"]["blender"])


def test_the_changelog_has_the_version(repository: Path) -> None:
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    changelog = (repository / "CHANGELOG.md").read_text(encoding="utf-8")
    assert manifest["version"] in re.findall(r"^## \[([^\]]+)\]", changelog, flags=re.MULTILINE)


def test_the_citation_has_the_version(repository: Path) -> None:
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    citation = (repository / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.*)$", citation, flags=re.MULTILINE) == [manifest["version"]]


def test_every_tool_a_target_calls_is_there(repository: Path) -> None:
    scripts = "".join((repository / name).read_text(encoding="utf-8") for name in ("Makefile", ".ci/run"))
    named = set(re.findall(r"tools/\w+\.(?:py|sh)", scripts))
    assert named
    assert [name for name in sorted(named) if not (repository / name).is_file()] == []
