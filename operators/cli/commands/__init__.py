"""The commands of the command line, a file each, which `keymark --help` lists in this order.

The file of a command is imported where it is run, or asked for its own help: what it needs may load slowly.
"""

SUMMARIES = {
    "animate": "go from a clip and the performer's height to a motion, and onto a character",
    "convert": "convert a take to motion.json, motion.blend, motion.bvh and pictures",
    "new": "describe a folder of clips: write its shoot.json",
    "check": "look through a shoot before it is converted",
    "batch": "convert every take of a shoot",
    "merge": "gather the motions of a batch in one asset library",
    "character": "recognize a character's bones and controls, or check its map",
    "retarget": "put a motion onto a character: character.blend, and .fbx, .glb, .usd or .bvh",
    "mend": "mend a motion from elsewhere: jitter, sliding feet, exchanged sides",
    "detect": "find points of the body in clips",
    "propose": "propose the frames to pose",
    "library": "list, show, check, merge, mirror, learn and exchange keyframe libraries",
    "demo": "convert the demonstration take and score the result",
}
"""Half a line on each command, by the name that the user types."""
