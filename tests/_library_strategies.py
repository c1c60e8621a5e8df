"""Hypothesis strategies of libraries."""

import numpy as np
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from keymark.core.prior.texts import name_key


def lines(longest: int) -> st.SearchStrategy[str]:
    """Single lines of text as a file may hold them."""
    letters = st.characters(exclude_categories=["Cc", "Cf", "Cs", "Zl", "Zp"])
    return st.text(letters, min_size=1, max_size=longest).map(str.strip).filter(bool)


NUMBERS = st.floats(-3.0, 3.0, allow_nan=False)


@st.composite
def postures(draw: st.DrawFn) -> Posture:
    """Any posture: half of its degrees of freedom, among them whole half turns."""
    values = draw(st.dictionaries(st.integers(0, 33), NUMBERS | st.just(np.pi), max_size=17))
    vector = np.zeros(34)
    vector[list(values)] = list(values.values())
    return Posture.from_vector(HUMAN, vector)


@st.composite
def libraries(draw: st.DrawFn) -> Library:
    """Any library that can be written."""
    names = draw(st.lists(lines(20), min_size=1, max_size=4, unique_by=name_key))
    tags = st.lists(lines(10), max_size=2).map(tuple)
    poses = tuple(LibraryPosture(name, draw(postures()), draw(tags)) for name in names)
    motions = tuple(
        draw(_motions(name, names)) for name in draw(st.lists(lines(9), max_size=2, unique_by=name_key))
    )
    return Library(
        identifier=draw(st.from_regex(r"[d-z0-9][d-z._-]{0,20}[a-z0-9]", fullmatch=True)),
        title=draw(lines(60)),
        version=draw(st.integers(1, 10**6)),
        author=draw(lines(30)),
        license=draw(st.sampled_from(["CC0-1.0", "CC-BY-4.0 OR MIT", "LicenseRef-Own"])),
        actor=Actor.from_stature(draw(st.floats(1.0, 2.2))),
        postures=poses,
        motions=motions,
        description=draw(st.just("") | lines(100)),
        sources=draw(st.lists(lines(50), max_size=2).map(tuple)),
        tags=draw(tags),
    )


@st.composite
def _motions(draw: st.DrawFn, name: str, known: list[str]) -> LibraryMotion:
    gaps = draw(st.lists(st.floats(1e-3, 5.0), max_size=5))
    times = np.cumsum([0.0, *gaps])
    steps = tuple(MotionStep(draw(st.sampled_from(known)), float(time_s)) for time_s in times)
    cyclic = draw(st.booleans())
    travel = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)) if cyclic else (0.0, 0.0, 0.0)
    return LibraryMotion(name, steps, float(times[-1]) + draw(st.floats(1e-3, 1.0)), cyclic, travel)
