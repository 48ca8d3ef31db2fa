"""Pictures of single runs and of pairs of them: histories, fields and films."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from saving import save, save_beside

import coaxshell as cx
from coaxshell import plotting
from coaxshell.plotting import FieldView
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

SPATIAL = {"modes": 60, "time_step": 4e-3, "duration": 3.0, "dimensions": 3}
"""The run in three dimensions that cuts, sheets and films show."""


@cache
def plane(preset: str) -> cx.Response:
    """Return a preset's run in two dimensions, kept for the pictures that share it."""
    return cx.simulate(preset)


@cache
def spatial() -> cx.Response:
    """Return the bare double shell under the sphere at stations as far as its films go."""
    return cx.simulate("bare", stations=list(np.linspace(0.0, 3.0, 31)), **SPATIAL)


def hybrid_stress(target: Path) -> None:
    """Hoop stress at head and tail, hybrid against bare."""
    save(plotting.figure_comparison({"hybrid": plane("hybrid"), "bare": plane("bare")}), target, dpi=167)


def hybrid_fields(target: Path) -> None:
    """Pressure around bare and protected shells at two instants."""
    responses = plane("bare"), plane("hybrid")
    view = FieldView(3.0, pixels=300)
    figure = plotting.figure_snapshots(*responses, times=[1.2, 2.0], columns=2, names=("Bare", "Hybrid"), view=view)
    save(figure, target, width=1200, shades=5)


def coatings(target: Path) -> None:
    """Hoop stress of both shells without a coat, with one of solid and with one of cellular rubber."""
    coated = cx.presets.load("coated")
    inner, outer = coated.shells
    *wall, coat = inner.layers
    cells = coat.replace(material=coat.material.replace(poisson_ratio=0.45))
    walls = {
        "no coat": inner.replace(radius=0.5, layers=wall),
        "30 mm of solid rubber": inner,
        "30 mm of cellular rubber": inner.replace(layers=[*wall, cells]),
    }
    looks = (("black", "-"), (COLOURS["blue"], "-"), (COLOURS["orange"], "--"))
    with style():
        figure = new_figure(PAGE_WIDTH, 5.4)
        axes = figure.subplots(2, 1, sharex=True)
        for (name, one), (colour, dash) in zip(walls.items(), looks, strict=True):
            response = cx.simulate(coated.replace(shells=[one, outer]), duration=4.0, time_step=4e-3, modes=60)
            for ax, shell, angle in ((axes[0], "inner", 180.0), (axes[1], "outer", 90.0)):
                stress = response.stress(shell, angle=angle)
                ax.plot(stress["time"], 1e-3 * stress, color=colour, linestyle=dash, label=name)
                ax.set_title(f"{shell} shell, {angle:.0f}°", loc="left")
                ax.set_ylabel("hoop stress of the core (kPa)")
        axes[0].legend()
        axes[1].set_xlabel("time (acoustic transits $a/c_e$)")
        axes[1].set_xlim(0.0, 4.0)
    save(figure, target, dpi=146)


def sphere_slice(target: Path) -> None:
    """Hoop stress under the sphere against that of its slice."""
    run = {"modes": 60, "time_step": 4e-3, "duration": 4.0}
    sphere = cx.simulate("bare", dimensions=3, stations=[0.0], **run)
    save(plotting.figure_comparison({"sphere": sphere, "slice": cx.simulate("bare", **run)}), target, dpi=167)


def cuts(target: Path) -> None:
    """Pressure across the axis and along it."""
    save(plotting.figure_cuts(spatial(), 1.6, view=FieldView(3.0, pixels=300)), target, width=720)


def wall(target: Path) -> None:
    """The outer shell laid flat."""
    save(plotting.plot_unrolled(spatial(), "outer", 1.6).figure, target, width=480)


def snapshots(target: Path) -> None:
    """Both cuts at three instants."""
    figure = plotting.figure_snapshots(spatial(), times=[0.6, 1.4, 2.2], view=FieldView(2.5, pixels=300), station=0.0)
    save(figure, target, width=1600, shades=5)


def film(target: Path) -> None:
    """Both cuts as a film."""
    plotting.save_film(spatial(), path=target, frames=30, fps=10.0, view=FieldView(2.5, pixels=240))  # smaller ones have no axes


def wall_film(target: Path) -> None:
    """The outer shell laid flat as a film."""
    plotting.save_wall_film(spatial(), "outer", path=target, frames=40, fps=12.0, size=450)


def shock_spectra(target: Path) -> None:
    """Shock spectra of both shells, hybrid and bare."""
    run = {"modes": 60, "time_step": 4e-3}
    responses = {"hybrid": cx.simulate("hybrid", **run), "bare": cx.simulate("bare", **run)}
    save(plotting.figure_shock_spectra(responses), target, dpi=200)


def participation(target: Path) -> None:
    """Natural modes that carry the largest stress of the inner shell."""
    response = cx.simulate("bare", modes=24, time_step=1e-2)
    save(plotting.figure_participation(response.participation("inner", "stress", order=range(7))), target, dpi=200)


def natural_frequencies(target: Path) -> None:
    """Wet and dry natural frequencies by order."""
    save(plotting.figure_natural_frequencies(cx.natural_frequencies("bare", order=range(13))), target, dpi=150)


def dispersion(target: Path) -> None:
    """Natural frequencies of orders 0 to 3 over the axial wavenumber."""
    wavenumbers = list(np.geomspace(0.2, 30.0, 37))
    found = cx.natural_frequencies("bare", order=range(4), axial_wavenumber=wavenumbers, up_to=1500.0)
    save(plotting.figure_natural_frequencies(found), target, dpi=150)


def frequency_response(target: Path) -> None:
    """The echo of an empty steel shell in water beside that of a rigid one, and all around it."""
    wall = [cx.Layer(cx.materials.STRUCTURAL_STEEL, 0.01)]
    source = cx.PlaneShock(peak_pressure=1e3, decay_time="1 ms")
    shell = cx.System(shells=[cx.Shell(radius=1.0, layers=wall)], fluids=[cx.VACUUM, cx.fluids.FRESHWATER], source=source)
    rigid = shell.replace(shells=[cx.RigidShell(radius=1.0)])
    hertz = np.linspace(40.0, 3000.0, 1500)
    marks = cx.natural_frequencies(shell, range(9), up_to=3000.0)
    around = cx.frequency_response(shell, [300.0, 1000.0, 3000.0], "target_strength", angle=range(361))
    echoes = {name: cx.frequency_response(one, hertz, "target_strength") for name, one in (("steel shell", shell), ("rigid", rigid))}
    save_beside([plotting.figure_frequency_response(echoes, marks), plotting.figure_directivity(around)], target, width=1400)


def identify(target: Path) -> None:
    """Four invented records and the run that was fitted to them: the example of the page."""
    page = (Path(__file__).parents[1] / "howto" / "identify.md").read_text(encoding="utf-8")
    names: dict[str, object] = {}
    exec(page.split("```python\n")[1].split("```")[0].replace("print(found)", ""), names)
    save(plotting.figure_fit(names["found"]), target, dpi=110)
