"""Progress lines of Open Job Description for render farms."""

import pytest
from keymark.core.progress import Progress
from keymark.operators.cli.console import Console


@pytest.mark.parametrize(
    ("quiet", "as_json", "asked", "lines"),
    [
        (False, False, "openjd", ["openjd_status: Solving", "openjd_progress: 45", "openjd_progress: 81"]),
        (True, False, "openjd", []),
        (False, True, "openjd", []),
        (False, False, "", ["Solving ..."]),
    ],
)
def test_a_line_for_each_percent_where_it_is_wanted(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    quiet: bool,
    as_json: bool,
    asked: str,
    lines: list[str],
) -> None:
    monkeypatch.setenv("KEYMARK_PROGRESS", asked)
    with Console(quiet=quiet, as_json=as_json) as console:
        for fraction in (0.5, 0.5001, 0.9, 0.3):
            console.progress(Progress("Solving", fraction))
    assert capsys.readouterr().out.splitlines() == lines
