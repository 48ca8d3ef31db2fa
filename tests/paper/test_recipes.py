"""The registry, Figures 2 and 12, the shared structure, and the command."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.cli import main
from coaxshell.apps.paper import FIGURES, Runs, StudyRecipe, figure_recipe, solve_each
from coaxshell.apps.paper.cases import count, gains, power
from coaxshell.apps.paper.histories import named_warnings, plain
from coaxshell.apps.paper.limiting_cases import rigid_pressure
from coaxshell.errors import InputError
from coaxshell.studies import structures

SMALL = ["--duration", "1.5", "--time-step", "2e-2", "--modes", "8"]


def test_every_figure_of_results_is_there_with_its_caption():
    assert list(FIGURES) == [str(number) for number in range(2, 15)]
    for recipe in FIGURES.values():
        assert recipe.caption.endswith(".")
        assert set(recipe.presets) <= set(cx.presets.names())
    with pytest.raises(InputError, match="allowed: 2, 3"):
        figure_recipe("15")


def test_figure_12_shows_four_systems_at_four_points(tiny, line):
    recipe = figure_recipe("12")
    responses = [cx.simulate(cx.presets.load(name), **asdict(tiny)) for name in recipe.presets]
    axes = recipe.draw(responses, None).axes
    points = [("inner", 0), ("inner", 180), ("outer", 0), ("outer", 180)]
    for ax, (shell, angle) in zip(axes, points, strict=True):
        for name, response in zip(recipe.presets, responses, strict=True):
            np.testing.assert_array_equal(line(ax, name), 1e-6 * np.asarray(response.stress(shell, angle=[angle]))[:, 0])


def test_figure_2(drawn, direct, line):
    axes = drawn("2").figure.axes
    assert [ax.get_title(loc="left")[0] for ax in axes] == list("abccde")
    evacuated, filled, double = (cx.presets.load(name) for name in figure_recipe("2").presets)
    thick = filled.replace_path("shells[0].layers[0].thickness", 0.02)
    for ax, name, system, shell, angle, thickness in (
        (axes[1], "head", evacuated, "outer", 0, 0.01),
        (axes[1], "tail", evacuated, "outer", 180, 0.01),
        (axes[2], "20 mm", thick, "outer", 0, 0.02),
        (axes[3], "20 mm", thick, "outer", 180, 0.02),
        (axes[4], "inner tail", double, "inner", 180, 0.01),
    ):
        np.testing.assert_allclose(line(ax, name), 1e-6 * direct(system, shell, angle, "displacement") / thickness, rtol=0, atol=1e-16)
    np.testing.assert_allclose(line(axes[5], "outer head"), direct(double, "outer", 0), rtol=1e-12)


def test_the_pressure_on_a_rigid_surface_starts_doubled_and_follows_the_library_afterwards(tiny):
    system = cx.presets.load("iakovlev-evacuated")
    fine = replace(tiny, time_step=2e-3, duration=2.0)
    time, values = rigid_pressure(system, fine, 150, [0.0, 90.0])
    assert values[:, 0].max() == pytest.approx(2.0, rel=0.05)
    assert abs(values[time < 0.9, 1]).max() < 2e-3
    rigid = cx.System(shells=[cx.RigidShell(radius=1.0)], fluids=[cx.VACUUM, system.exterior], source=system.sources[0])
    exact = cx.simulate(rigid, duration=2.0, time_step=2e-3, modes=150)
    pressure = np.asarray(exact.pressure(radius=[1.0], angle=[0.0, 90.0], time=[0.5, 1.8]))[:, 0, :] / system.sources[0].peak_pressure
    np.testing.assert_allclose(values[[250, 900]], pressure, rtol=0, atol=5e-3)  # the library's series rings by 4e-3


def test_a_wave_without_a_peak_pressure_is_refused(tiny):
    system = cx.presets.load("iakovlev-evacuated").replace(source=cx.PlaneWave(pulse=cx.Step(pressure=1e3)))
    with pytest.raises(InputError, match="peak pressure"):
        rigid_pressure(system, tiny, 4, [0.0])


def test_structures_are_prepared_once(monkeypatch, tiny):
    made = []
    monkeypatch.setattr(structures, "prepare", lambda *a, **k: made.append(a) or cx.prepare(*a, **k))
    bare = cx.presets.load("bare")
    assert [name for name, _ in solve_each(count(bare, (0, 2, 3)), tiny)] == ["0", "2", "3"]
    assert len(made) == 1
    steps = []
    list(solve_each(gains(bare), tiny, lambda fraction, stage: steps.append(fraction)))
    assert len(made) == 1  # without absorbers there is nothing to prepare for
    assert steps == [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]


def test_the_direct_engine_solves_a_study_too():
    from coaxshell.solver.settings import Settings

    resolution = Settings(duration=0.5, time_step=4e-3, modes=6, engine="direct")
    bare = cx.presets.load("bare")
    ((_, response),) = solve_each({"bare": bare}, resolution)
    assert response.engine == "direct"
    np.testing.assert_array_equal(response.stress("outer"), cx.simulate(bare, **asdict(resolution)).stress("outer"))


@pytest.mark.parametrize("number", ["5", "8", "9"])
def test_a_system_that_does_not_fit_is_refused(tiny, number):
    bare = cx.presets.load("bare")
    for system in (bare.replace(shells=[cx.RigidShell(radius=0.5), bare.shells[1]]), cx.presets.load("iakovlev-filled")):
        with pytest.raises(InputError):
            figure_recipe(number).draw([system], Runs(tiny), None)


def test_numbers_as_text():
    assert power(-2e4) == r"$-2 \times 10^{4}$"
    assert power(1e9) == "$10^{9}$"
    assert power(-150) == "−150"
    assert plain(r"$k_\mathrm{p}$ = $-2 \times 10^{4}$") == "k_p = -2e4"


def test_warnings_name_their_run(drawn):
    assert any(text.startswith("k_p = -2e4, k_d = −150: outer shell") for text in drawn("11").warnings)


@pytest.mark.slow_for("8", "10", "11", "2")
@pytest.mark.parametrize("number", [n for n, recipe in FIGURES.items() if isinstance(recipe, StudyRecipe) and n != "9"] + ["12"])
@pytest.mark.filterwarnings("ignore")
def test_the_command_writes_every_figure(monkeypatch, tmp_path, number):
    monkeypatch.chdir(tmp_path)
    assert main(["figure", number, *SMALL, "--quiet"]) == 0
    assert [path.name for path in tmp_path.iterdir()] == [f"figure-{number}.png"]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [(["--from", "x.nc"], "--from"), (["--modes", "0"], "--modes"), (["--preset", "bare", "--preset", "bare"], "2 given")],
    ids=lambda value: " ".join(value) if isinstance(value, list) else value,
)
def test_the_command_refuses_what_a_study_cannot_use(capsys, monkeypatch, tmp_path, arguments, word):
    monkeypatch.chdir(tmp_path)
    assert main(["figure", "5", *arguments, "--quiet"]) != 0
    assert word in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_equal_warnings_are_told_once():
    told = [("N = 0", "too coarse"), ("N = 1", "too coarse"), ("N = 1", "too stiff")]
    assert named_warnings(told) == ("N = 0 and 1 more: too coarse", "N = 1: too stiff")
