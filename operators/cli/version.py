"""Which Keymark this is, as its manifest alone says."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def version() -> str:
    """The version, which stands in the extension's manifest alone."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    return str(manifest["version"])
