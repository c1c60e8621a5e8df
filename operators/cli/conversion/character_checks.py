"""The characters of a shoot, each looked at once, before takes are checked in threads without Blender."""

import importlib.util
from collections.abc import Sequence
from contextlib import suppress

from ....core.errors import InputError, KeymarkError, describe_unexpected
from ....core.files.regular_file import regular_file_size
from ....core.retarget.maps.choose_map import map_digests
from ....core.shoot.shoot import Shoot
from ....core.take.character_settings import CharacterFile, CharacterSettings
from ..library_search_path import library_folders
from .character_result import opened_character

Wanted = tuple[CharacterFile, str]


class CharacterChecks:
    """What is wrong with characters, and what is doubtful about them."""

    def __init__(self, shoot: Shoot, debug: bool) -> None:
        """Look at all characters that the takes of a shoot name."""
        self._debug = debug
        self._findings: dict[Wanted, tuple[KeymarkError | None, Sequence[str]]] = {}
        for take in shoot.takes:
            with suppress(KeymarkError):  # its own check says so
                settings = take.describe().settings.character
                if settings is not None:
                    self._look_at(settings)

    def check(self, settings: CharacterSettings) -> Sequence[str]:
        """What is doubtful about a character.

        Raises:
            InputError: It cannot be used, or its map is not for it.
        """
        error, doubts = self._findings[settings.file, settings.map]
        if error is not None:
            raise error
        return doubts

    def _look_at(self, settings: CharacterSettings) -> None:
        wanted = (settings.file, settings.map)
        if wanted in self._findings:
            return
        try:
            self._findings[wanted] = None, self._doubts(settings)
        except KeymarkError as error:
            self._findings[wanted] = error, ()
        except Exception as error:
            if self._debug:
                raise
            what = describe_unexpected(error)
            sentence = f"{settings.file.path}: the check failed unexpectedly ({what}); --debug shows where"
            self._findings[wanted] = InputError(sentence), ()

    def _doubts(self, settings: CharacterSettings) -> Sequence[str]:
        file = settings.file.path
        if importlib.util.find_spec("bpy") is None:
            regular_file_size(file, "a character file")
            map_digests(settings.map, library_folders())
            return (f"{file}: the character is not looked at, which needs Blender",)
        with opened_character(settings.file, settings.map, self._debug) as (_, opened):
            doubts = (*opened.imported.notes, *opened.chosen.doubts)
        return tuple(doubt if str(file) in doubt else f"{file}: {doubt}" for doubt in doubts)
