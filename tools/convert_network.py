"""A TensorFlow Lite network as ONNX, which onnxruntime runs: the same weights in ONNX's order.

Reads FlatBuffers and writes protocol buffers by itself, since it runs before anything is installed. Only the
operators of the networks that Keymark ships are known; others are refused by their number. Images have their
channels first (N, C, H, W); 16-bit weights stay 16 bits in the file and are widened as it is loaded.

Sources: TensorFlow Lite's schema.fbs, ONNX's onnx.proto and operators of opset 13.
"""

import struct
from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import chain

FLOAT, INT64, HALF = 1, 7, 10  # element types of ONNX
TYPES = {0: FLOAT, 1: HALF}  # by those of TensorFlow Lite
BYTES = {FLOAT: ("f", 4), HALF: ("H", 2)}
ACTIVATIONS = {0: None, 1: "Relu", 3: "Clip"}  # none, ReLU, ReLU6


class Table:
    """A table of a FlatBuffer, whose fields are asked for by their number in the schema."""

    def __init__(self, data: bytes, at: int) -> None:
        self._data, self._at = data, at
        self._fields = at - struct.unpack_from("<i", data, at)[0]

    @classmethod
    def root(cls, data: bytes) -> "Table":
        """The table that a file begins with."""
        return cls(data, struct.unpack_from("<I", data)[0])

    def _place(self, number: int) -> int:
        entry = 4 + 2 * number
        if entry >= struct.unpack_from("<H", self._data, self._fields)[0]:
            return 0
        offset = struct.unpack_from("<H", self._data, self._fields + entry)[0]
        return self._at + offset if offset else 0

    def _target(self, number: int) -> int:
        place = self._place(number)
        return place + struct.unpack_from("<I", self._data, place)[0] if place else 0

    def number(self, number: int, kind: str = "<i") -> int:
        """A field that is a number, 0 where it is left out."""
        place = self._place(number)
        return struct.unpack_from(kind, self._data, place)[0] if place else 0

    def table(self, number: int) -> "Table":
        """A field that is a table."""
        return Table(self._data, self._target(number))

    def vector(self, number: int) -> bytes:
        """A field that is a vector of bytes or a text."""
        at = self._target(number)
        return self._data[at + 4 : at + 4 + struct.unpack_from("<I", self._data, at)[0]] if at else b""

    def integers(self, number: int) -> tuple[int, ...]:
        """A field that is a vector of integers."""
        at = self._target(number)
        return (
            struct.unpack_from(f"<{struct.unpack_from('<I', self._data, at)[0]}i", self._data, at + 4)
            if at
            else ()
        )

    def tables(self, number: int) -> list["Table"]:
        """A field that is a vector of tables."""
        at = self._target(number)
        places = range(at + 4, at + 4 + 4 * struct.unpack_from("<I", self._data, at)[0], 4) if at else ()
        return [Table(self._data, place + struct.unpack_from("<I", self._data, place)[0]) for place in places]


@dataclass(frozen=True)
class Tensor:
    """A tensor of the TensorFlow Lite network."""

    name: str
    shape: tuple[int, ...]  # N, H, W, C where it is an image
    kind: int
    data: bytes  # of a constant; none of what is calculated


@dataclass(frozen=True)
class Operation:
    """An operator of the network with its tensors, by number, and its options."""

    code: int
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    options: Table


@dataclass
class Graph:
    """An ONNX graph that is written node by node."""

    nodes: list[bytes] = field(default_factory=list)
    constants: list[bytes] = field(default_factory=list)

    def node(self, kind: str, inputs: Sequence[str], output: str, **attributes: object) -> str:
        """Add a node; returns the name of its output."""
        parts = [_bytes(1, name.encode()) for name in inputs] + [_bytes(2, output.encode())]
        parts.append(_bytes(4, kind.encode()))
        parts += [_bytes(5, _attribute(name, value)) for name, value in attributes.items()]
        self.nodes.append(b"".join(parts))
        return output

    def constant(self, name: str, kind: int, shape: Iterable[int], data: bytes) -> str:
        """Add a constant; returns its name."""
        dims = b"".join(_integer(1, size) for size in shape)
        self.constants.append(dims + _integer(2, kind) + _bytes(8, name.encode()) + _bytes(9, data))
        return name

    def integers(self, name: str, values: Sequence[int]) -> str:
        """Add a constant vector of integers; returns its name."""
        return self.constant(name, INT64, [len(values)], struct.pack(f"<{len(values)}q", *values))


