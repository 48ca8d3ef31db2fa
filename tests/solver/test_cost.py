"""What a run costs: the estimate against what runs really take, and the refusal of what does not fit."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.signal  # noqa: F401 - what a run imports late is no part of its arrays

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.export.paraview import export_paraview
from coaxshell.export.tables import export_csv, export_mat
from coaxshell.model import presets
from coaxshell.numerics import memory
from coaxshell.numerics.cost import Cost
from coaxshell.plotting import FieldView, save_film
from coaxshell.plotting.film import film_cost
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import Settings

COARSE = {"duration": 5.0, "time_step": 1e-2, "modes": 60}


def _linked(kinds: int, cubic: float, shells: int = 2) -> cx.System:
    bare = presets.load("bare")
    walls = tuple(bare.shells[-1].replace(radius=0.5 + 0.5 * (i + 1) / shells) for i in range(shells))
    fluids = (bare.fluids[0], *[bare.fluids[1]] * (shells - 1), bare.fluids[-1])
    absorbers = tuple(
        cx.Absorber(
            angle=3.7 * i * i % 360, mass=5.0 + i, damping=1e4, linear_stiffness=1e8, cubic_stiffness=cubic, inner_shell=i % (shells - 1)
        )
        for i in range(kinds)
    )
    return bare.replace(shells=walls, fluids=fluids, absorbers=absorbers)


def _saturated() -> cx.System:
    return presets.load("active").with_overrides({"control.saturation": True})


def _beside_segments(cubic: float) -> cx.System:
    absorbers = cx.absorber_ring(80, mass=1.0, linear_stiffness=1e8, damping=1e4, cubic_stiffness=cubic)
    return presets.load("electrodes").with_overrides({"control.segments": 6}).replace(absorbers=absorbers)


CASES = {
    "bare": (lambda: presets.load("bare"), COARSE),
    "long": (lambda: presets.load("bare"), {**COARSE, "duration": 40.0}),
    "many orders": (lambda: presets.load("bare"), {**COARSE, "modes": 400}),
    "active": (lambda: presets.load("active"), COARSE),
    "hybrid": (lambda: presets.load("hybrid"), COARSE),
    "refined": (lambda: presets.load("hybrid"), {**COARSE, "modes": 30, "refinement": 4}),
    "ring": (lambda: presets.load("bare").replace(absorbers=cx.absorber_ring(40, mass=5.0, linear_stiffness=1e8)), COARSE),
    "uneven": (lambda: _linked(30, 0.0), COARSE),
    "cubic": (lambda: _linked(30, 1e18), COARSE),
    "six shells": (lambda: _linked(36, 1e18, shells=6), {**COARSE, "modes": 30}),
    "saturated": (_saturated, COARSE),
    "points beside segments": (lambda: _beside_segments(0.0), {"duration": 1.0, "time_step": 1e-2, "modes": 30}),
    "springs beside segments": (lambda: _beside_segments(1e16), {"duration": 1.0, "time_step": 1e-2, "modes": 30}),
    "from one side": (lambda: presets.load("bare").with_overrides({"source.angle": 30.0}), COARSE),
    "in space": (lambda: presets.load("bare"), {**COARSE, "modes": 30, "dimensions": 3, "stations": (0.0, 0.5, 1.0)}),
    "direct": (lambda: presets.load("bare"), {**COARSE, "time_step": 4e-3, "engine": "direct"}),
}
QUICK = ("bare", "many orders", "ring", "uneven", "in space", "direct")


@pytest.mark.slow_for("in space")
@pytest.mark.parametrize("name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in CASES])
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_memory_within_a_factor_of_what_a_run_takes(name: str) -> None:
    make, settings = CASES[name]
    system = make()
    expected = run_cost(system, Settings(**settings)).memory
    engine = settings.get("engine", "spectral")
    cx.simulate("bare", duration=0.1, time_step=0.02, modes=5, engine=engine)  # what stays with the process is not the run's
    tracemalloc.start()
    try:
        cx.simulate(system, **settings)
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert taken / 1.5 < expected + 5e6 < 1.5 * (taken + 10e6), f"{expected / 1e6:.0f} MB expected, {taken / 1e6:.0f} MB taken"


def test_time_grows_with_what_is_asked() -> None:
    bare, hybrid = presets.load("bare"), presets.load("hybrid")
    paper = Settings()
    assert 0.2 < run_cost(bare, paper).seconds < 5.0
    assert run_cost(hybrid, paper).seconds > run_cost(bare, paper).seconds
    assert run_cost(bare, Settings(duration=1000.0, modes=2000)).seconds > 600.0


@pytest.mark.parametrize("ask", [cx.simulate, cx.prepare])
def test_what_does_not_fit_is_refused_before_it_is_begun(ask: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(memory.VARIABLE, "5 GB")
    with pytest.raises(InputError, match=r"needs about \d+ GB, and 5 GB are free; use time_step=[\d.e-]+ or duration=\d+") as told:
        ask(presets.load("bare"), duration=1000.0, time_step=1e-3, modes=2000)  # type: ignore[operator]
    assert "1,000,001 instants" in str(told.value)
    assert memory.VARIABLE in str(told.value)


@pytest.mark.parametrize("engine", ["spectral", "direct"])
def test_the_number_of_modes_told_fits(engine: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(memory.VARIABLE, "60 MB")
    bare = presets.load("bare")
    with pytest.raises(InputError) as told:
        cx.simulate(bare, duration=5.0, time_step=1e-2, modes=900, engine=engine)
    modes = int(str(told.value).partition("modes=")[2].split()[0].rstrip(";"))
    assert 20 < modes < 900
    assert run_cost(bare, Settings(5.0, 1e-2, modes, engine)).fits


def test_absorbers_of_a_prepared_structure_count(monkeypatch: pytest.MonkeyPatch) -> None:
    prepared = cx.prepare(presets.load("bare"), duration=2.0, time_step=1e-2, modes=20)
    monkeypatch.setenv(memory.VARIABLE, "20 MB")
    with pytest.raises(InputError, match="needs about"):
        prepared.simulate(_linked(300, 0.0).absorbers)


def test_memory_in_words() -> None:
    assert memory.size_of("12 GB") == 12_000_000_000
    assert memory.size_of("1.5GiB") == 3 * 2**29
    assert memory.available({memory.VARIABLE: "unlimited"}) is None
    for wrong in ("12", "GB", "-1 GB", "1e3 GB", "12 parsecs", "9" * 4000 + "GB"):
        with pytest.raises(InputError, match=memory.VARIABLE):
            memory.available({memory.VARIABLE: wrong})
    assert [memory.words_of(x) for x in (999.7e6, 61.34e9, 250.0, 2e12)] == ["1 GB", "61.3 GB", "250 bytes", "2 TB"]


def test_a_container_s_limit_counts(tmp_path: Path) -> None:
    """What the group of the process and those that hold it leave, pages of files that can be dropped counted as free."""
    (tmp_path / "proc/self").mkdir(parents=True)
    (tmp_path / "proc/meminfo").write_text("MemTotal: 9000000 kB\nMemAvailable: 8000000 kB\n")
    assert memory.available({}, tmp_path) == 8_192_000_000
    (tmp_path / "proc/self/cgroup").write_text("0::/job/step\n")
    step = tmp_path / "sys/fs/cgroup/job/step"
    step.mkdir(parents=True)
    for folder, most, used in ((step, "max", "1000000000"), (step.parent, "3000000000", "1500000000")):
        (folder / "memory.max").write_text(f"{most}\n")
        (folder / "memory.current").write_text(f"{used}\n")
    (step.parent / "memory.stat").write_text("anon 5\ninactive_file 200000000\n")
    assert memory.available({}, tmp_path) == 1_700_000_000
    (tmp_path / "proc/self/cgroup").write_text("4:memory:/old\n3:cpu,cpuacct:/\n")
    old = tmp_path / "sys/fs/cgroup/memory/old"
    old.mkdir(parents=True)
    (old / "memory.limit_in_bytes").write_text("2000000000\n")
    (old / "memory.usage_in_bytes").write_text("500000000\n")
    assert memory.available({}, tmp_path) == 1_500_000_000


def test_costs_add_up() -> None:
    case = Cost(1e9, 10.0)
    assert case.times(8, workers=4).seconds == 20.0
    assert case.times(8, workers=4).memory > 4e9
    assert case.times(8).memory == 1e9
    assert case.then(Cost(3e9, 1.0)) == Cost(3e9, 11.0)
    assert [Cost(0.0, s).duration for s in (40.0, 200.0, 30000.0, 5e5)] == ["40 s", "3.3 min", "8.3 h", "5.8 days"]


@pytest.fixture(scope="module")
def run() -> cx.Response:
    return cx.simulate(presets.load("bare"), duration=2.0, time_step=1e-2, modes=12)


@pytest.mark.parametrize("ask", ["pressure", "velocity", "intensity"])
def test_fields_that_do_not_fit(ask: str, run: cx.Response, monkeypatch: pytest.MonkeyPatch) -> None:
    axis = np.broadcast_to(1.5, 200_000)  # a grid of 4e10 points
    with pytest.raises(InputError, match=rf"memory: the {ask} at 40,000,000,000 points and 2 instants needs about [\d.]+ TB"):
        getattr(run, ask)(x=axis, y=axis, time=[0.5, 1.0])
    monkeypatch.setenv(memory.VARIABLE, "1 MB")
    with pytest.raises(InputError, match="ask for fewer points, or for some instants at a time"):
        getattr(run, ask)(radius=np.linspace(1, 2, 100), angle=np.linspace(0, 90, 100), time=[0.5, 1.0])


def test_energies_and_exports_that_do_not_fit(run: cx.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(memory.VARIABLE, "20 kB")
    with pytest.raises(InputError, match="the energy of 201 instants and orders 0 to 12 needs about"):
        run.energy()
    with pytest.raises(InputError, match="ParaView's series of 101 instants of a run of 201 needs about"):
        export_paraview(run, tmp_path / "series")
    with pytest.raises(InputError, match="a table of 26 columns and 201 rows needs about"):
        export_csv(run, tmp_path / "table.csv")
    with pytest.raises(InputError, match=r"a \.mat file of 201 instants and orders 0 to 12 needs about"):
        export_mat(run, tmp_path / "run.mat")
    with pytest.raises(InputError, match=r"the mean square pressure of orders 0 to 12 at 201 instants needs about .*ask for some instants"):
        run.pressure_rms("gap", time=run.time)
    assert list(tmp_path.iterdir()) == []


def test_what_is_solved_again_for_a_field_is_weighed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    solved = cx.simulate(_linked(4, 1e18), duration=1.0, time_step=2e-2, modes=12, refinement=4)
    kept = cx.Response(replace(solved.solution))  # a copy has no transforms at hand
    monkeypatch.setenv(memory.VARIABLE, "2 MB")
    with pytest.raises(InputError, match=r"a run of 2 shells, orders 0 to 12 and 201 instants needs about"):
        kept.pressure(x=0.0, y=0.5, time=0.5)


def test_films_that_do_not_fit(run: cx.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(memory.VARIABLE, "300 MB")
    with pytest.raises(InputError, match=r"memory: a film of 3 frames of 4,000 x 4,000 pixels needs about .* are free; use fewer pixels"):
        save_film(run, path=tmp_path / "film.webp", frames=3, view=FieldView(3.0, 4000))
    assert list(tmp_path.iterdir()) == []
    small, long = film_cost(1, 100, FieldView()), film_cost(1, 100_000, FieldView())
    assert long.seconds > 300 * small.seconds
    assert long.memory < 1.5 * small.memory  # blocks of frames become smaller where less is free


def test_the_estimate_of_a_matlab_file_is_honest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    long = cx.simulate(presets.load("bare"), duration=5.0, time_step=2e-3, modes=30)
    export_mat(long, tmp_path / "run.mat")
    tracemalloc.start()
    export_mat(long, tmp_path / "run.mat")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    monkeypatch.setenv(memory.VARIABLE, f"{0.66 * peak / 1e6:.6f} MB")
    with pytest.raises(InputError, match="needs about"):
        export_mat(long, tmp_path / "run.mat")
    monkeypatch.setenv(memory.VARIABLE, f"{1.6 * peak / 1e6:.6f} MB")
    export_mat(long, tmp_path / "run.mat")


def test_studies_that_do_not_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(memory.VARIABLE, "600 MB")
    over = {"source.peak_pressure": [1e3, 2e3, 3e3, 4e3, 5e3, 6e3]}
    with pytest.raises(InputError, match=r"a study of 6 cases in 6 processes needs about .* and 600 MB are free; use workers=[123];"):
        cx.sweep(presets.load("bare"), over, workers=6, duration=5.0, time_step=1e-2, modes=60)
