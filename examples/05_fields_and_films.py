"""
Fields and films
================

The pressure in every fluid at any instant, particle velocity, and a film.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import coaxshell as cx
from coaxshell.plotting import FieldView, figure_snapshots, save_film

bare = cx.simulate(cx.presets.load("bare"), duration=3.2, time_step=5e-3, modes=80)

# %%
# A sheet of snapshots
# --------------------
#
# All panels share their two scales: pressure in the fluids, hoop stress on the shells. Lengths are in outer radii, the source is to the
# right.

view = FieldView(half_width=2.5, pixels=200)
figure_snapshots(bare, times=[0.5, 1.2, 2.0, 3.1], columns=2, view=view)

# %%
# Numbers
# -------
#
# Any points, any instants, any part of the field; labelled arrays in Pa and m/s.

pressure = bare.pressure(x=[-1.5, 0.0, 1.5], y=[0.0], time=[1.2, 2.0])
print(pressure.round(0).values)
incident = bare.pressure(x=[-1.5, 0.0, 1.5], y=[0.0], time=[1.2, 2.0], part="incident")
velocity = bare.velocity(radius=[0.25], angle=[0, 90, 180], time=[2.0])
print(velocity.dims, velocity.attrs["units"])

# %%
# How loud it is inside, over time:

rms = bare.pressure_rms("interior", time=[0.5, 1.0, 2.0, 3.0])
print([f"{float(value) / 1e3:.2f} kPa" for value in rms])

# %%
# A film
# ------
#
# ``.webp`` needs nothing but the package, ``.mp4`` the extra ``video``. Two responses would be shown side by side.

with TemporaryDirectory() as folder:
    film = save_film(
        bare,
        path=Path(folder) / "bare.webp",
        frames=8,
        fps=4,
        view=FieldView(half_width=2.5, pixels=100),
    )
    print(f"{film.name}: {film.stat().st_size / 1e3:.0f} kB")
