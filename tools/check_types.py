"""Run mypy over the package as `keymark`, independently of the name of its folder.

mypy derives module names from folders, and a clone's folder may have any name. So it checks a folder of
links called `keymark`, and its findings are printed with the paths of the tree.
"""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINKS = ROOT / ".cache" / "types"
ROOMS = ("__init__.py", "core", "operators")


def link_package() -> None:
    """Fill LINKS/keymark with links to the package's folders and files."""
    package = LINKS / "keymark"
    package.mkdir(parents=True, exist_ok=True)
    for name in ROOMS:
        link = package / name
        if link.is_symlink() and not link.exists():
            link.unlink()
        if (ROOT / name).exists() and not link.is_symlink():
            link.symlink_to(os.path.relpath(ROOT / name, package))


def main(arguments: list[str]) -> int:
    """Check the package; return mypy's exit status."""
    link_package()
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", "pyproject.toml", *arguments, "-p", "keymark"],
        cwd=ROOT,
        env={**os.environ, "MYPYPATH": str(LINKS)},
        capture_output=True,
        text=True,
    )
    sys.stdout.write(done.stdout.replace(".cache/types/keymark/", ""))
    sys.stderr.write(done.stderr)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
