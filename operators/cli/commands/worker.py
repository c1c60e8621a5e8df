"""`keymark worker`: what the worker processes of a batch run; people never call it."""

import argparse

from ..parser import Command


def run(_arguments: argparse.Namespace) -> None:
    """Convert the jobs of a batch."""
    from ..batch.worker import run_worker

    run_worker()


WORKER = Command(name="worker", description="", run=run)
