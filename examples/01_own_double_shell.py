"""
A double shell of your own
==========================

Two layered shells in water, described, solved and read: the whole way once, in a few lines.
"""

import coaxshell as cx

# %%
# Materials and fluids
# --------------------
#
# A material is its constants, in SI or as texts with a unit. The library has more, :data:`coaxshell.materials` and
# :data:`coaxshell.fluids`, each with its source.

aluminium = cx.Elastic(
    name="aluminium", density=2700, youngs_modulus="70 GPa", poisson_ratio=0.33
)
water = cx.Fluid(density=1000, sound_speed=1400)
layers = [
    cx.Layer(cx.materials.PZT4, "3 mm", role="sensor"),
    cx.Layer(aluminium, "6 mm"),
    cx.Layer(cx.materials.PZT4, "3 mm", role="actuator"),
]

# %%
# The system
# ----------
#
# Shells and fluids are listed from the inside out. In a notebook a system draws itself, to scale.

system = cx.System(
    name="my double shell",
    shells=[cx.Shell(radius=0.5, layers=layers), cx.Shell(radius=1.0, layers=layers)],
    fluids=[water, water, water],
    source=cx.SphericalShock(distance=5.0, peak_pressure="25 kPa", decay_time="0.1314 ms"),
)
system

# %%
# A mistake is answered by what is wrong, where, and what is allowed.

try:
    cx.Shell(radius="50 kg", layers=layers)
except cx.InputError as error:
    print(error)

# %%
# Solving
# -------
#
# ``duration`` and ``time_step`` count acoustic transits a/c of the outer radius in the outer fluid, 0.714 ms here. The summary
# ends with the errors that the run estimates of itself.

response = cx.simulate(system, duration=5.0, time_step=2e-3, modes=100)
print(response.summary())

# %%
# Reading
# -------
#
# Histories are labelled arrays (xarray) in SI. Angles are in degrees from the source: 0 is the head, 180 the tail.

stress = response.stress("inner", angle=[0, 180])
print(stress.dims, stress.attrs["units"], float(abs(stress).max()))

# %%
# And seeing it:

from coaxshell.plotting import figure_comparison

figure_comparison({"my double shell": response})

# %%
# Changing one thing
# ------------------
#
# Systems do not change; a changed copy is a line. Here the outer core is twice as thick.

thick = system.with_overrides({"shells.outer.layers[1].thickness": "12 mm"})
thicker = cx.simulate(thick, duration=5.0, time_step=2e-3, modes=100)
figure_comparison({"12 mm outside": thicker, "6 mm": response})

# %%
# A system goes to a scenario file and back without loss, for the command line or for a colleague.

again = cx.System.from_toml_string(system.to_toml_string())
print(again == system)
print(system.to_toml_string()[:300])
