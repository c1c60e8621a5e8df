"""A character as glTF, written without Blender: bones at their heads and a triangle on the first."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from keymark.core.retarget.character import Character

GLB, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
FLOAT, BYTE = 5126, 5121


def write_glb(character: Character, path: Path) -> Path:
    """Write a character as one file, whatever its ending."""
    whole, binary = _document(character)
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
    chunks += struct.pack("<II", len(binary), BINARY_CHUNK) + binary
    path.write_bytes(struct.pack("<III", GLB, 2, 12 + len(chunks)) + chunks)
    return path


def write_gltf(character: Character, path: Path) -> Path:
    """Write a character as JSON with its numbers in a file beside it."""
    whole, binary = _document(character)
    buffer = path.with_suffix(".bin")
    buffer.write_bytes(binary)
    whole["buffers"][0]["uri"] = buffer.name
    path.write_text(json.dumps(whole), encoding="utf-8")
    return path


def _document(character: Character) -> tuple[dict[str, Any], bytes]:
    """The JSON and the numbers; glTF has Y up, and bones are joints without length."""
    places = np.array([bone.head for bone in character.bones])
    heads = character.scale * np.stack([places[:, 0], places[:, 2], -places[:, 1]], axis=1)
    inverse = np.tile(np.eye(4, dtype="<f4"), (len(heads), 1, 1))
    inverse[:, 3, :3] = -heads  # column-major
    triangle = heads[0] + np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]])
    parts = [
        inverse.astype("<f4").tobytes(),
        triangle.astype("<f4").tobytes(),
        np.zeros((3, 4), dtype="u1").tobytes(),
        np.tile(np.array([1, 0, 0, 0], dtype="<f4"), (3, 1)).tobytes(),
    ]
    nodes: list[dict[str, Any]] = []
    for number, bone in enumerate(character.bones):
        above = heads[bone.parent] if bone.parent >= 0 else np.zeros(3)
        node = {"name": bone.name, "translation": (heads[number] - above).tolist()}
        below = character.children[number]
        nodes.append(node | ({"children": list(below)} if below else {}))
    count = len(nodes)
    nodes.append({"name": "Body", "mesh": 0, "skin": 0})
    roots = [number for number, bone in enumerate(character.bones) if bone.parent < 0]
    views, at = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        at += len(part)
    corners = {"min": triangle.min(axis=0).tolist(), "max": triangle.max(axis=0).tolist()}
    whole = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [*roots, count]}],
        "nodes": nodes,
        "skins": [{"name": character.name, "joints": list(range(count)), "inverseBindMatrices": 0}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}], "name": "Body"}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": FLOAT, "count": count, "type": "MAT4"},
            {"bufferView": 1, "componentType": FLOAT, "count": 3, "type": "VEC3", **corners},
            {"bufferView": 2, "componentType": BYTE, "count": 3, "type": "VEC4"},
            {"bufferView": 3, "componentType": FLOAT, "count": 3, "type": "VEC4"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": at}],
    }
    return whole, b"".join(parts)
