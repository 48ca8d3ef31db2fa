"""
Vibration absorbers
===================

Masses on nonlinear springs and dampers between the shells: how many, and what they do.
"""

import coaxshell as cx
from coaxshell.plotting import figure_comparison, figure_energy

# %%
# One structure, many sets
# ------------------------
#
# Shells, fluids and source are solved once; each set of absorbers then costs only its own march.

bare = cx.presets.load("bare")
prepared = cx.prepare(bare, duration=4.0, time_step=2e-3, modes=80)


def ring(count: int, damping: float = 1e6) -> cx.AbsorberRing:
    return cx.absorber_ring(
        count, mass=10, damping=damping, linear_stiffness=1e9, cubic_stiffness=1e20
    )


responses = {count: prepared.simulate(ring(count)) for count in (0, 5, 25)}
for count, response in responses.items():
    inside, outside = (shell.stress_rms / 1e3 for shell in response.summary().shells)
    print(
        f"{count:2d} absorbers: RMS stress {inside:.1f} kPa inside, {outside:.1f} kPa outside"
    )

# %%
# The system with the last set, drawn:

responses[25].system

# %%
figure_comparison({"25 absorbers": responses[25], "5": responses[5], "none": responses[0]})

# %%
# One by one
# ----------
#
# Absorbers need not be equal, nor mirror symmetric: the sine half of the series is then carried by itself.

three = [
    cx.Absorber(angle=0, mass=20, damping=1e6, linear_stiffness=1e9),
    cx.Absorber(
        angle=100, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20
    ),
    cx.Absorber(
        angle=-130, mass=10, damping=5e5, linear_stiffness=5e8, cubic_stiffness=1e20
    ),
]
uneven = prepared.simulate(three)
uneven

# %%
# Where the energy goes
# ---------------------
#
# What the exterior pressure gives to the outer shell is stored or lost somewhere; the balance closes to the error of the run.

balance = responses[25].energy(every=20)
print(f"closure: {float(abs(balance['closure_relative']).max()):.1e} of the work")
figure_energy(balance)
