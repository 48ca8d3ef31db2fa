"""One table of what can be read of a shell: the example of CONTRIBUTING.md appears everywhere once it stands there."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest
import quantity_pages
from scipy.io import loadmat

from coaxshell import simulate
from coaxshell.apps.cli import main
from coaxshell.apps.studio.curves import bars, curves
from coaxshell.apps.studio.curves import quantities as listed
from coaxshell.apps.verification.histories_csv import read_histories
from coaxshell.export import export_csv, export_mat, export_paraview
from coaxshell.model import presets
from coaxshell.plotting import QUANTITIES as DRAWN
from coaxshell.response import modal, quantities
from coaxshell.response.quantities import QUANTITIES
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain
from coaxshell.studies.metrics import metric_names, metrics_of
from coaxshell.studies.reading import MetricSource

GUIDE = Path(__file__).parents[2] / "CONTRIBUTING.md"


@pytest.fixture(scope="module")
def response():
    return simulate(presets.load("bare"), duration=1.0, time_step=0.02, modes=12)


@pytest.fixture
def example(monkeypatch):
    """Return the guide's entry, in the table for as long as a test lasts."""
    code = re.search(r"```python\n(def hoop_strain_gain.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL).group(1)
    names = {"np": np, "ModalSolution": ModalSolution, "Gain": Gain, "orders": modal.orders, "Quantity": quantities.Quantity}
    exec(code, names)
    entry = names["HOOP_STRAIN"]
    monkeypatch.setitem(QUANTITIES, entry.name, entry)
    return entry


def test_histories_and_amplitudes(response, example):
    strain = response.history("inner", [0, 40], example.name)
    assert (strain.attrs["units"], strain.attrs["sign"]) == ("1", "positive in tension")
    w, v = response.modal("inner").to_numpy()[0], response.modal("inner", "tangential").to_numpy()[0]
    m, radius = np.arange(len(w))[:, None], response.system.shells[0].radius
    expected = ((m * v - w) / radius * np.cos(m * np.radians(40))).sum(axis=0)
    np.testing.assert_allclose(strain.to_numpy()[:, 1], expected, rtol=1e-9, atol=1e-18)
    np.testing.assert_allclose(response.modal("inner", example.name).to_numpy().sum(axis=1)[0], strain.to_numpy()[:, 0], rtol=0, atol=1e-18)


def test_summary_metrics_and_figures(response, example, capsys, tmp_path):
    shell = response.summary().shells[0]
    assert "hoop strain" in str(response.summary())
    assert response.summary().to_dict()["shells"][0]["hoop_strain"]["value"] == shell.hoop_strain.value > 0
    assert "inner.peak_hoop_strain_head" in metric_names(response.system)
    (metric,) = metrics_of(["inner.peak_hoop_strain"], response.system)
    assert metric(MetricSource(response)) == shell.hoop_strain.value
    assert (metric.units, metric.long_name) == ("1", "largest hoop strain anywhere, inner shell")
    assert DRAWN["hoop_strain"].label == "hoop strain (10⁻⁶)"
    assert response.plot("hoop_strain").axes[0].get_ylabel() == "hoop strain (10⁻⁶)"
    saved = response.save(tmp_path / "run.nc")
    assert main(["plot", str(saved), "--quantity", "hoop-strain", "--output", str(tmp_path / "a.png")]) == 0
    assert main(["info", "--json", str(saved)]) == 0
    assert '"hoop_strain": "1"' in capsys.readouterr().out


def test_files_comparisons_studio_and_page(response, example, tmp_path):
    table = export_csv(response, tmp_path / "run.csv")
    with table.open(encoding="utf-8") as file:
        assert "inner hoop strain head (1)" in next(csv.reader(file))
    found = {(column.quantity, column.shell, column.place) for column in read_histories(table).columns}
    assert ("hoop_strain", "inner", "head") in found
    assert loadmat(export_mat(response, tmp_path / "run.mat"), simplify_cells=True)["shells"][0]["hoop_strain"].shape == (51, 2)
    export_paraview(response, tmp_path / "series", times=[0.5], points=5)
    assert 'Name="hoop_strain"' in next((tmp_path / "series" / "data").glob("*.vtp")).read_bytes().decode("latin-1")
    assert listed()["hoop_strain"] == ("hoop strain", "1")
    assert bars()["hoop_strain"] == ("peak hoop strain anywhere", "1")
    assert "hoop_strain/0" in {one["name"] for one in curves(response, 0.0).header["arrays"]}
    assert "| `hoop_strain` | hoop strain of the mid-surface | 1 | in tension |" in quantity_pages.quantity_table()


@pytest.mark.parametrize(
    "name", [name for name, entry in QUANTITIES.items() if entry.gain and "voltage" not in name and entry.dimensions == 2]
)
def test_every_entry_reads_as_its_amplitudes(response, name):
    half = response.modal("outer", name).to_numpy()[0]
    m = np.arange(len(half))[:, None]
    wave = np.cos if QUANTITIES[name].component == "normal" else np.sin
    expected = (half * wave(m * np.radians(70.0))).sum(axis=0)
    np.testing.assert_allclose(response.history("outer", 70.0, name), expected, rtol=1e-9, atol=1e-10 * np.abs(half).max())
