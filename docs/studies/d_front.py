"""The front between the inner shell's peak stress and the added mass: 40 limits of the mass, each searched by gradients from the last.

25 absorbers, every one free in mass, damping, both stiffnesses and angle, mirror images alike. Run: python d_front.py FOLDER
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

import coaxshell as cx

LIMITS = np.geomspace(2.0, 1000.0, 40)
SEARCH = {"modes": 60, "time_step": 4e-3, "duration": 5.0}
VARIABLES = {
    "absorbers[*].mass": cx.Range(0.01, 60.0, each="mirror"),
    "absorbers[*].damping": cx.Range(1e4, 1e8, scale="log", each="mirror"),
    "absorbers[*].linear_stiffness": cx.Range(1e6, 1e11, scale="log", each="mirror"),
    "absorbers[*].cubic_stiffness": cx.Range(1e14, 1e22, scale="log", each="mirror"),
    "absorbers[*].angle": cx.Range(-180.0, 360.0, each="mirror"),
}


def main(folder: Path) -> None:
    """Search, from the largest mass to the smallest, and write ``front.csv`` and the systems."""
    folder.mkdir(exist_ok=True)
    system = cx.System.from_toml(Path(__file__).parent / "results" / "b-25-free" / "best.toml")
    rows = []
    for limit in LIMITS[::-1]:
        listed = system.absorber_list
        total = sum(one.mass for one in listed)
        scaled = min(1.0, 0.999 * limit / total)
        system = system.replace(absorbers=[one.replace(mass=max(0.0101, scaled * one.mass)) for one in listed])
        found = cx.optimise(
            system,
            variables=VARIABLES,
            objectives="inner.peak_stress",
            constraints=[f"absorbers.mass <= {limit:.6g} kg/m", "absorbers.spacing >= 50 mm"],
            method="gradient",
            population=1,
            evaluations=9,
            workers=1,
            **SEARCH,
        )
        if found.feasible:
            system = found.system.replace(name=f"at most {limit:.4g} kg/m")
        values = found.best.targets
        rows.append((limit, values["absorbers.mass"], values["inner.peak_stress"], found.feasible))
        sys.stdout.write(f"{rows[-1]}\n")
        with (folder / "front.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["limit (kg/m)", "mass (kg/m)", "inner.peak_stress (Pa)", "feasible"])
            writer.writerows(rows[::-1])


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "d-front"))
