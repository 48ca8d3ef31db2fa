"""
Piezoelectric feedback
======================

Sensor, control law, actuator; what the actuator stands; and gains that would be unstable.
"""

from functools import partial

import coaxshell as cx
from coaxshell.plotting import figure_comparison

# %%
# The paper's controller
# ----------------------
#
# Each shell's sensor feeds its own actuator, u = k_p phi + k_d dphi/dt. Negative gains stiffen and damp.

active = cx.presets.load("active")
simulate = partial(cx.simulate, duration=3.0, time_step=2e-3, modes=80)
free = simulate(active)
for warning in free.warnings:
    print("warning:", warning)

# %%
# What the actuator can really do
# -------------------------------
#
# The linear law asks for up to twice the field that the material stands. With saturation the voltage stops there.

limited = simulate(active.with_overrides({"control.saturation": True}))
voltage = limited.actuator_voltage("outer", angle=range(0, 360, 2))
print(f"largest {float(abs(voltage).max()):.0f} V, limit {voltage.attrs['limit']:.0f} V")

bare = simulate("bare")
figure_comparison({"linear law": free, "saturating": limited, "no control": bare})

# %%
# Gains of the wrong sign
# -----------------------
#
# An unstable loop is refused before anything is computed, with the gain and the order.

try:
    simulate(active.with_overrides({"control.derivative": 500.0}))
except cx.InputError as error:
    print(error)
