"""Make the pictures of the pages anew, and the pages that are kept with their numbers; all or those named.

Run: python docs/pictures [--into FOLDER] [NAME ...], or make pictures
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import of_conformance
import of_control
import of_runs
import of_statements
import of_studies
import of_studio

Recipe = Callable[[Path], None]
RECIPES: dict[str, Recipe] = {
    "hybrid-stress.png": of_runs.hybrid_stress,
    "hybrid-fields.png": of_runs.hybrid_fields,
    "coatings.png": of_runs.coatings,
    "sphere-slice.png": of_runs.sphere_slice,
    "three-dimensions-cuts.png": of_runs.cuts,
    "three-dimensions-wall.png": of_runs.wall,
    "three-dimensions-snapshots.png": of_runs.snapshots,
    "three-dimensions-film.webp": of_runs.film,
    "three-dimensions-wall-film.webp": of_runs.wall_film,
    "shock-spectra.png": of_runs.shock_spectra,
    "participation.png": of_runs.participation,
    "natural-frequencies.png": of_runs.natural_frequencies,
    "dispersion.png": of_runs.dispersion,
    "frequency-response.png": of_runs.frequency_response,
    "identify.png": of_runs.identify,
    "control-limits.png": of_control.limits,
    "control-segments.png": of_control.segments,
    "design-study-optima.png": of_studies.optima,
    "studio.png": of_studio.home,
    "studio-space.png": of_studio.space,
    "studio-designs.png": of_studio.designs,
}
"""The pictures in docs/figures, but those of searches, which docs/studies draws as it carries them out; and what makes each."""
PAGES: dict[str, Recipe] = {"conformance.md": of_conformance.write, "statements.md": of_statements.write}
"""Pages in docs whose numbers take too long for every build."""


def main() -> None:
    """Make them one after the other, and say how long each took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="file names in docs/figures and docs; all unless given")
    parser.add_argument("--into", type=Path, metavar="FOLDER", help="instead of docs/figures and docs")
    asked = parser.parse_args()
    known = RECIPES | PAGES
    unknown = set(asked.names) - known.keys()
    if unknown:
        parser.error(f"there is no {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    docs = Path(__file__).parents[1]
    for name in asked.names or known:
        begun = time.perf_counter()
        folder = asked.into or (docs / "figures" if name in RECIPES else docs)
        folder.mkdir(parents=True, exist_ok=True)
        known[name](folder / name)
        print(f"{name}  {time.perf_counter() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main()
