"""The result of a conversion: its files, their record, and what a person has changed in them since."""

import os
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..estimate.notes import of_true_causes
from ..estimate.reconstruct import Reconstruction
from ..files.digest import content_digest
from ..files.json_file import read_json, write_json
from ..files.output_folder import backup_name
from ..poses.found_poses import FoundPoses, contradiction_notes
from ..prior.library import library_digest
from ..progress import run
from ..retarget.retarget_record import RECORD_FILE as RETARGET
from ..retarget.retarget_record import RetargetRecord
from ..review.frame_evidence import used_evidence
from ..review.review import review
from ..take.conversion_record import (
    BLEND,
    BVH,
    CHARACTER_BLEND,
    CHARACTER_PICTURE,
    EARLIER_PICTURES,
    MOTION,
    PICTURES,
    REPORT,
    ConversionRecord,
    find_record,
    write_record,
)
from ..take.conversion_record import RECORD_FILE as RECORD
from ..take.conversion_settings import ConversionSettings
from ..take.description import KEYFRAME_FILE, Description
from ..take.keyframe_file import write_keyframes
from ..take.motion import write_motion
from ..take.take import Take
from ..take.take_file import write_take
from .described import findings
from .session import Posed, Session, Sight

AS_MADE = ".as_made.json"
"""SHA-256 of files as they were made: of those whose bytes differ from run to run though their content does
not, so that the record itself is always the same."""
RESULT_FILES = (
    *(RECORD, MOTION, BLEND, BVH, CHARACTER_BLEND, RETARGET, CHARACTER_PICTURE),
    *(f"{REPORT}/{name}" for name in (*PICTURES, *EARLIER_PICTURES)),
)
"""Every file that a conversion may make, but for the keyframes: a person may have corrected these meanwhile,
so that only a conversion that makes them anew may replace them."""
EDITABLE_FILES = (BLEND, CHARACTER_BLEND, KEYFRAME_FILE)
"""Files that people go on working in; one that no record vouches for is taken to be theirs."""


@dataclass(frozen=True, eq=False)
class Conversion:
    """The result of a conversion."""

    session: Session
    files: tuple[Path, ...]
    """In the order of `RESULT_FILES`, then keyframes and record."""
    conversion_notes: tuple[str, ...] = ()
    """What was found where nobody said it, and sentences on unused keyframes and on files that are kept."""

    @property
    def take(self) -> Take:
        """With all its keyframes."""
        return self.session[Posed].seen.take

    @property
    def reconstruction(self) -> Reconstruction:
        """The motion."""
        return self.session[Reconstruction]

    @property
    def found(self) -> FoundPoses | None:
        """What was found of keyframes, if that was wanted, and how well it fits."""
        return self.session[Posed].found

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is not right on the character by its own figures."""
        record = self.session.made.get("retarget")
        return record.warnings if isinstance(record, RetargetRecord) else ()

    @property
    def notes(self) -> tuple[str, ...]:
        """Everything a person should know of the result, one sentence each."""
        about: tuple[str, ...] = ()
        if self.found is not None:
            about = (self.found.reason.rstrip("."), *contradiction_notes(self.take, self.found))
        return of_true_causes((*self.conversion_notes, *about, *self.reconstruction.notes))


def conversion_record(
    conversion: Conversion,
    version: str,
    digest: str,
    folder: Path,
    names: Sequence[str],
    stable_digests: Mapping[str, str],
) -> ConversionRecord:
    """The record of a conversion."""
    libraries = conversion.session.inputs.libraries or ()
    take, motion = conversion.take, conversion.reconstruction.motion
    frames = np.arange(len(motion.time_s), dtype=np.float64) + motion.frame_start
    reviewed = run(review(take, conversion.reconstruction, frames))
    confidence = reviewed.confidence[np.isfinite(reviewed.confidence)]
    found = {keyframe.index: keyframe.matched for keyframe in take.keyframes if keyframe.matched is not None}
    return ConversionRecord(
        digest=digest,
        keymark=version,
        take=take.name,
        method=motion.method,
        library=None if conversion.found is None else conversion.found.library,
        frames=len(motion.time_s),
        frame_start=motion.frame_start,
        fps=motion.fps,
        keyframes=tuple(index + motion.frame_start for index in motion.keyframe_indices),
        matched=tuple(i + motion.frame_start for i in motion.keyframe_indices if i in found),
        confidence=round(float(confidence.mean()), 4) if len(confidence) else None,
        weakest=round(float(np.percentile(confidence, 5.0)), 4) if len(confidence) else None,
        weak_frames=tuple(frame.index + motion.frame_start for frame in reviewed.weak_frames),
        notes=conversion.notes,
        warnings=conversion.warnings,
        files={name: stable_digests.get(name) or content_digest(folder / name) for name in names},
        evidence=used_evidence(conversion.reconstruction),
        libraries={each.identifier: library_digest(each) for each in libraries},
        doubtful=tuple(
            index + motion.frame_start for index, said in sorted(found.items()) if said.is_doubtful
        ),
    )


def refuse_own_folder(description: Description, output: Path) -> None:
    """Refuse the take's own folder for a result with found keyframes."""
    if os.path.realpath(description.folder) == os.path.realpath(output):
        raise InputError(
            f"{output}: is the take's own folder, whose {KEYFRAME_FILE} the found keyframes would replace; "
            "name another folder"
        )


