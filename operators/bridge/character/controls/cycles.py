"""Dependency cycles of an armature: drivers and constraints that wait for each other."""

import bpy

from .dependencies import Graph, dependencies


def dependency_cycle(armature_object: bpy.types.Object) -> tuple[str, ...]:
    """Bones and properties that depend on each other in a circle, the first again at the end; () for none."""
    graph = dependencies(armature_object)
    done: set[str] = set()
    for start in graph:
        found = _cycle_from(graph, start, done)
        if found:
            return found
    return ()


def _cycle_from(graph: Graph, start: str, done: set[str]) -> tuple[str, ...]:
    """A cycle that can be reached from a node; nodes that reach none are added to `done`."""
    path: list[str] = []
    waiting: list[tuple[str, int]] = [(start, 0)]
    while waiting:
        name, depth = waiting.pop()
        for left in path[depth:]:
            done.add(left)
        del path[depth:]
        if name in path:
            return (*path[path.index(name) :], name)
        if name in done:
            continue
        path.append(name)
        waiting += [(other, depth + 1) for other in sorted(graph[name])]
    done.update(path)
    return ()
