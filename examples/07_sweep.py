"""
A sweep
=======

How many absorbers, and how much damping? A grid of cases, read by names, resumable.
"""

from functools import partial
from tempfile import TemporaryDirectory

import coaxshell as cx
from coaxshell.plotting.style import COLOURS, new_figure, style

# %%
# The question
# ------------
#
# Any field of the system can vary, named by its dotted path; what is read of each case is a metric, by name or a function of the
# response. Cases that differ only in their absorbers share everything else, which is solved once.

system = cx.presets.load("absorbers")
damping = [0, 1e5, 1e6]
sweep = partial(
    cx.sweep,
    system,
    over={"absorbers.count": [0, 5, 10, 15, 20, 25, 30], "absorbers.damping": damping},
    metrics=["inner.rms_stress", "outer.rms_stress"],
    duration=3.0,
    time_step=4e-3,
    modes=50,
    workers=1,
)

# %%
# With ``store`` every finished case is kept in a folder: killed at any moment, the sweep goes on with ``resume=True``. By default each core
# works in a process of its own; ``workers=1`` stays in this one.

with TemporaryDirectory() as folder:
    table = sweep(store=f"{folder}/ring")
    again = sweep(store=f"{folder}/ring", resume=True)
print(table.equals(again))

# %%
# The answer
# ----------
#
# A labelled dataset, units in its attributes: select, plot, save.

inner = table["inner.rms_stress"]
print(inner.attrs["long_name"], inner.attrs["units"])
print((inner / 1e3).round(2).to_pandas())

# %%

with style():
    figure = new_figure(width=6.4, height=3.2)
    ax = figure.subplots()
    for value, colour in zip(damping, ("blue", "orange", "green"), strict=True):
        one = inner.sel({"absorbers.damping": value})
        ax.plot(
            one["absorbers.count"],
            one / 1e3,
            marker="o",
            color=COLOURS[colour],
            label=f"damping {value:g} N s/m$^2$",
        )
    ax.set_xlabel("number of absorbers")
    ax.set_ylabel("RMS stress, inner shell (kPa)")
    ax.legend()
figure
