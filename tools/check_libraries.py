"""List the Debian packages with the shared libraries that the bpy wheel needs and this machine lacks.

Usage: check_libraries.py [--packages]. The exit status is 1 if any is missing; `--packages` prints only the
packages' names, for apt-get.
"""

import ctypes
import sys

PACKAGE_OF = {
    "libGL.so.1": "libgl1",
    "libICE.so.6": "libice6",
    "libSM.so.6": "libsm6",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libXrender.so.1": "libxrender1",
    "libxkbcommon.so.0": "libxkbcommon0",
}


def is_missing(library: str) -> bool:
    """Whether the dynamic linker fails to find `library`."""
    try:
        ctypes.CDLL(library)
    except OSError:
        return True
    return False


def main(arguments: list[str]) -> int:
    """Check, report, and return the exit status."""
    if not sys.platform.startswith("linux"):
        return 0
    missing = {library: package for library, package in PACKAGE_OF.items() if is_missing(library)}
    if not missing:
        return 0
    packages = " ".join(sorted(missing.values()))
    if arguments == ["--packages"]:
        print(packages)
    else:
        print(
            f"Blender as a Python module needs {', '.join(missing)}, which this machine lacks: "
            f"on Debian, apt-get install {packages}",
            file=sys.stderr,
        )
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
