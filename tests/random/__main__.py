"""Many random systems on request: ``python tests/random --systems 500``."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from oracles import ORACLES
from random_study import Study


def main() -> int:
    """Run them and print a table; 1 if an oracle is broken."""
    parser = argparse.ArgumentParser(prog="python tests/random", description=__doc__)
    parser.add_argument("--systems", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--without-refinement", action="store_true", help="leave the printed errors alone")
    parser.add_argument("--only", nargs="*", default=None, choices=[*ORACLES, []], help="these oracles; none for the printed errors alone")
    parser.add_argument("--keep", type=Path, metavar="FILE.json", help="also write every single number")
    asked = parser.parse_args()
    study = Study()
    for seed in range(asked.first, asked.first + asked.systems):
        study.add(seed, ORACLES if asked.only is None else asked.only, refine=not asked.without_refinement)
        print(f"\r{seed - asked.first + 1} of {asked.systems}", end="", file=sys.stderr, flush=True)  # noqa: T201
    print(file=sys.stderr)  # noqa: T201
    print(study)  # noqa: T201
    if asked.keep is not None:
        ratios = [
            {"cause": cause, "quantity": quantity, **one._asdict()} for (cause, quantity), all_ in study.ratios.items() for one in all_
        ]
        asked.keep.write_text(json.dumps({"mismatches": study.mismatches, "ratios": ratios, "refused": study.refused}, indent=1))
    return 1 if study.broken() else 0


if __name__ == "__main__":
    sys.exit(main())
