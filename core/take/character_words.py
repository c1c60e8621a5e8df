"""Words for how a motion is put onto a character; imports nothing, so that `--help` stays fast."""

ROOT_MOTIONS = ("as-filmed", "in-place", "root-bone")
PLACEMENTS = ("performer", "character")
LIMB_KEYS = ("fk", "ik", "both")
"""The options of `core/retarget/options` are called the same, with underscores."""
