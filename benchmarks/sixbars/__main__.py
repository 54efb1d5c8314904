"""Print a row of :mod:`tests.support.sixbars`."""

from __future__ import annotations

import argparse
import importlib
import pkgutil

import tests.support.sixbars as package
from tests.support.sixbars.spread import Spread

NO_ROWS = {"__main__", "driven", "spread"}
"""Modules of the package that are no rows."""


def main() -> None:
    names = sorted(module.name for module in pkgutil.iter_modules(package.__path__) if module.name not in NO_ROWS)
    parser = argparse.ArgumentParser(description=package.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("row", choices=names)
    parser.add_argument("--tasks", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=1, help="how many tasks are worked on at once")
    asked = parser.parse_args()
    Spread.processes = asked.processes
    row = importlib.import_module(f"{package.__name__}.{asked.row}")
    row.table(row.TASKS if asked.tasks is None else asked.tasks, asked.seed)


if __name__ == "__main__":
    main()
