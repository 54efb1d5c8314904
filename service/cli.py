"""The command ``mechsynth``.

Only what is needed to read the command line is imported here: the worker processes import this module again when they
start, and ``mechsynth --help`` should not take a second.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

EXIT_FAILURE = 1
EXIT_USAGE = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status: 0 success, 1 failure, 2 wrong arguments or settings."""
    command = _parser().parse_args(arguments)
    if command.name == "serve":
        return _serve()
    if command.name == "demo":
        from httpx import HTTPError

        from service.demo import DemoFailure, demo

        try:
            demo(command.output)
        except (DemoFailure, HTTPError, OSError) as failure:
            print(f"mechsynth demo: {failure}", file=sys.stderr)
            return EXIT_FAILURE
        return 0
    from service import analyst
    from synthesis import dispatch

    dispatch.warm_up()
    dispatch.warm_up_rest()
    analyst.warm_up()
    return 0


def _serve() -> int:
    from service.settings import SettingsError, read_settings

    try:
        settings = read_settings()
    except SettingsError as error:
        print(f"mechsynth: {error}", file=sys.stderr)
        return EXIT_USAGE
    from service.server import ServeError, serve

    try:
        serve(settings)
    except ServeError as error:
        print(f"mechsynth: {error}", file=sys.stderr)
        return EXIT_FAILURE
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="mechsynth", description="A service that designs mechanisms.")
    commands = parser.add_subparsers(dest="name", required=True, metavar="command")
    commands.add_parser("serve", help="run the service; the environment variables MECHSYNTH_... set it up")
    demo = commands.add_parser("demo", help="solve a problem through a service of its own, and draw the answer")
    demo.add_argument("--output", type=Path, default=Path("var/demo.svg"), help="where the drawing goes (SVG)")
    commands.add_parser("warm", help="compile the numeric kernels, so that the first start need not")
    return parser


if __name__ == "__main__":
    sys.exit(main())
