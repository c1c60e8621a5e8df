"""`python -m keymark`: the command line."""

import sys

from .operators.cli import main

if __name__ == "__main__":
    sys.exit(main())
