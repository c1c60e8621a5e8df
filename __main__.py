"""`python -m keymark`: the command line."""

import sys

from .operators.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
