"""
An optimisation
===============

Which ring of absorbers spares the inner shell most, within a limit on what it may weigh?
"""

import coaxshell as cx
from coaxshell.plotting.style import COLOURS, new_figure, style

# %%
# The question
# ------------
#
# Variables are fields of the system with a range; the objective and the limits are metrics, the same
# names as in a sweep. A design that is too heavy is not run at all.

found = cx.optimise(
    cx.presets.load("absorbers"),
    variables={
        "absorbers.count": cx.Integer(5, 30),
        "absorbers.damping": cx.Range(1e4, 1e8, scale="log"),
        "absorbers.linear_stiffness": cx.Range(1e7, 1e10, scale="log"),
    },
    objectives="inner.rms_stress",
    constraints=["absorbers.mass <= 250 kg/m"],
    evaluations=60,
    seed=1,
    workers=1,
    duration=2.0,
    time_step=5e-3,
    modes=30,
)
print(found)

# %%
# Sixty runs at a coarse resolution only show the way; ``confirm={"modes": 150}`` would solve the
# best design again at a finer one, and ``journal=`` keeps every run, so that a study that was
# stopped goes on. ``found.save("answer")`` writes the system and the whole history.

found.system

# %%
# How the search went
# -------------------

history = found.to_dataset()
values = history["inner.rms_stress"] / 1e3

with style():
    figure = new_figure(width=6.4, height=3.0)
    ax = figure.subplots()
    kept = history["violation"] == 0
    number = range(1, len(values) + 1)
    ax.plot(
        number,
        values.where(kept),
        "o",
        markersize=3,
        color=COLOURS["sky"],
        label="a design",
    )
    best = [float(values.where(kept)[: n + 1].min()) for n in range(len(values))]
    ax.step(number, best, where="post", color=COLOURS["blue"], label="the best so far")
    ax.set_xlabel("evaluation")
    ax.set_ylabel("RMS stress, inner shell (kPa)")
    ax.legend()
figure
