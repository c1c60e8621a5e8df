"""Forbidden abilities of the package: network access, and running the contents of files."""

import ast
import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from _house import nodes
from _synthetic_take import write_synthetic_take

NETWORK = {"ftplib", "http", "imaplib", "nntplib", "poplib", "requests", "smtplib", "socket", "socketserver"}
NETWORK |= {"ssl", "telnetlib", "urllib", "webbrowser", "wsgiref", "xmlrpc"}
CODE_FROM_DATA = {"code", "codeop", "dbm", "dill", "joblib", "marshal", "pickle", "runpy", "shelve", "yaml"}
CODE_FROM_DATA |= {"multiprocessing"}  # its processes exchange pickles
ONLY_IN = {
    "ctypes": ("operators.cli.blender_silence", "core.files"),
    "subprocess": (
        "operators.cli.batch",  # workers: Keymark itself
        "operators.cli.commands.demo",  # Blender, which generates a rig
    ),
    "asyncio": (),
}
"""Modules with a harmless use, and the files that have it."""
HARMLESS = {"urllib.parse"}
"""Parts of a forbidden module that only parse text."""
CALLS = {"eval", "exec", "compile", "__import__"}
CALLS |= {
    "os.system",
    "os.popen",
    "np.fromregex",
    "bpy.ops.script.python_file_run",
    "bpy.ops.text.run_script",
}
CALLS |= {"bpy.ops.wm.open_mainfile", "bpy.ops.wm.url_open"}
METHODS = {"open_connection", "start_server", "create_connection", "create_subprocess_shell", "driver_add"}
METHODS |= {"as_module", "use_scripts_auto_execute"}


def dotted(node: ast.AST) -> str:
    """The dotted name of an expression, as `np.load`; empty if it is none."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        before = dotted(node.value)
        return f"{before}.{node.attr}" if before else ""
    return ""


def imported(node: ast.AST) -> list[str]:
    """Top-level names of the external modules that a statement imports."""
    names: list[str] = []
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
        names = [node.module]
    return [name.split(".")[0] for name in names if name not in HARMLESS]


def faults(module: str, source: str) -> Iterator[str]:
    """Sentences on each use in one module that could reach a network or run data."""
    for node in nodes(source):
        for name in imported(node):
            if name in NETWORK | CODE_FROM_DATA or not module.startswith(ONLY_IN.get(name, (module,))):
                yield f"{module}:{node.lineno} loads {name}"  # type: ignore[attr-defined]
        if isinstance(node, ast.Attribute) and node.attr in METHODS:
            yield f"{module}:{node.lineno} uses {node.attr}"
        if not isinstance(node, ast.Call):
            continue
        name, given = dotted(node.func), {keyword.arg: keyword.value for keyword in node.keywords}
        if name in CALLS or name.startswith(("os.exec", "os.spawn", "os.posix_spawn")):
            yield f"{module}:{node.lineno} calls {name}"
        if name in ("np.load", "numpy.load") and not _says(given.get("allow_pickle"), False):
            yield f"{module}:{node.lineno} loads arrays without allow_pickle=False"
        if "shell" in given and not _says(given["shell"], False):
            yield f"{module}:{node.lineno} starts a shell"


def _says(node: ast.AST | None, value: object) -> bool:
    return isinstance(node, ast.Constant) and node.value is value


def test_nothing_of_the_package_reaches_a_network_or_runs_data(repository: Path) -> None:
    found = []
    for folder in ("core", "operators"):
        for file in sorted((repository / folder).rglob("*.py")):
            module = ".".join(file.relative_to(repository).with_suffix("").parts)
            found += faults(module, file.read_text(encoding="utf-8"))
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        "import socket",
        "from urllib.request import urlopen",
        "def late():\n    import pickle",
        "import subprocess",
        "import asyncio",
        "eval(text)",
        "np.load(path)",
        "np.load(path, allow_pickle=True)",
        "os.execv(program, words)",
        "run(words, shell=True)",
        "loop.create_connection(where)",
        "bpy.ops.wm.open_mainfile(filepath=path)",
        "curve.driver_add('location')",
    ],
)
def test_forbidden_code_is_found(source: str) -> None:
    assert len(list(faults("core.take.take", source))) == 1


def test_allowed_code_passes() -> None:
    assert list(faults("operators.cli.batch.pool", "import subprocess")) == []
    source = "np.load(path, allow_pickle=False)\nre.compile(text)\nfrom .code import x\nimport json"
    assert list(faults("core.take.take", source)) == []


def test_the_extension_requests_file_permission_only(repository: Path) -> None:
    manifest = tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert set(manifest["permissions"]) == {"files"}
    reason = manifest["permissions"]["files"]
    assert 0 < len(reason) <= 64 and not reason.endswith(".")  # Blender's own check requires it


WATCHED = """
import importlib.util, json, os, sys
import scipy.sparse  # as numpy starts it asks the system for its processor, by a process
blender = importlib.util.find_spec("bpy") is not None
if blender:
    import bpy  # one of its libraries tries a socket as it starts, to learn which kinds there are
root, *words = sys.argv[1:]
sys.path.insert(0, os.path.join(root, "tests"))
import _boot
_boot.load_package()
from keymark.operators.cli.main import main
seen = []
FORBIDDEN = ("socket.", "subprocess.", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork",
             "urllib.", "pickle.", "http.", "ftplib.", "webbrowser.")
def watch(event, given):
    if event.startswith(FORBIDDEN):
        seen.append([event, repr(given)[:80]])
        raise RuntimeError(f"{event} is not allowed here")
    if event == "open" and not isinstance(given[0], int) and given[2] & (os.O_WRONLY | os.O_RDWR):
        seen.append(["write", os.path.realpath(os.fsdecode(given[0]))])
sys.addaudithook(watch)
status = main(words)
print(json.dumps({"status": status, "seen": seen, "blender": blender}), file=sys.stderr)
"""


def watched(repository: Path, *words: str) -> dict[str, object]:
    """Run a command where sockets and processes are forbidden; return its status, attempts and writes."""
    command = [sys.executable, "-B", "-c", WATCHED, str(repository), *words]
    done = subprocess.run(command, capture_output=True, text=True)
    answer: dict[str, object] = json.loads(done.stderr.splitlines()[-1])
    return answer


def test_a_command_opens_no_socket_and_writes_only_where_it_is_told(repository: Path, tmp_path: Path) -> None:
    take, output = write_synthetic_take(tmp_path / "take", 8), tmp_path / "out"
    said = watched(repository, "convert", str(take), "--output", str(output / "take"), "--quiet")
    if not said["blender"]:
        said = watched(repository, "propose", str(take), "--quiet")
    assert said["status"] == 0
    seen = said["seen"]
    assert isinstance(seen, list)
    written = [path for event, path in seen if event == "write" and path != os.path.realpath(os.devnull)]
    assert [event for event, _ in seen if event != "write"] == []
    assert [path for path in written if not Path(path).is_relative_to(os.path.realpath(output))] == []
    assert bool(written) == said["blender"]
