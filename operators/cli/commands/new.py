"""`keymark new`: describe a folder of clips in a shoot.json."""

import argparse
from pathlib import Path

from ....core.errors import InputError
from ....core.files.json_file import write_readable_json
from ....core.files.paths import absolute_path
from ....core.progress import run, within
from ....core.shoot.discovery import find_takes
from ....core.shoot.template import clip_lines, evidence_lines, shoot_template, survey_clips
from ....core.take.description import SHOOT_FILE, find_shoot_files
from ..console import Console, argument, command, program_name
from ..options import output


@command(
    argument("shoot SHOOT", "folder of clips", type=Path),
    *output("FILE", "where to write; by default SHOOT/shoot.json", required=False),
)
def new_command(arguments: argparse.Namespace, console: Console) -> None:
    """Looks at the clips below a folder and writes shoot.json there.

    What the clips tell is filled in, with comments on what a person must say, once for all clips: camera,
    actor, and markers if any. It also says what each clip's motion can be held against.
    """
    folder: Path = arguments.shoot
    output: Path = arguments.output or folder / SHOOT_FILE
    if output.exists():
        raise InputError(
            f"{output}: is there already and is never replaced; move it away, or name another file with "
            "--output"
        )
    shoot = find_takes(folder, undescribed=True)
    survey = run(within("Looking at the clips", survey_clips(shoot), 0.0, 1.0), console.progress)
    if not survey.clips:
        reason = "every take in it has a take.json of its own, and no clip needs a description; run keymark "
        reason += "check to look through them"
        if survey.unreadable:
            reason = f"none of its clips can be read; the first: {survey.unreadable[0]}"
        raise InputError(f"{folder}: {reason}")
    above = [file for file in find_shoot_files(folder) if file != absolute_path(folder) / SHOOT_FILE]
    template = shoot_template(survey, bool(above))
    write_readable_json(output, template)
    todo = null_fields(template)
    summary = {
        "file": str(output),
        "clips": len(survey.clips),
        "described": list(survey.described),
        "unreadable": list(survey.unreadable),
        "evidence": {clip.name: list(clip.evidence) for clip in survey.clips},
        "fill_in": todo,
    }
    camera = "and correct the lens, which is a guess; the" if survey.any_posed else "The"
    lines = [*clip_lines(survey), *evidence_lines(survey), "", f"{output} describes them. Now fill in"]
    lines += [f"  {field_path}" for field_path in todo]
    lines += [f"{camera} comment beside each field says how.", f"Then run: {program_name()} check {folder}"]
    console.finish(summary, "\n".join(lines))


def null_fields(template: object, path: str = "") -> list[str]:
    """Paths of the fields that are null and must be filled in, as `camera.lens_mm`."""
    if template is None:
        return [path]
    if not isinstance(template, dict):
        return []
    found = []
    for name, value in template.items():
        found += null_fields(value, f"{path}.{name}" if path else name)
    return found
