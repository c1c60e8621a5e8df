"""The command of a detector: its words with placeholders, which no shell ever reads."""

import json
import os
import re
import shlex
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ....core.errors import InputError
from ....core.files.control_characters import is_control_character
from ....core.files.fields import listed
from ....core.files.json_file import shown

PLACEHOLDERS = {
    "clip": "the clip: a video, or a folder of images",
    "output": "the keypoint file to write",
    "output_folder": "a folder of the program's own, in which it runs, for those that write several files",
    "width": "of the clip's pictures [px]",
    "height": "of the clip's pictures [px]",
    "fps": "frames per second",
    "frames": "number of frames",
    "frame_start": "number of the first frame",
    "detectors": "the folder of the detectors that come with Keymark",
}
"""What may stand in braces in a word of the command, and what it becomes."""
EXAMPLE = "/path/to/python {detectors}/mediapipe_pose.py {clip} --output {output}"
FOLDER = Path(__file__).resolve().parents[3] / "detectors"
"""The detectors that come with Keymark."""
LONGEST_COMMAND = 8000
"""Characters; Windows starts no longer ones."""
SHELL_WORDS = frozenset({"|", "||", "&", "&&", ";", "<", ">", ">>", "2>", "2>&1", "&>"})
SHELL_FILES = (".bat", ".cmd")
"""Programs that Windows hands to a shell."""
_BRACES = re.compile(r"\{\{|\}\}|\{([^{}]*)\}|[{}]")


@dataclass(frozen=True)
class DetectorCommand:
    """The words of a detector's command, the program first; checked, but the program not yet looked for."""

    words: tuple[str, ...]
    origin: str
    """Where it was set, with which sentences begin: an option, a variable or the preferences."""

    @property
    def name(self) -> str:
        """What the detector is called in sentences: its script's name, or the program's."""
        program = re.split(r"[\\/]", self.words[0])[-1]
        scripts = [re.split(r"[\\/]", word)[-1] for word in self.words[1:] if word.endswith(".py")]
        return scripts[0] if scripts and program.lower().startswith("py") else program

    def call(self, values: Mapping[str, str]) -> list[str]:
        """The words of one call.

        Args:
            values: The text for each of `PLACEHOLDERS`.

        Raises:
            InputError: There is no such program, or it cannot be run.
        """
        program, *others = (_filled(word, values) for word in self.words)
        return [self._program(program), *map(_from_here, others)]

    def check_program(self) -> None:
        """Look for the program.

        Raises:
            InputError: There is no such program, or it cannot be run.
        """
        self._program(_filled(self.words[0], dict.fromkeys(PLACEHOLDERS, "") | {"detectors": str(FOLDER)}))

    def _program(self, word: str) -> str:
        """The program's file with its whole path."""
        word = os.path.expanduser(word)
        wanted = "it must be a program, or a script with its interpreter before it"
        if word.lower().endswith(SHELL_FILES) and os.name == "nt":
            raise InputError(f"{self.origin}: {shown(word)} is a batch file, which a shell runs; {wanted}")
        found = shutil.which(word)
        if found is not None:
            return os.path.abspath(found)
        if os.path.isdir(word):
            wrong = "is a folder"
        elif os.path.exists(word) and (os.sep in word or "/" in word):
            wrong = "may not be executed"
        else:
            wrong = "is nowhere to be found"
        raise InputError(f"{self.origin}: the program {shown(word)} {wrong}; {wanted}")


def parse_command(text: str, origin: str) -> DetectorCommand:
    """Read the command of a detector.

    Args:
        text: A JSON list of words, or words between spaces with quotes around those that hold spaces.
        origin: Where it was set, with which sentences begin.

    Raises:
        InputError: It is empty, too long, no list of words, lacks the clip, or has an unknown placeholder.
    """
    if not text.strip():
        raise InputError(f"{origin}: names no program; valid is a command as {EXAMPLE}")
    if len(text) > LONGEST_COMMAND:
        raise InputError(f"{origin}: has {len(text)} characters; at most {LONGEST_COMMAND} are valid")
    if any(is_control_character(character) for character in text):
        raise InputError(f"{origin}: {shown(text)} holds a control character; it must be one line of text")
    words = _listed_words(text, origin) if text.lstrip().startswith("[") else _split_words(text, origin)
    if not words or not words[0].strip():
        raise InputError(f"{origin}: names no program; valid is a command as {EXAMPLE}")
    used = {name for word in words for name in _placeholders(word, origin)}
    if "clip" not in used:
        raise InputError(f"{origin}: has no {{clip}}, for which the clip is put in; valid is {EXAMPLE}")
    return DetectorCommand(tuple(words), origin)


def _listed_words(text: str, origin: str) -> list[str]:
    valid = 'a JSON list of words, as ["program", "{clip}", "{output}"]'
    try:
        words = json.loads(text)
    except ValueError as error:
        raise InputError(f"{origin}: is no valid JSON ({error}); it must be {valid}") from error
    wrong = [word for word in words if not isinstance(word, str)]
    if wrong:
        raise InputError(f"{origin}: holds {shown(wrong[0])}, which is no text; it must be {valid}")
    if any(is_control_character(character) for word in words for character in word):
        raise InputError(f"{origin}: a word holds a control character; it must be {valid}")
    return [str(word) for word in words]


def _split_words(text: str, origin: str) -> list[str]:
    lexer = shlex.shlex(text, posix=True, punctuation_chars=False)
    lexer.whitespace_split, lexer.commenters = True, ""
    if os.name == "nt":  # it parts the folders of a path there
        lexer.escape = ""
    try:
        words = list(lexer)
    except ValueError as error:
        raise InputError(
            f"{origin}: a quote is opened and not closed; put quotes around words that hold spaces"
        ) from error
    shell = [word for word in words if word in SHELL_WORDS]
    if shell:
        raise InputError(
            f"{origin}: {shown(shell[0])} is for a shell, and none runs the command; put such steps "
            "into a script"
        )
    return words


def _placeholders(word: str, origin: str) -> list[str]:
    """The names in braces in a word."""
    names = []
    for found in _BRACES.finditer(word):
        if found[0] in ("{{", "}}"):
            continue
        if found[1] not in PLACEHOLDERS:
            raise InputError(
                f"{origin}: {shown(found[0])} in {shown(word)} is unknown; valid are "
                f"{listed([f'{{{name}}}' for name in PLACEHOLDERS], len(PLACEHOLDERS))}, and {{{{ for a "
                "brace"
            )
        names.append(found[1])
    return names


def _filled(word: str, values: Mapping[str, str]) -> str:
    """A word with its placeholders replaced once: braces in a value stay as they are."""
    return _BRACES.sub(lambda found: found[0][0] if found[1] is None else values[found[1]], word)


def _from_here(word: str) -> str:
    """A word; a path of something that is there gets its whole path, since the program runs elsewhere."""
    if word.startswith("~/"):
        return os.path.expanduser(word)
    path = Path(word)
    is_path = not path.is_absolute() and not word.startswith("-")
    if is_path and ((("/" in word or os.sep in word) and path.exists()) or (path.suffix and path.is_file())):
        return str(path.absolute())
    return word
