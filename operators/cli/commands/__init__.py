"""All commands of the command line, one file each, in the order of `keymark --help`.

Each file declares a command's arguments and its `run`, which imports the use case of the same name from
`use_cases/`. Imports at the top of these files stay light: every call of `keymark` pays for them.
"""

from ..command import Command, CommandGroup
from .batch import BATCH
from .character import CHARACTER
from .check import CHECK
from .convert import CONVERT
from .demo import DEMO
from .detect import DETECT
from .library import LIBRARY
from .merge import MERGE
from .new import NEW
from .propose import PROPOSE
from .retarget import RETARGET
from .worker import WORKER

COMMANDS: tuple[Command | CommandGroup, ...] = (
    CONVERT,
    NEW,
    CHECK,
    BATCH,
    MERGE,
    WORKER,
    CHARACTER,
    RETARGET,
    DETECT,
    PROPOSE,
    LIBRARY,
    DEMO,
)
