"""What the report says, whatever it is written in."""

from __future__ import annotations

TITLE = "Thin or exact walls?"
SHOWN_DURATION = 4.0
"""Transits, to which the map is drawn."""

ABOUT = (
    "The paper's walls are thin: straight normals, no stress across the wall, fluids that meet it at its mid-surface. Exact walls are "
    'layers of elastic solids wetted at their faces (theory = "elastic"). Between both stand thin walls wetted at their faces '
    '(wetted = "faces"). The paper\'s bare shells under a plane wave of its decay, their layers as they are (12 mm), twice and four times '
    "as thick:"
)
WHY = (
    "Three things part thin walls from exact ones. A mid-surface is wetted half a thickness too far in, and a gap too wide: most of the "
    "inner shell's difference, which wetted faces take away. Straight normals and the wall's own thickness waves: the part that grows with "
    "the thickness. And a wall with fluid on both sides has the pressure across it, which Poisson's ratio turns into hoop stress and thin "
    "theory leaves out: a difference of the histories that does not fall with the thickness. Of the paper's shells made of aluminium alone "
    "thin walls wetted at their faces leave 6 to 9 % at h/R = 0.002 as at 0.012 of the outer shell; with a Poisson's ratio of 0 they leave "
    "0.06 and 0.5 %. Peaks and displacements feel little of all this."
)
MAP = (
    "The error of thin walls by thickness over radius and the decay of the pulse, ‖thin − exact‖/‖exact‖ of the hoop stress in the "
    "middle of the core over time, head and tail together, to t = {duration:g}; plane wave. The inner wall of the paper's pair is as thick "
    "as the outer at half the radius. A run in two dimensions reads its warning from this map, by whether a wall is dry inside, within "
    "others, or the outermost with fluid on both sides; other systems' errors were {low:.1f} to {high:.1f} times the map's."
)
FIT = (
    "A product of powers of h/R, of the decay and of the time in transits, by a constant, holds the map from h/R = {thinnest:g} and up to "
    "decays of {decay:g} transits, within the factor in the last column:"
)
USE = (
    "With wetted = \"faces\" the largest hoop stress of the paper's walls is within 5 % of exact walls' up to 48 mm, and "
    "displacements within 2 %: for these thin walls will do.",
    'Histories of the stress of walls with water on both sides, and any walls from h/R = 0.05 on, ask for theory = "elastic", which takes '
    "two to three and a half times as long.",
    "Walls that are dry inside (a hull full of air) err by up to twice h/R under a pulse of 0.2 transits and by less than h/R under one of "
    "2 or more.",
    "What is compared with the paper must be thin and wetted at its mid-surface, as its figures are.",
)
ERROR_CAPTION = "Difference of the hoop stress from exact walls', in the middle of the core (L2 over time, of the exact walls'):"
PEAK_CAPTION = "Largest hoop stress over that of exact walls:"
MOTION_CAPTION = "Difference of the normal displacement from exact walls':"
CLAIMS_TITLE = "The paper's statements with exact walls"
CLAIMS = (
    "Statements of the paper about its bare shells, their histories and the waves around them, and about its absorbers, under its own "
    "source, judged by the same criteria from runs that differ in their walls alone; pressures beside a wall are those where fluids wet "
    "it, and absorbers hold thin walls along lines, exact ones over arcs as long as these are thick. Of {count} statements {turned}."
)
CLAIM_HEADINGS = ("no.", "statement", "thin", "exact", "found with thin walls", "found with exact walls")
FIT_HEADINGS = ("wall", "wetted at", "constant", "power of h/R", "of the decay", "of the time", "within a factor")
WALL_NAMES = {"dry": "dry inside", "inner": "the paper's inner", "outer": "the paper's outer"}
WETTED_NAMES = {"mid-surface": "mid-surfaces", "faces": "faces"}
CAPTIONS = {
    "thin-or-exact-histories": "Hoop stress at head and tail of the paper's shells, 12 mm thick, under a plane wave: thin and exact walls.",
    "thin-or-exact-map": "Error of the hoop stress of thin walls (%) over thickness and decay, wetted at mid-surfaces (above), at faces.",
}