class Converter:
    """A network's operators, written as nodes of an ONNX graph."""

    def __init__(self, data: bytes) -> None:
        model = Table.root(data)
        codes = [max(code.number(0, "<b"), code.number(3)) for code in model.tables(1)]
        buffers = model.tables(4)
        (network,) = model.tables(2)
        self.tensors = [
            Tensor(
                one.vector(3).decode(),
                one.integers(0),
                one.number(1, "<b"),
                buffers[one.number(2, "<I")].vector(0),
            )
            for one in network.tables(0)
        ]
        self.inputs, self.outputs = network.integers(1), network.integers(2)
        self.operations = [
            Operation(codes[one.number(0, "<I")], one.integers(1), one.integers(2), one.table(4))
            for one in network.tables(3)
        ]
        self.widened = {
            one.outputs[0]: one.inputs[0]
            for one in self.operations
            if one.code == DEQUANTIZE and self.tensors[one.inputs[0]].data
        }
        self.graph = Graph()

    def convert(self, outputs: Sequence[str]) -> bytes:
        """The ONNX file of what leads to these outputs, by name."""
        wanted = [index for index in self.outputs if self.tensors[index].name in outputs]
        needed, operations = set(wanted), []
        for one in reversed(self.operations):
            if needed.intersection(one.outputs) and one.outputs[0] not in self.widened:
                operations.append(one)
                needed.update(one.inputs)
        for one in reversed(operations):
            if one.code not in WRITERS:
                raise SystemExit(f"The network has operator {one.code}, which no writer knows.")
            WRITERS[one.code](self, one)
        for index in wanted:
            self.graph.node("Identity", [_name(index)], self.tensors[index].name)
        own = [_bytes(1, node) for node in self.graph.nodes] + [_bytes(2, b"network")]
        own += [_bytes(5, constant) for constant in self.graph.constants]
        own += [_bytes(11, _value(_name(index), self.shape(index))) for index in self.inputs]
        own += [_bytes(12, _value(self.tensors[index].name, self.shape(index))) for index in wanted]
        opset = _bytes(8, _integer(2, 13))
        return _integer(1, 7) + _bytes(2, b"keymark") + opset + _bytes(7, b"".join(own))

    def shape(self, index: int) -> tuple[int, ...]:
        """The shape of a tensor in ONNX: channels first."""
        shape = self.tensors[index].shape
        return (shape[0], shape[3], *shape[1:3]) if len(shape) == 4 else shape

    def weights(self, index: int, order: str = "") -> str:
        """The name of constant weights; `order` OHWI, HWO or HWC has an image's axes put as ONNX has them."""
        tensor = self.tensors[self.widened.get(index, index)]
        kind, name = TYPES[tensor.kind], f"w{index}"
        code, _ = BYTES[kind]
        values, shape = array(code, tensor.data), tensor.shape
        if order == "OHWI":
            outer, *area, inner = shape
            size = area[0] * area[1]
            planes = (values[first * size * inner : (first + 1) * size * inner] for first in range(outer))
            values = array(code, chain.from_iterable(p[i::inner] for p in planes for i in range(inner)))
            shape = (outer, inner, *area)
        elif order == "HWO":  # of a convolution that has a filter a channel
            values = array(code, chain.from_iterable(values[i :: shape[3]] for i in range(shape[3])))
            shape = (shape[3], 1, *shape[1:3])
        elif order == "HWC":
            shape = (shape[2], *shape[:2])
        if kind == FLOAT:
            return self.graph.constant(name, kind, shape, values.tobytes())
        return self.graph.node(
            "Cast", [self.graph.constant(f"{name}h", kind, shape, values.tobytes())], name, to=FLOAT
        )

    def activated(
        self, activation: int, output: int, kind: str, inputs: Sequence[str], **attributes: object
    ) -> None:
        """Add a node that an activation follows."""
        after = ACTIVATIONS[activation]
        name = _name(output)
        self.graph.node(kind, inputs, f"{name}_" if after else name, **attributes)
        if after == "Clip":
            bounds = [
                self.graph.constant(f"{name}{end}", FLOAT, [], struct.pack("<f", end)) for end in (0, 6)
            ]
            self.graph.node(after, [f"{name}_", *bounds], name)
        elif after:
            self.graph.node(after, [f"{name}_"], name)

    def padding(self, one: Operation, kernel: Sequence[int], strides: Sequence[int]) -> list[int]:
        """Rows and columns of zeros before and after an image, by TensorFlow's SAME or VALID."""
        if one.options.number(0, "<b") == 1:
            return [0, 0, 0, 0]
        before, after = [], []
        for axis, (size, stride) in enumerate(zip(kernel, strides, strict=True), 1):
            length = self.tensors[one.inputs[0]].shape[axis]
            missing = max((-(-length // stride) - 1) * stride + size - length, 0)
            before.append(missing // 2)
            after.append(missing - missing // 2)
        return before + after

    def convolution(self, one: Operation) -> None:
        """A convolution, over all channels or within each."""
        image, weights, bias = one.inputs
        depthwise = one.code == DEPTHWISE
        shape = self.tensors[weights].shape
        strides = [one.options.number(2), one.options.number(1)]
        self.activated(
            one.options.number(4 if depthwise else 3, "<b"),
            one.outputs[0],
            "Conv",
            [_name(image), self.weights(weights, "HWO" if depthwise else "OHWI"), self.weights(bias)],
            strides=strides,
            pads=self.padding(one, shape[1:3], strides),
            group=shape[3] if depthwise else 1,
        )

    def addition(self, one: Operation) -> None:
        """The sum of two images."""
        self.activated(
            one.options.number(0, "<b"), one.outputs[0], "Add", [_name(index) for index in one.inputs]
        )

    def largest(self, one: Operation) -> None:
        """The largest of each window."""
        strides = [one.options.number(2), one.options.number(1)]
        kernel = [one.options.number(4), one.options.number(3)]
        pads = self.padding(one, kernel, strides)
        words = {"kernel_shape": kernel, "strides": strides, "pads": pads}
        self.activated(
            one.options.number(5, "<b"), one.outputs[0], "MaxPool", [_name(one.inputs[0])], **words
        )

    def padded(self, one: Operation) -> None:
        """An image with zeros about it."""
        rows = struct.unpack("<8i", self.tensors[one.inputs[1]].data)
        first = [rows[2 * axis + end] for end in (0, 1) for axis in (0, 3, 1, 2)]
        name = _name(one.outputs[0])
        self.graph.node("Pad", [_name(one.inputs[0]), self.graph.integers(f"{name}p", first)], name)

    def enlarged(self, one: Operation) -> None:
        """An image of another size, by bilinear interpolation."""
        name = _name(one.outputs[0])
        corners, half = (bool(one.options.number(number, "<b")) for number in (2, 3))
        mode = "align_corners" if corners else "half_pixel" if half else "asymmetric"
        sizes = self.graph.integers(f"{name}s", self.shape(one.outputs[0]))
        words = [_name(one.inputs[0]), "", "", sizes]
        self.graph.node("Resize", words, name, mode=b"linear", coordinate_transformation_mode=mode.encode())

    def reshaped(self, one: Operation) -> None:
        """The same numbers in another shape."""
        name, image = _name(one.outputs[0]), one.inputs[0]
        source, shape = _name(image), self.tensors[image].shape
        if len(shape) == 4 and shape[1:3] != (1, 1):  # else both orders are the same
            source = self.graph.node("Transpose", [source], f"{name}t", perm=[0, 2, 3, 1])
        sizes = self.graph.integers(f"{name}s", self.tensors[one.outputs[0]].shape)
        self.graph.node("Reshape", [source, sizes], name)

    def averaged(self, one: Operation) -> None:
        """The mean of each channel, over the whole image."""
        name = _name(one.outputs[0])
        self.graph.node("ReduceMean", [_name(one.inputs[0])], name, axes=[2, 3], keepdims=0)

    def connected(self, one: Operation) -> None:
        """A layer in which all depends on all."""
        image, weights, bias = one.inputs
        inputs = [_name(image), self.weights(weights), self.weights(bias)]
        self.activated(one.options.number(0, "<b"), one.outputs[0], "Gemm", inputs, transB=1)

    def sloped(self, one: Operation) -> None:
        """What is below zero times a slope for each channel."""
        image, slopes = one.inputs
        self.graph.node("PRelu", [_name(image), self.weights(slopes, "HWC")], _name(one.outputs[0]))

    def logistic(self, one: Operation) -> None:
        """The logistic function."""
        self.graph.node("Sigmoid", [_name(one.inputs[0])], _name(one.outputs[0]))


ADD, CONVOLUTION, DEPTHWISE, DEQUANTIZE, CONNECTED, LOGISTIC, MAX_POOL = 0, 3, 4, 6, 9, 14, 17
RESHAPE, RESIZE, PAD, MEAN, PRELU = 22, 23, 34, 40, 54
WRITERS = {
    ADD: Converter.addition,
    CONNECTED: Converter.connected,
    CONVOLUTION: Converter.convolution,
    DEPTHWISE: Converter.convolution,
    LOGISTIC: Converter.logistic,
    MAX_POOL: Converter.largest,
    MEAN: Converter.averaged,
    PAD: Converter.padded,
    PRELU: Converter.sloped,
    RESHAPE: Converter.reshaped,
    RESIZE: Converter.enlarged,
}
"""By the number of TensorFlow Lite's operator."""


def onnx_of(data: bytes, outputs: Sequence[str]) -> bytes:
    """The ONNX file of a TensorFlow Lite file, in so far as these outputs need it."""
    return Converter(data).convert(outputs)


def _name(index: int) -> str:
    return f"t{index}"


# --- Protocol buffers


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)


def _integer(number: int, value: int) -> bytes:
    return _varint(number << 3) + _varint(value)


def _bytes(number: int, value: bytes) -> bytes:
    return _varint(number << 3 | 2) + _varint(len(value)) + value


def _attribute(name: str, value: object) -> bytes:
    own = _bytes(1, name.encode())
    if isinstance(value, bytes):
        return own + _bytes(4, value) + _integer(20, 3)
    if isinstance(value, int):
        return own + _integer(3, value) + _integer(20, 2)
    assert isinstance(value, list)
    return own + b"".join(_integer(8, each) for each in value) + _integer(20, 7)


def _value(name: str, shape: Sequence[int]) -> bytes:
    dims = b"".join(_bytes(1, _integer(1, size)) for size in shape)
    return _bytes(1, name.encode()) + _bytes(2, _bytes(1, _integer(1, FLOAT) + _bytes(2, dims)))