def write_motion_files(folder: Path, session: Session) -> None:
    """Write the motion, and the keyframes where some were found."""
    take = session[Posed].seen.take
    write_motion(session[Reconstruction].motion, folder / MOTION)
    if session[Posed].found is not None:
        write_keyframes(folder / KEYFRAME_FILE, take.keyframes, take.body, take.frame_start)


def own_files(description: Description, output: Path) -> tuple[str, ...]:
    """Names of all files that a conversion into a folder may make or remove.

    Those that make it a take are among them where an earlier conversion has made them, but for this take.
    """
    record = find_record(output)
    is_itself = os.path.realpath(description.folder) == os.path.realpath(output)
    made = () if record is None or is_itself else set(record.files) - {KEYFRAME_FILE}
    return tuple(dict.fromkeys((*RESULT_FILES, AS_MADE, *sorted(made))))


def write_take_files(
    folder: Path, session: Session, description: Description, evidence: Sequence[str] | None
) -> None:
    """Write what makes the folder of a result a take: the camera and the actor as found, and the clip.

    The clip is another name of the same file, where the disk has such names, and a copy elsewhere. Keypoints
    are as the clip shows them: the motion's are those that a steady camera would see.
    """
    take = replace(session[Posed].seen.take, keypoints=session[Sight].people)
    clip = folder / take.clip.name
    if take.clip.is_file():
        with suppress(OSError):
            os.link(take.clip, clip)
    take = replace(take, clip=clip) if clip.exists() else take
    floor_m = session[Posed].floor_m or 0.0
    fields: dict[str, object] = {"//found": list(findings(session, description)), "floor_m": floor_m}
    fields |= {} if session.inputs.shot is None else {"shot": list(session.inputs.shot)}
    fields |= {} if session.inputs.performer is None else {"performer": session.inputs.performer}
    fields |= {} if session.inputs.hands else {"hands": False}
    write_take(take, folder, evidence, fields)


def finish_result(
    session: Session,
    notes: Sequence[str],
    input_of: tuple[Description, ConversionSettings, str],
    version: str,
    folders: tuple[Path, Path],
    curves: Mapping[str, str],
    kept_names: dict[str, str],
) -> Conversion:
    """Write the record of a result whose other files are complete.

    Args:
        session: The motion and all it was made from.
        notes: Sentences on the character.
        input_of: The description, the settings and the digest of the input.
        version: Keymark's.
        folders: The staging folder, and that of the result.
        curves: Digests of what stays the same in files whose bytes differ from run to run.
        kept_names: Receives the names under which files that a person has changed are kept.
    """
    (description, settings, digest), (staging_folder, output) = input_of, folders
    others = sorted(file.name for file in staging_folder.iterdir() if file.is_file() and file.name != AS_MADE)
    replaced = tuple(dict.fromkeys((*RESULT_FILES, KEYFRAME_FILE, *others)))
    written = [name for name in replaced if (staging_folder / name).is_file()]
    record = find_record(output)
    recorded = {} if record is None else record.files
    kept_names.update(changed_files(output, staging_folder, replaced, EDITABLE_FILES, recorded))
    own = description.keyframes
    unused: tuple[str, ...] = ()
    if settings.library is not None and settings.keyframes is None and os.path.exists(own):
        unused = (f"{own} is left aside; --keyframes {own} --library {settings.library} would use it too",)
    conversion = Conversion(
        session,
        files=tuple(output / name for name in (*written, RECORD)),
        conversion_notes=(
            *findings(session, description),
            *unused,
            *notes,
            *(kept_note(*names) for names in kept_names.items()),
        ),
    )
    new = conversion_record(conversion, version, digest, staging_folder, written, curves)
    write_record(staging_folder, new)
    return conversion


def changed_files(
    output: Path,
    staging_folder: Path,
    names: Iterable[str],
    editable: Collection[str],
    recorded: Mapping[str, str],
) -> dict[str, str]:
    """Files of a result that are no longer as they were made, though new ones are about to replace them.

    Args:
        output: Folder of the result.
        staging_folder: Folder of the new files.
        names: Files that the new result replaces or removes, as paths in the folder. Of those in `editable`
            only the ones that are made anew are replaced.
        editable: Files that belong to a person where no record says that a conversion has made them.
        recorded: Digests of the files that the folder's record lists; empty where there is none.

    Returns:
        The names under which these files are to be kept, by their present names.
    """
    try:
        made = {**recorded, **read_json(output / AS_MADE, 2**16)} if recorded else {}
    except InputError:
        made = {}
    kept = {}
    for name in names:
        old, new = output / name, staging_folder / name
        replaced = new.is_file() or (name in made and name not in editable)
        if (
            name in (RECORD, RETARGET)
            or not replaced
            or not old.is_file()
            or not (name in made or name in editable)
        ):
            continue
        digest = content_digest(old)
        if digest != made.get(name) and not (new.is_file() and content_digest(new) == digest):
            kept[name] = backup_name(old).relative_to(output).as_posix()
    return kept


def write_made_digests(staging_folder: Path, names: Iterable[str]) -> None:
    """Write `AS_MADE`, by which a later conversion notices changes."""
    write_json(staging_folder / AS_MADE, {name: content_digest(staging_folder / name) for name in names})


def kept_note(name: str, other: str) -> str:
    """The note on a file that is kept under another name."""
    return f"{name} is not as Keymark had made it here and is kept as {other}"
