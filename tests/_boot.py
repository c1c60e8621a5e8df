"""Loads the repository root as the package `keymark`, whatever its folder is called."""

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "keymark"

# As the command line does: on small matrices a second thread of linear algebra only doubles the work.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def load_package() -> ModuleType:
    """Return the package `keymark`, made of this very tree and of no installed copy.

    A copy imported before would bring every class twice; it is refused.
    """
    loaded = sys.modules.get(PACKAGE)
    if loaded is not None:
        if Path(str(loaded.__file__)).resolve() != ROOT / "__init__.py":
            raise RuntimeError(f"{PACKAGE} is loaded from {loaded.__file__} already, not from {ROOT}")
        return loaded
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    if spec is None or spec.loader is None:
        raise RuntimeError(f"{ROOT} cannot be loaded as a package")
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    return package
