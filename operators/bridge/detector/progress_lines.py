"""Progress of a program, read from its own lines: percentages, or frames of all."""

import re

_PERCENT = re.compile(r"(?<![\d.])(\d{1,3}(?:\.\d+)?)\s?%")
_OF_ALL = re.compile(r"(?<![\d.:/])(\d{1,9})\s*(?:/|\bof\b|\bout of\b)\s*(\d{1,9})(?![\d.:/])")
_FRAME = re.compile(r"\bframe\s+#?(\d{1,9})\b(?!\s*(?:/|of\b))", re.IGNORECASE)


class ProgressLines:
    """Follows the lines of a program; a count of the clip's own frames outweighs everything else."""

    def __init__(self, frame_count: int) -> None:
        self._frame_count = frame_count
        self._counts_frames = False
        self.fraction = 0.0
        """Completed share, 0 to 1."""

    def read(self, text: str) -> float:
        """Read more of what the program says; returns the share that is done."""
        for line in re.split(r"[\r\n]+", text):
            self._read_line(line)
        return self.fraction

    def _read_line(self, line: str) -> None:
        for found in _OF_ALL.finditer(line):
            done, of_all = int(found[1]), int(found[2])
            if abs(of_all - self._frame_count) <= 1 and done <= of_all:
                self._counts_frames = True
                self.fraction = done / of_all
                return
        alone = _FRAME.search(line)
        if alone and int(alone[1]) <= self._frame_count:
            self._counts_frames = True
            self.fraction = int(alone[1]) / self._frame_count
        if self._counts_frames:
            return
        percent = _PERCENT.search(line)
        if percent and float(percent[1]) <= 100.0:
            self.fraction = float(percent[1]) / 100.0
            return
        part = _OF_ALL.search(line)
        if part and 0 < int(part[2]) >= int(part[1]):
            self.fraction = int(part[1]) / int(part[2])
