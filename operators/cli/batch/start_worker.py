"""Script that runs a worker in plain Python; loads the package from this tree under the name `keymark`."""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PACKAGE = "keymark"


def main() -> int:
    """Run the command `worker`; returns the exit status."""
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    sys.modules[PACKAGE] = package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    status: int = importlib.import_module(f"{PACKAGE}.operators.cli.main").main(["worker"])
    return status


if __name__ == "__main__":
    sys.exit(main())
