"""Controls of rigs in Blender: how they act, found by trying, and what stands in the way of their keys."""
