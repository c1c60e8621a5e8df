"""What scenes and result folders hold of a take, the same in every run."""

import json
from collections.abc import Mapping
from pathlib import Path

import bpy
from _faults import tree
from keymark.core.body.posture import Posture
from keymark.core.files.digest import content_digest
from keymark.core.files.paths import real_path
from keymark.core.poses.found_poses import Candidate, MatchedFrame
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.session.result import AS_MADE
from keymark.core.take.conversion_record import read_record
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import curve_digest
from keymark.operators.bridge.armature import read_body
from keymark.operators.bridge.pose import read_posture
from keymark.operators.shell.takes import active_take

# --- Found keyframes made up from a motion, as finding gives them


def wave_library(motion: Motion, identifier: str = "waves") -> Library:
    """A library of three postures of a motion."""
    postures = tuple(LibraryPosture(f"Wave {i}", motion.posture[i]) for i in (0, 6, 12))
    return Library(identifier, identifier.title(), 1, "Somebody", "CC0-1.0", motion.body.actor, postures)


def made_up_frames(motion: Motion, confidences: Mapping[int, float]) -> tuple[MatchedFrame, ...]:
    """Frames with the motion's postures, of a confidence each, and another posture that each may show."""
    return tuple(
        MatchedFrame(
            index,
            (
                Candidate(motion.posture[index], f"Wave {index}", False, confidence),
                Candidate(motion.posture[12 - index], "Back", True, 0.25),
            ),
        )
        for index, confidence in confidences.items()
    )


def shown(take: bpy.types.PropertyGroup, frame: int) -> Posture:
    """The posture that the actor shows at a frame."""
    bpy.context.scene.frame_set(frame)
    return read_posture(take.armature, read_body(take.armature)).posture


# --- The posture that the actor of a scene's active take shows


def posture_of(scene: bpy.types.Scene) -> Posture:
    """The actor's posture."""
    armature_object = active_take(scene).armature
    return read_posture(armature_object, read_body(armature_object)).posture


# --- The content of result folders that is the same in every run


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
