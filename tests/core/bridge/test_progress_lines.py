"""Progress read from the lines of programs that nobody here wrote."""

import pytest
from keymark.operators.bridge.detector.progress_lines import ProgressLines


@pytest.mark.parametrize(
    ("said", "fraction"),
    [
        ("frame 30/120", 0.25),
        ("Processed 60 of 120 frames", 0.5),
        (" 25%|###       | 30/120 [00:01<00:03, 30.1it/s]", 0.25),
        ("loading 100%\rframe 12/120", 0.1),
        ("frame 12/120\nwriting part 3/4\n99 %", 0.1),  # frames outweigh all else
        ("Frame 30", 0.25),
        ("frame 30 of 200 was bad", 0.15),  # of another count: a part like any other
        ("frame 999", 0.0),
        ("epoch 1/2", 0.5),
        ("40.5 % done", 0.405),
        ("saved /data/12/240/out.png", 0.0),
        ("2026/11/22 12:30:11", 0.0),
        ("confidence 250%", 0.0),
        ("0/0", 0.0),
        ("", 0.0),
    ],
)
def test_the_share_that_is_done(said: str, fraction: float) -> None:
    """Frames of the clip, percentages, parts; paths, dates and nonsense are no progress."""
    assert ProgressLines(120).read(said) == pytest.approx(fraction)
