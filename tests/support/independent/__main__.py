"""Measure and report: ``python -m tests.support.independent --answers 200 --cams 50``."""

from __future__ import annotations

import argparse

from tests.support.independent.cams import cams
from tests.support.independent.comparison import Measured
from tests.support.independent.linkages import linkages


def main() -> None:
    """Read the command line; what was compared until then is told where the program is interrupted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--answers", type=int, default=200, help="designs of linkages to compare")
    parser.add_argument("--cams", type=int, default=50)
    parser.add_argument(
        "--demanding-cams", type=int, default=0, help="cams with every demand that a statement can have"
    )
    parser.add_argument("--names", default="", help="names of families of statements, with commas; all if left out")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--verbose", action="store_true", help="a line for each statement")
    args = parser.parse_args()
    result = Measured()
    names = tuple(filter(None, args.names.split(",")))
    try:
        if args.answers:
            linkages(args.answers, names, args.seed, result, told=0.0 if args.verbose else None)
        answered = cams(args.cams, args.seed, result)
        print(f"{answered} of {args.cams} cams answered")
        if args.demanding_cams:
            answered = cams(args.demanding_cams, args.seed, result, every_demand=True, told=args.verbose)
            print(f"{answered} of {args.demanding_cams} demanding cams answered")
    except KeyboardInterrupt:
        print("interrupted")
    print(result.report())


if __name__ == "__main__":
    main()
