"""Figures of a response. Every plot function takes ``ax`` and returns it; matplotlib is imported when a figure is made."""

from __future__ import annotations

from coaxshell.plotting.bare_histories import figure_bare_histories
from coaxshell.plotting.comparison import figure_comparison, plot_comparison
from coaxshell.plotting.curves import figure_curves, plot_curves
from coaxshell.plotting.cuts import figure_cuts
from coaxshell.plotting.energy import figure_energy, plot_energy
from coaxshell.plotting.field import plot_field
from coaxshell.plotting.field_scales import PRESSURE_UNITS, check_units
from coaxshell.plotting.film import check_film, save_film
from coaxshell.plotting.film_files import FILM_SUFFIXES
from coaxshell.plotting.fit import figure_fit, plot_fitted_record
from coaxshell.plotting.frames import FieldView
from coaxshell.plotting.frequency_response import (
    figure_directivity,
    figure_frequency_response,
    plot_directivity,
    plot_frequency_response,
)
from coaxshell.plotting.histories import QUANTITIES, PlottedQuantity, mark_peak, plot_history
from coaxshell.plotting.loads import figure_loads
from coaxshell.plotting.margins import figure_margins, plot_bode, plot_delay_margins, plot_nyquist
from coaxshell.plotting.named_curves import CurvePanel, figure_named_curves, plot_named_curves
from coaxshell.plotting.natural_frequencies import figure_natural_frequencies, plot_mode_shape, plot_natural_frequencies
from coaxshell.plotting.optimum import figure_optimum, plot_convergence, plot_front, plot_parallel
from coaxshell.plotting.participation import figure_participation
from coaxshell.plotting.pressure_rms import figure_pressure_rms
from coaxshell.plotting.saving import FIGURE_SUFFIXES, save_figure
from coaxshell.plotting.sensitivity import figure_sensitivity, plot_distribution, plot_sensitivity
from coaxshell.plotting.shock_spectra import figure_shock_spectra, plot_four_coordinates
from coaxshell.plotting.snapshots import COMPARISON_TIMES, SNAPSHOT_TIMES, figure_snapshots
from coaxshell.plotting.strokes import figure_strokes
from coaxshell.plotting.style import COLOURS, style
from coaxshell.plotting.sweep import figure_sweep, plot_sweep
from coaxshell.plotting.unrolled import plot_unrolled
from coaxshell.plotting.wall_film import save_wall_film
from coaxshell.plotting.wall_stress import figure_wall_stress, plot_wall_stress

__all__ = [
    "COLOURS",
    "COMPARISON_TIMES",
    "FIGURE_SUFFIXES",
    "FILM_SUFFIXES",
    "PRESSURE_UNITS",
    "QUANTITIES",
    "SNAPSHOT_TIMES",
    "CurvePanel",
    "FieldView",
    "PlottedQuantity",
    "check_film",
    "check_units",
    "figure_bare_histories",
    "figure_comparison",
    "figure_curves",
    "figure_cuts",
    "figure_directivity",
    "figure_energy",
    "figure_fit",
    "figure_frequency_response",
    "figure_loads",
    "figure_margins",
    "figure_named_curves",
    "figure_natural_frequencies",
    "figure_optimum",
    "figure_participation",
    "figure_pressure_rms",
    "figure_sensitivity",
    "figure_shock_spectra",
    "figure_snapshots",
    "figure_strokes",
    "figure_sweep",
    "figure_wall_stress",
    "mark_peak",
    "plot_bode",
    "plot_comparison",
    "plot_convergence",
    "plot_curves",
    "plot_delay_margins",
    "plot_directivity",
    "plot_distribution",
    "plot_energy",
    "plot_field",
    "plot_fitted_record",
    "plot_four_coordinates",
    "plot_frequency_response",
    "plot_front",
    "plot_history",
    "plot_mode_shape",
    "plot_named_curves",
    "plot_natural_frequencies",
    "plot_nyquist",
    "plot_parallel",
    "plot_sensitivity",
    "plot_sweep",
    "plot_unrolled",
    "plot_wall_stress",
    "save_figure",
    "save_film",
    "save_wall_film",
    "style",
]
