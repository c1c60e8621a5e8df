"""What an ONNX file says of itself, read before anything runs it: tensors in and out, operators, constants.

Of its protocol buffers only what is asked for is read (onnx.proto of ONNX 1.x); all else is passed over.
Nothing in the file is trusted: it is bounded in size, whole, and neither needs nor names anything outside.
"""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import prod
from pathlib import Path

from ..errors import InputError, shown
from ..files.paths import regular_file_size

LARGEST_BYTES = 512 * 2**20
MOST_NODES, DEEPEST = 100_000, 8  # operators in all, and graphs within graphs
MOST_AXES, LONGEST_NAME = 8, 200
STANDARD = ("", "ai.onnx")  # domains of the operators that the standard itself defines
FLOAT, HALF = 1, 10  # element types
KINDS = {FLOAT: "float", HALF: "half"}


@dataclass(frozen=True)
class Tensor:
    """A tensor that goes in or comes out."""

    name: str
    kind: int  # ONNX's number of its element type
    shape: tuple[int | None, ...]  # None for a length that is open

    @property
    def words(self) -> str:
        """Its name and shape, for sentences."""
        lengths = ", ".join("any" if length is None else str(length) for length in self.shape)
        return f"{self.name} ({lengths})" + ("" if self.kind in KINDS else f" of type {self.kind}")


@dataclass(frozen=True, eq=False)
class OnnxFile:
    """A file whose parts are whole and its own."""

    path: Path
    data: bytes
    digest: str  # SHA-256
    inputs: tuple[Tensor, ...]
    outputs: tuple[Tensor, ...]
    operators: frozenset[str]  # kinds of operators that it uses
    metadata: Mapping[str, str]  # what its maker noted


def read_onnx(path: Path) -> OnnxFile:
    """Read a file, and refuse it where it could do anything but calculate.

    Raises:
        InputError: It is no ONNX file, damaged, too large, has operators of its own, or needs other files.
    """
    size = regular_file_size(path, "a network")
    if size > LARGEST_BYTES:
        raise InputError(f"{path}: has {size / 2**20:.0f} MB; a network may have {LARGEST_BYTES // 2**20}")
    data = path.read_bytes()
    if data[:2] == b"PK":
        raise InputError(f"{path}: is a zip archive; unpack it and name the .onnx file in it")
    reader = _Reader(len(data))
    try:
        reader.model(memoryview(data))
    except _DamagedError as error:
        raise InputError(f"{path}: is no ONNX file, or a damaged one ({error})") from error
    except _RefusedError as error:
        raise InputError(f"{path}: {error}") from error
    inputs = tuple(one for one in reader.inputs if one.name not in reader.constants)
    if not inputs or not reader.outputs or not reader.operators:
        raise InputError(f"{path}: is no ONNX file of a network; it must have operators, inputs and outputs")
    digest = hashlib.sha256(data).hexdigest()
    operators = frozenset(reader.operators)
    return OnnxFile(path, data, digest, inputs, tuple(reader.outputs), operators, reader.metadata)


class _DamagedError(Exception):
    """The bytes are no message of this kind."""


class _RefusedError(Exception):
    """The file is whole but asks for too much."""


Value = int | memoryview
Parts = Iterator[tuple[int, Value]]


def _parts(data: memoryview) -> Parts:
    """The fields of a message, each with its number: whole numbers, or bytes."""
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        number, wire = key >> 3, key & 7
        if not number:
            raise _DamagedError("a field has the number 0")
        if wire == 0:
            value, at = _varint(data, at)
            yield number, value
            continue
        if wire == 2:
            length, at = _varint(data, at)
        elif wire in (1, 5):
            length = 8 if wire == 1 else 4
        else:
            raise _DamagedError(f"a field is of the kind {wire}")
        if at + length > len(data):
            raise _DamagedError("it ends within a field")
        yield number, data[at : at + length]
        at += length


def _varint(data: memoryview, at: int) -> tuple[int, int]:
    value = 0
    for step in range(10):
        if at + step >= len(data):
            raise _DamagedError("it ends within a number")
        byte = data[at + step]
        value |= (byte & 0x7F) << 7 * step
        if not byte & 0x80:
            return value, at + step + 1
    raise _DamagedError("a number has more than 64 bits")


def _bytes(value: Value) -> memoryview:
    if isinstance(value, int):
        raise _DamagedError("a number stands for a text or a part")
    return value


def _text(value: Value) -> str:
    text = bytes(_bytes(value)[: 4 * LONGEST_NAME]).decode("utf-8", "replace")[:LONGEST_NAME]
    return "".join(char if char.isprintable() else "?" for char in text)


def _number(value: Value) -> int:
    """A whole number with its sign."""
    if not isinstance(value, int):
        raise _DamagedError("a part stands for a number")
    return value - 2**64 if value >= 2**63 else value


