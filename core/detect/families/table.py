"""The families that are known, and the one a file is of."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import InputError, describe_unexpected
from ...files.fields import listed
from ..network_file import open_session
from ..onnx_file import Tensor, read_onnx
from .heat_maps import HeatMaps
from .instant_hmr import InstantHMR
from .network import Network, Signature, refuse_inputs, run
from .simcc import SimCC

FAMILIES: tuple[type[Network], ...] = (InstantHMR, SimCC, HeatMaps)
"""In the order in which a file is held against them; see docs/detectors.md on how to add one."""


def open_network(path: Path) -> Network:
    """The network in a file, known by what goes in and comes out.

    Raises:
        InputError: The file is unusable (see `read_onnx`), or of no known family.
    """
    file = read_onnx(path)
    refuse_inputs(file)
    try:
        session = open_session(file.data, "more points")
    except InputError:
        raise
    except Exception as error:  # onnxruntime's own kinds of error have no base of their own
        what = describe_unexpected(error)[:200]
        raise InputError(f"{path}: cannot be opened as a network ({what}); it may be damaged") from error
    inputs = tuple(replace(one, shape=(1, *one.shape[1:])) for one in file.inputs)
    empty = [np.zeros([length or 1 for length in one.shape], dtype=np.float32) for one in inputs]
    given = zip(file.outputs, run(session, path, inputs, empty), strict=True)
    outputs = tuple(Tensor(one.name, one.kind, values.shape) for one, values in given)
    signature = Signature(file, inputs, outputs)
    for family in FAMILIES:
        network = family.recognize(signature)
        if network is not None:
            network.session = session
            return network
    known = listed([family.KNOWN for family in FAMILIES])
    takes, gives = (listed([one.words for one in part[:6]]) for part in (file.inputs, outputs))
    raise InputError(f"{path}: takes {takes} and gives {gives}, as no known network does; known are {known}")
