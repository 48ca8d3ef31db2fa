"""What the report says, whatever it is written in."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coaxshell.apps.paper.claims.claim import Verdict

TITLE = "Slice, cylinder or sphere?"
SHOWN_DECAY, SHOWN_DURATION = 0.2, 4.0
"""Transits, at which errors are laid out over the distance: next to the paper's 0.18, and the duration of its figures but one."""

ABOUT = (
    "The paper takes a slice: in the plane, the pressure of a spherical front, S/R f(t − (R − S)), while walls and fluids answer alike "
    "along the axis. It calls that in strong agreement with the sphere at the mid-plane. Its own bare shells under a true spherical "
    "front, in three dimensions at z = 0, say otherwise; line source and plane wave, the exact waves of two dimensions with the same "
    "pressure at the head point, stand beside them."
)
WHY = (
    "Slice and sphere agree while nothing has had the time to spread along the axis; later the slice lacks that spreading, in the "
    "fluids and in the walls: what comes back through the system is up to two and a half times as large."
)
MAP = (
    "The slice's error by the source's distance from the axis and the decay of its pulse, ‖slice − sphere‖/‖sphere‖ over time and the "
    "four points together. A run in two dimensions reads its warning from this map."
)
USE = (
    "Within 100 radii a spherical shock asks for three dimensions (dimensions=3), unless only the first transit matters: to t = 1 the "
    "slice errs by a tenth from 5 radii and by 2 % from 20.",
    "From 100 radii on the slice errs by 6 % to 4 transits, and in proportion to 1/distance beyond: two dimensions will do.",
    "Systems differ: the errors of five others were 0.4 to 2 times the map's from 1.5 transits on, and up to 7 times at 1.",
    "A long charge parallel to the axis, fired at once along its length, is a line source: two dimensions solve it exactly.",
    "Slice and line source err alike: where two dimensions will do, the line source is the exact "
    "wave of them. The plane wave errs more near the source (79 % for 63 % from 5 radii) and as little far from it.",
    "What is compared with the paper must be the slice, as its figures are.",
)
CLAIMS_TITLE = "The paper's statements under the sphere"
CLAIMS = (
    "Statements of the paper that mean something under a true sphere, judged by the same criteria from runs that differ in their "
    "dimensions alone: the slice in two, the sphere in three, read in its plane, z = 0; what counts over the surface counts over that "
    "circle. Absorbers are lines along the whole axis, each free at every z. Left out are statements about numbers alone (time step, "
    "orders, masses, the steel rod), limiting cases under a plane wave, which is the same in both, energies and means over areas of fluid, "
    "and those about the number of absorbers but for the adopted 25: each compares 31 to 76 rings, most of more absorbers than three "
    "dimensions resolve within minutes."
)
CLAIM_HEADINGS = ("no.", "statement", "slice, two dimensions", "sphere, three", "found under the slice", "found under the sphere")
VERDICTS: dict[Verdict, str] = {"holds": "hold", "holds in part": "hold in part", "does not hold": "do not"}
"""Verdicts, as they are counted in a sentence."""
PEAK_HEADINGS = ("point", "sphere", "slice", "line source", "plane wave")
DIFFERENCE_HEADINGS = ("point", "slice", "line source", "plane wave")
DISTANCE_HEADINGS = ("distance (outer radii)", "slice", "line source", "plane wave")
PEAK_CAPTION = "Largest hoop stress in MPa, and its instant in transits:"
DIFFERENCE_CAPTION = "Difference of the histories from the sphere's (L2, of the sphere's):"
DISTANCE_CAPTION = f"The same at all four points together by the distance, decay {SHOWN_DECAY:g}, to t = {SHOWN_DURATION:g}:"
CAPTIONS = {
    "slice-or-sphere-histories": "Hoop stress of the paper's bare shells in the plane of the source.",
    "slice-or-sphere-map": "Error of the slice to one and to four transits, and of all three waves of two dimensions over the distance.",
}
