"""Many random systems on request: ``python tests/random --systems 500``."""

from __future__ import annotations

import argparse
import sys

from oracles import ORACLES
from random_study import Study


def main() -> int:
    """Run them and print a table; 1 if an oracle is broken."""
    parser = argparse.ArgumentParser(prog="python tests/random", description=__doc__)
    parser.add_argument("--systems", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--without-refinement", action="store_true", help="leave the printed errors alone")
    parser.add_argument("--only", nargs="*", default=None, choices=[*ORACLES, []], help="these oracles; none for the printed errors alone")
    asked = parser.parse_args()
    study = Study()
    for seed in range(asked.first, asked.first + asked.systems):
        study.add(seed, ORACLES if asked.only is None else asked.only, refine=not asked.without_refinement)
        print(f"\r{seed - asked.first + 1} of {asked.systems}", end="", file=sys.stderr, flush=True)  # noqa: T201
    print(file=sys.stderr)  # noqa: T201
    print(study)  # noqa: T201
    return 1 if study.broken() else 0


if __name__ == "__main__":
    sys.exit(main())
