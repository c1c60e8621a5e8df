"""From valid files outwards: JSON values and bytes, changed as mistakes, accidents and malice change them."""

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from typing import Any

import numpy as np
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from keymark.core.prior.texts import name_key

FUZZ = int(os.environ.get("KEYMARK_FUZZ", "1"))
"""How many times the usual number of examples is tried: `KEYMARK_FUZZ=100 make test-faults` for a night."""

Way = tuple[Any, ...]

NUMBERS = st.one_of(
    st.integers(-3, 300),
    st.integers(-(10**20), 10**20),
    st.floats(allow_nan=True, allow_infinity=True),
    st.sampled_from(
        [-0.0, 5e-324, 1e-300, 1e-9, 0.999999, 1.5, 1e6, 1e15, 1e16, 1e300, -1e308, 10**14, 10**400]
    ),
    st.just(2**53 + 1),
)
TEXTS = st.one_of(
    st.text(max_size=20),
    st.sampled_from(["", " ", "\t", "a\nb", "\x00", "\x1b[31m", "\u202eevil", "\u200d", "\ud800", "\ufeff"]),
    st.sampled_from(["x" * 300, "y" * 5000, "\u00e9", "e\u0301", "\U0001f3ac", "\u3000"]),
    st.sampled_from(r"con auto .. ../up /etc/passwd C:\x \\host\x a/../../b http://x/y %d ~".split()),
    st.sampled_from("NaN 1 true null nul.json -i".split()),
)
STRANGE = st.one_of(
    st.none(),
    st.booleans(),
    NUMBERS,
    TEXTS,
    st.just([]),
    st.just({}),
    st.lists(NUMBERS, max_size=5),
    st.dictionaries(TEXTS, NUMBERS, max_size=3),
)


def places(value: Any, way: Way = ()) -> Iterator[Way]:
    """The ways to every value within a JSON value; of a long list to its first and last few."""
    yield way
    if isinstance(value, dict):
        for name in value:
            yield from places(value[name], (*way, name))
    elif isinstance(value, list):
        for index in sorted({*range(min(3, len(value))), *range(max(0, len(value) - 2), len(value))}):
            yield from places(value[index], (*way, index))


@st.composite
def changed(draw: st.DrawFn, valid: Any, most: int = 3) -> Any:
    """A valid value, changed in a few places."""
    value = deepcopy(valid)
    for _ in range(draw(st.integers(1, most))):
        ways = [way for way in places(value) if way]
        if not ways:
            break
        *way, last = draw(st.sampled_from(ways))
        holder = value
        for key in way:
            holder = holder[key]
        _change(draw, holder, last)
    return value


def _change(draw: st.DrawFn, holder: Any, last: Any) -> None:
    kind = draw(
        st.sampled_from(["replace", "drop", "double", "rename", "retype", "nudge", "wrap", "many", "swap"])
    )
    before = holder[last]
    if kind == "replace":
        holder[last] = draw(STRANGE)
    elif kind == "drop":
        del holder[last]
    elif kind == "double" and isinstance(holder, list):
        holder.insert(draw(st.integers(0, len(holder))), deepcopy(before))
    elif kind in ("double", "rename") and isinstance(holder, dict):
        name = draw(
            st.one_of(TEXTS, st.sampled_from([last.upper(), f"{last} ", f"//{last}", last[:-1], f"{last}s"]))
        )
        holder[name] = deepcopy(before) if kind == "double" else holder.pop(last)
    elif kind == "retype":
        holder[last] = draw(st.sampled_from([str(before), [before], {"value": before}, bool(before), None]))
    elif kind == "nudge" and isinstance(before, int | float):
        factor = draw(st.sampled_from([-1, 0, 0.5, 1 + 1e-9, 2, 1e3, 1e-3, 1e9, 1e-9]))
        with suppress(OverflowError):  # a whole number of hundreds of digits, put there before
            holder[last] = before * factor
    elif kind == "wrap":
        for _ in range(draw(st.sampled_from([1, 2, 40, 60, 300]))):
            holder[last] = [holder[last]]
    elif kind == "many" and isinstance(before, list):
        holder[last] = before * draw(st.sampled_from([0, 2, 3, 100]))
    elif kind == "many" and isinstance(before, dict):
        holder[last] = before | {f"{name}{n}": item for n in range(30) for name, item in before.items()}
    elif kind == "swap":
        other = draw(st.sampled_from(list(holder) if isinstance(holder, dict) else range(len(holder))))
        holder[last], holder[other] = holder[other], before


def encoded(draw: st.DrawFn, value: Any) -> bytes:
    """A JSON value as bytes: mostly UTF-8, with or without escapes."""
    text = json.dumps(value, ensure_ascii=draw(st.booleans()))
    encoding = draw(st.sampled_from(["utf-8"] * 12 + ["utf-8-sig", "utf-16", "latin-1"]))
    return text.encode(encoding, "surrogatepass" if encoding.startswith("utf") else "replace")


@st.composite
def damaged(draw: st.DrawFn, valid: bytes) -> bytes:
    """The bytes of a valid file: cut off, overwritten, with others put in, doubled or run together."""
    data = bytearray(valid)
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(data)))
        kind = draw(st.sampled_from(["truncate", "flip", "insert", "cut", "double"]))
        if kind == "truncate":
            del data[at:]
        elif kind == "flip" and at < len(data):
            data[at] ^= 1 << draw(st.integers(0, 7))
        elif kind == "insert":
            data[at:at] = draw(
                st.binary(max_size=12)
                | st.sampled_from(
                    [b"NaN", b"1e999", b"9" * 400, b"\xff", b"{", b'"', b"[" * 80, b"\xef\xbb\xbf", b"\x00"]
                )
            )
        elif kind == "cut":
            del data[at : at + draw(st.integers(1, 40))]
        else:
            data += data[: draw(st.integers(0, 200))]
    return bytes(data)


@st.composite
def files(draw: st.DrawFn, valid: Any) -> bytes:
    """The content of a file that was valid once: a value changed, or bytes damaged."""
    if draw(st.integers(0, 3)):
        return encoded(draw, draw(changed(valid)))
    return draw(damaged(json.dumps(valid, ensure_ascii=False).encode()))


def is_sentence(text: str, longest: int = 1500) -> bool:
    """Whether a text is one line that can be shown to people."""
    return len(text.splitlines()) == 1 and text.isprintable() and 10 < len(text) < longest


# --- Hypothesis strategies of libraries


def lines(longest: int) -> st.SearchStrategy[str]:
    """Single lines of text as a file may hold them."""
    letters = st.characters(exclude_categories=["Cc", "Cf", "Cs", "Zl", "Zp"])
    return st.text(letters, min_size=1, max_size=longest).map(str.strip).filter(bool)


LIBRARY_NUMBERS = st.floats(-3.0, 3.0, allow_nan=False)


@st.composite
def postures(draw: st.DrawFn) -> Posture:
    """Any posture: half of its degrees of freedom, among them whole half turns."""
    values = draw(st.dictionaries(st.integers(0, 33), LIBRARY_NUMBERS | st.just(np.pi), max_size=17))
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
    travel = draw(st.tuples(LIBRARY_NUMBERS, LIBRARY_NUMBERS, LIBRARY_NUMBERS)) if cyclic else (0.0, 0.0, 0.0)
    return LibraryMotion(name, steps, float(times[-1]) + draw(st.floats(1e-3, 1.0)), cyclic, travel)
