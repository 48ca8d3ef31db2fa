"""
A single shell in water
=======================

An evacuated steel shell under a plane shock, one of the classical cases, and what water inside changes.
"""

import coaxshell as cx
from coaxshell.plotting import figure_comparison

# %%
# The vacuum is exact
# -------------------
#
# ``"vacuum"`` is a fluid without pressure, not one of a very small density. The preset is the paper's verification case after
# Iakovlev (2008).

empty = cx.presets.load("iakovlev-evacuated")
empty

# %%
# The same shell with water inside, and with air:

filled = empty.replace(name="water inside", fluids=["water-1400", "water-1400"])
airy = empty.replace(name="air inside", fluids=["air", "water-1400"])
responses = {
    system.name: cx.simulate(system, duration=5.0, time_step=5e-3, modes=60)
    for system in (filled, airy, empty.replace(name="vacuum inside"))
}
figure_comparison(responses)

# %%
# Air makes no difference that could be seen, water takes a good part of the stress.
#
# A check by hand
# ---------------
#
# Under a shock without decay the shell is carried along: its late velocity is 2/(1 + M/M_d) times that of the water in the wave,
# M the shell's mass and M_d that of the water it displaces (see the end of the theory manual).

step = empty.replace(source=cx.PlaneWave(pulse=cx.Step(pressure="1 kPa")))
late = cx.simulate(step, duration=40.0, time_step=2e-2, modes=8)

inward = late.displacement("outer", angle=[0, 180])
translation = (
    inward.sel(angle=0) - inward.sel(angle=180)
) / 2  # along the wave, away from the source
speed = float(translation[-1] - translation[-501]) / float(
    translation.time_seconds[-1] - translation.time_seconds[-501]
)
particle = 1e3 / (1000 * 1400)

shell, water = empty.shells[0], empty.exterior
assert isinstance(shell, cx.Shell)  # and not a rigid one
mass = (
    2
    * 3.141592653589793
    * shell.radius
    * sum(layer.material.density * layer.thickness for layer in shell.layers)
)
displaced = 3.141592653589793 * shell.radius**2 * water.density
print(
    f"late velocity over the wave's: {speed / particle:.4f}, by hand {2 / (1 + mass / displaced):.4f}"
)
