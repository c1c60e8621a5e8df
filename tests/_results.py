"""The content of result folders that is the same in every run."""

import json
from pathlib import Path

import bpy
from _faults import tree
from keymark.core.files.digest import content_digest
from keymark.core.files.paths import real_path
from keymark.core.session.result import AS_MADE
from keymark.core.take.conversion_record import read_record
from keymark.operators.bridge.actions import curve_digest

VARYING = ("motion.blend", "character.blend", AS_MADE)
"""Blender writes memory addresses into its files; the record has the digest of their curves."""


def same_in_every_run(folder: Path) -> dict[str, bytes | None]:
    """All files below a folder but .blend files and their digests."""
    return {name: content for name, content in tree(folder).items() if not name.endswith(VARYING)}


def is_whole(folder: Path) -> bool:
    """Whether a folder counts as finished; then every file must match its record."""
    if not (folder / "conversion.json").exists():
        return False
    record = read_record(folder)
    for name, digest in record.files.items():
        if name not in VARYING:
            assert content_digest(folder / name) == digest, f"{name} is not the one of its record"
    as_made = json.loads((folder / AS_MADE).read_text(encoding="utf-8"))
    for name, digest in as_made.items():
        assert content_digest(folder / name) == digest
    assert "motion.blend" in as_made
    return True


def blend_is_of(folder: Path) -> bool:
    """Whether the curves in motion.blend are those of the record."""
    before = set(bpy.data.user_map())
    with bpy.data.libraries.load(str(real_path(folder / "motion.blend"))) as (found, wanted):
        wanted.objects = found.objects
    digests = {curve_digest(thing) for thing in wanted.objects if thing.type == "ARMATURE"}
    bpy.data.batch_remove(set(bpy.data.user_map()) - before)
    return digests == {read_record(folder).files["motion.blend"]}


def finished_folders(folder: Path) -> list[Path]:
    """Folders of results below a folder; what stands in hidden ones is not finished."""
    records = (record.relative_to(folder) for record in folder.rglob("conversion.json"))
    return [
        folder / record.parent
        for record in records
        if not any(part.startswith(".keymark") for part in record.parts)
    ]


def hidden_files(folder: Path) -> list[str]:
    """The hidden files that killed processes have left."""
    return [name for name in tree(folder) if Path(name).name.startswith(".keymark-")]
