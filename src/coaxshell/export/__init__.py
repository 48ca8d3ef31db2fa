"""Results for other programs: ParaView, spreadsheets (CSV) and MATLAB. Every file and folder appears whole or not at all."""

from __future__ import annotations

from coaxshell.export.frequency_response import export_frequency_response_csv
from coaxshell.export.natural_frequencies import export_natural_frequencies_csv
from coaxshell.export.paraview import check_grid, export_paraview
from coaxshell.export.spectra import export_spectra_csv
from coaxshell.export.tables import export_csv, export_mat, history_table

__all__ = [
    "check_grid",
    "export_csv",
    "export_frequency_response_csv",
    "export_mat",
    "export_natural_frequencies_csv",
    "export_paraview",
    "export_spectra_csv",
    "history_table",
]
