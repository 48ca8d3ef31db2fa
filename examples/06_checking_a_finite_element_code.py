"""
Checking a finite-element code against us
=========================================

Another code's histories on the same axes as ours, with errors: how the file looks, and what the comparison catches.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import coaxshell as cx
from coaxshell.apps.verification.against import against
from coaxshell.plotting.style import COLOURS, new_figure, style

# %%
# The file
# --------
#
# ``coaxshell verify --template my_fem.csv --case iakovlev-double`` writes one to start from. It is a table with a time column, in
# transits or seconds, and columns named after quantity, shell and place, each with its unit. Here a coarse run by the direct engine
# plays the other code.

system = cx.presets.load("iakovlev-double")
other = cx.simulate(system, duration=2.0, time_step=4e-3, modes=20, engine="direct")
columns = {
    "time [ms]": other.time_seconds * 1e3,
    "stress_outer_head [MPa]": other.stress("outer", angle=0).values / 1e6,
    # finite elements count the displacement outward: the sign is wrong here on purpose
    "displacement_outer_tail [um]": -other.displacement("outer", angle=180).values * 1e6,
}
text = "\n".join(
    [
        ", ".join(columns),
        *(
            ", ".join(f"{value:.8g}" for value in row)
            for row in zip(*columns.values(), strict=True)
        ),
    ]
)
print("\n".join(text.splitlines()[:4]))

# %%
# The comparison
# --------------
#
# In a terminal it is ``coaxshell verify --against my_fem.csv --case iakovlev-double``, which also writes a report with plots and
# leaves with exit code 1 unless all errors are within the tolerance, 0.05 unless ``--tolerance`` says otherwise.

with TemporaryDirectory() as folder:
    file = Path(folder) / "my_fem.csv"
    file.write_text(text)
    report = against(file, system, time_step=2e-3, modes=60)

for row in report.rows:
    print(f"{row.error:7.2g}  {row.what:38s} {row.found}")

# %%
# The report's plots, here the first:

ours = cx.simulate(system, duration=2.0, time_step=2e-3, modes=60)
with style():
    figure = new_figure(width=6.4, height=3.0)
    ax = figure.subplots()
    ax.plot(
        ours.time,
        ours.stress("outer", angle=0) / 1e6,
        color=COLOURS["blue"],
        label="coaxshell",
    )
    ax.plot(
        other.time,
        other.stress("outer", angle=0) / 1e6,
        "--",
        color=COLOURS["orange"],
        label="the other code",
    )
    ax.set_xlabel("time (acoustic transits $a/c_e$)")
    ax.set_ylabel("stress, outer shell, head (MPa)")
    ax.legend()
figure

# %%
# The reversed sign is named; what is left of the stress is the error of the coarse run. The usual suspects are on the page
# "Conventions against other codes": the sign of w, the unit and the zero of time, the depth at which stress is taken.