@dataclass
class _Reader:
    """What is read of a model and of the graphs in it."""

    size: int  # of the file [bytes]
    inputs: list[Tensor] = field(default_factory=list)
    outputs: list[Tensor] = field(default_factory=list)
    constants: set[str] = field(default_factory=set)
    operators: set[str] = field(default_factory=set)
    metadata: dict[str, str] = field(default_factory=dict)
    _nodes: int = 0

    def model(self, data: memoryview) -> None:
        graphs = 0
        for number, value in _parts(data):
            if number == 7:
                graphs += 1
                self.graph(_bytes(value), 0)
            elif number == 14:
                entry = dict(_parts(_bytes(value)))
                if {1, 2} <= set(entry):
                    self.metadata[_text(entry[1])] = _text(entry[2])
            elif number in (20, 25):
                what = "training" if number == 20 else "functions"
                raise _RefusedError(f"brings {what} of its own; a network must use standard operators alone")
        if graphs != 1:
            raise _DamagedError(f"it has {graphs} graphs")

    def graph(self, data: memoryview, depth: int) -> None:
        if depth > DEEPEST:
            raise _RefusedError(f"has graphs within graphs, deeper than {DEEPEST}")
        for number, value in _parts(data):
            if number == 1:
                self.node(_bytes(value), depth)
            elif number == 5:
                self.constants.add(self.tensor(_bytes(value)))
            elif number == 15:
                self.sparse(_bytes(value))
            elif number in (11, 12) and not depth:
                (self.inputs if number == 11 else self.outputs).append(_described(_bytes(value)))

    def node(self, data: memoryview, depth: int) -> None:
        self._nodes += 1
        if self._nodes > MOST_NODES:
            raise _RefusedError(f"has more than {MOST_NODES} operators")
        kind, domain = "", ""
        for number, value in _parts(data):
            if number == 4:
                kind = _text(value)
            elif number == 7:
                domain = _text(value)
            elif number == 5:
                self.attribute(_bytes(value), depth)
        if domain not in STANDARD:
            raise _RefusedError(
                f"uses the operator {shown(kind)} of {shown(domain)}; a network must use ONNX's own "
                "operators alone"
            )
        self.operators.add(kind)

    def attribute(self, data: memoryview, depth: int) -> None:
        for number, value in _parts(data):
            if number in (5, 10):
                self.tensor(_bytes(value))
            elif number in (6, 11):
                self.graph(_bytes(value), depth + 1)
            elif number in (22, 23):
                self.sparse(_bytes(value))

    def sparse(self, data: memoryview) -> None:
        lengths: list[int] = []
        for number, value in _parts(data):
            if number in (1, 2):
                self.tensor(_bytes(value))
            elif number == 3:
                lengths += _integers(value)
        self.bounded(lengths, 1024)

    def tensor(self, data: memoryview) -> str:
        """Check a constant; returns its name."""
        name, lengths = "", list[int]()
        for number, value in _parts(data):
            if number == 1:
                lengths += _integers(value)
            elif number == 8:
                name = _text(value)
            elif number == 13 or (number == 14 and value != 0):
                raise _RefusedError(
                    "has its weights in another file; it must be one file that holds everything, as "
                    "onnx.save writes it without external data"
                )
        self.bounded(lengths, 2)
        return name

    def bounded(self, lengths: Sequence[int], times: int) -> None:
        """Refuse a constant with more numbers than so many times the file's bytes."""
        if any(length < 0 for length in lengths) or prod(lengths) > times * self.size:
            raise _DamagedError(f"a constant has the shape {shown(list(lengths[:MOST_AXES]))}")


def _integers(value: Value) -> list[int]:
    """A repeated whole number, alone or packed."""
    if isinstance(value, int):
        return [_number(value)]
    found, at = [], 0
    while at < len(value):
        one, at = _varint(value, at)
        found.append(_number(one))
        if len(found) > MOST_AXES:
            raise _DamagedError(f"a constant has more than {MOST_AXES} axes")
    return found


def _described(data: memoryview) -> Tensor:
    """A tensor as ValueInfoProto describes it; of another type than a tensor it has the kind 0."""
    name, kind, shape = "", 0, list[int | None]()
    for number, value in _parts(data):
        if number == 1:
            name = _text(value)
        elif number == 2:
            for of_type, tensor in _parts(_bytes(value)):
                if of_type == 1:
                    for part, content in _parts(_bytes(tensor)):
                        if part == 1:
                            kind = _number(content)
                        elif part == 2:
                            shape = [_length(_bytes(one)) for at, one in _parts(_bytes(content)) if at == 1]
    if len(shape) > MOST_AXES:
        raise _DamagedError(f"{name} has {len(shape)} axes")
    return Tensor(name, kind, tuple(shape))


def _length(data: memoryview) -> int | None:
    """A length of a shape; one by name is open, as are lengths below 1."""
    value = next((_number(own) for number, own in _parts(data) if number == 1), None)
    return value if value is None or value > 0 else None
