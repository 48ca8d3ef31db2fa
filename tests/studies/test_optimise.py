"""Optimisations of real systems at a small resolution: repeatable, resumable, whole answers."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.cli.entry import main
from coaxshell.studies.optimisation.variables import space_of
from coaxshell.studies.reading import DesignReading

VARIABLES = {"absorbers.mass": cx.Range("1 kg", "10 kg"), "absorbers.damping": cx.Range(1e4, 1e8, "log")}
STUDY = """
scenario = "absorbers"
objectives = ["inner.peak_stress"]
constraints = ["absorbers.mass <= 200 kg/m"]
evaluations = 24
seed = 3
[variables]
"absorbers.mass" = { from = "1 kg", to = "10 kg" }
"absorbers.damping" = { from = 1e4, to = 1e8, scale = "log" }
[resolution]
duration = 1.0
time_step = 0.02
modes = 6
[confirm]
modes = 12
"""


def searched(quick, **more):
    arguments = {"variables": VARIABLES, "objectives": "inner.peak_stress", "evaluations": 24, "workers": 1, **quick, **more}
    return cx.optimise(cx.presets.load("absorbers"), **arguments)


def test_the_answer_is_a_system_ready_to_run_with_the_value_told(quick, tmp_path):
    found = searched(quick, constraints="absorbers.mass <= 200 kg/m", confirm={"modes": 12})
    folder = found.save(tmp_path / "answer")
    system = cx.System.from_toml(folder / "best.toml")
    again = cx.simulate(system, **quick).summary()
    assert_allclose(again.shells[0].stress.value, found.best.targets["inner.peak_stress"], rtol=1e-9)
    assert sum(absorber.mass for absorber in system.absorber_list) <= 200.0
    assert found.best.objectives[0] <= min(one.objectives[0] for one in found.history if one.feasible)
    told = json.loads((folder / "optimum.json").read_text())
    assert told["best"]["targets"] == found.best.targets
    modes, steps = zip(*((one.resolution.modes, one.resolution.time_step) for one in found.confirmations), strict=True)
    assert modes == (12, 12)
    assert steps == (0.02, 0.01)
    finer = cx.simulate(found.system, **{**quick, "modes": 12}).summary()
    assert_allclose(found.confirmations[0].best["inner.peak_stress"], finer.shells[0].stress.value, rtol=1e-9)
    assert "absorbers.mass" in str(found)
    dataset = found.to_dataset()
    assert dataset["inner.peak_stress"].attrs["units"] == "Pa"
    assert_allclose(dataset["absorbers.mass (target)"], 25 * dataset["absorbers.mass"], rtol=1e-12)


@pytest.mark.slow
def test_one_worker_and_two_go_the_same_way(quick):
    one, two = (searched(quick, workers=workers).history for workers in (1, 2))
    assert one == two


def test_gains_share_a_structure_and_keep_their_numbers(quick):
    system = cx.presets.load("hybrid").replace_path("control.saturation", True)
    variables = {"control.proportional": cx.Range(-2e4, 0), "absorbers.mass": cx.Range(1, 10)}
    found = cx.optimise(system, variables=variables, objectives="inner.peak_stress", evaluations=8, workers=1, **quick)
    again = cx.simulate(found.system, **quick).summary()
    assert again.shells[0].stress.value == found.best.targets["inner.peak_stress"]


def test_a_larger_budget_goes_on_with_the_same_journal(quick, tmp_path):
    searched(quick, journal=tmp_path / "kept")
    longer = searched(quick, journal=tmp_path / "kept", resume=True, evaluations=40)
    assert longer.history == searched(quick, evaluations=40).history


def test_ctrl_c_keeps_the_best_so_far(quick):
    def impatient(fraction, stage):
        if fraction >= 0.5:
            raise KeyboardInterrupt

    found = searched(quick, progress=impatient)
    assert not found.complete
    assert 12 <= len(found.history) < 24
    assert found.system.absorbers.count == 25
    assert "interrupted" in str(found)


@pytest.mark.slow
def test_a_study_killed_and_resumed_equals_one_that_was_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY)
    asked = ["optimise", "study.toml", "--quiet", "--workers", "1"]
    command = [sys.executable, "-m", "coaxshell", *asked]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    kept = tmp_path / "study.journal"
    for least in (6, 12):
        resume = ["--resume"] if kept.exists() else []
        victim = subprocess.Popen([*command, *resume], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while victim.poll() is None and len(list(kept.glob("*.json"))) < least:
            time.sleep(0.005)
        victim.send_signal(signal.SIGKILL)
        assert victim.wait() == -signal.SIGKILL
        assert not (tmp_path / "study.optimum").exists()
    assert main([*asked, "--resume"]) == 0
    assert main([*asked, "--output", "whole"]) == 0
    for name in ("history.csv", "optimum.json", "best.toml"):
        assert (tmp_path / "study.optimum" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert not kept.exists()


def test_the_command_writes_answer_and_figure(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY.replace("evaluations = 24", "evaluations = 12"))
    assert main(["optimise", "study.toml", "--workers", "1", "--figure", "seen.png"]) == 0
    told = capsys.readouterr()
    assert "12 evaluations by cma-es" in told.out
    assert "best inner.peak_stress" in told.err
    assert (tmp_path / "seen.png").stat().st_size > 10_000
    assert main(["run", "study.optimum/best.toml", "--quiet", "--modes", "6", "--time-step", "0.02", "--duration", "1"]) == 0
    assert main(["optimise", "study.toml", "--workers", "1", "--quiet"]) == 2
    assert "'study.optimum' exists already" in capsys.readouterr().err
    assert main(["optimise", "study.toml", "--workers", "1", "--quiet", "--force"]) == 0


@pytest.mark.slow
def test_two_objectives_from_a_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = STUDY.replace('["inner.peak_stress"]', '["inner.peak_stress", { metric = "absorbers.dissipated_energy", maximise = true }]')
    (tmp_path / "study.toml").write_text(text.replace("evaluations = 24", "evaluations = 24\npopulation = 8"))
    assert main(["optimise", "study.toml", "--workers", "1", "--quiet", "--figure", "seen.svg"]) == 0
    told = json.loads((tmp_path / "study.optimum" / "optimum.json").read_text())
    assert told["method"] == "nsga2"
    assert len(told["front"]) == len(list((tmp_path / "study.optimum" / "front").glob("*.toml"))) >= 1
    assert "on the front" in capsys.readouterr().out


def test_mirror_images_keep_the_layout_symmetric():
    base = cx.presets.load("absorbers").replace_path("absorbers.count", 6)
    variables = {"absorbers[*].mass": cx.Range(1, 20, each="mirror"), "absorbers[*].angle": cx.Range(5, 175, each="mirror")}
    space = space_of(base, variables)
    assert [variable.name for variable in space.variables[:4]] == [f"absorbers[{i}].mass" for i in range(4)]
    system = space.system(space.values(np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])))
    masses = [absorber.mass for absorber in system.absorber_list]
    angles = [absorber.angle for absorber in system.absorber_list]
    assert masses[1] == masses[5]
    assert masses[2] == masses[4]
    assert len(set(masses)) == 4
    assert_allclose(angles[5], -angles[1], rtol=1e-12)
    assert angles[0] == 0.0
    assert angles[3] == 180.0


def test_one_name_for_several_fields_and_a_log_scale_below_zero():
    base = cx.presets.load("hybrid")
    space = space_of(base, {"gain": cx.Range(-1e5, -1e1, "log", paths=("control.proportional", "control.derivative"))})
    system = space.system(space.values(np.array([0.5])))
    assert_allclose([system.control.proportional, system.control.derivative], -1e3, rtol=1e-12)
    assert_allclose(space.variables[0].share(-1e3), 0.5, rtol=1e-12)


def test_spacing_is_the_smallest_arc_on_the_inner_shell():
    base = cx.presets.load("absorbers")
    assert_allclose(DesignReading(base).absorber_spacing, 2 * np.pi * 0.5 / 25, rtol=1e-12)
    pair = [cx.Absorber(angle=350, mass=1), cx.Absorber(angle=20, mass=1), cx.Absorber(angle=180, mass=1)]
    assert_allclose(DesignReading(base.replace(absorbers=pair)).absorber_spacing, 0.5 * np.radians(30), rtol=1e-12)
    inner, outer = base.shells  # one past a shell stands in both gaps
    crossing = [cx.Absorber(mass=1, inner_shell=1, angle=10), cx.Absorber(mass=1, outer_shell=2, angle=50), cx.Absorber(mass=1, angle=200)]
    three = base.replace(shells=[inner, inner.replace(radius=0.75), outer], fluids=[base.exterior] * 4, absorbers=crossing)
    assert_allclose(DesignReading(three).absorber_spacing, 0.75 * np.radians(40), rtol=1e-12)


BAD = {
    "unknown path": ('"absorbers.mass" =', '"absorbers.mas" =', "variables.absorbers.mas"),
    "empty range": ('from = "1 kg", to = "10 kg"', 'from = "10 kg", to = "1 kg"', "is empty"),
    "wrong unit": ('"10 kg"', '"10 Pa"', "variables.absorbers.mass.to"),
    "one end": ('from = "1 kg", to = "10 kg"', 'from = "1 kg"', "needs both from and to"),
    "unknown entry of a variable": ('to = "10 kg"', 'to = "10 kg", steps = 3', "variables.absorbers.mass.steps"),
    "logarithm of zero": ("from = 1e4,", "from = 0,", "has no logarithm"),
    "unknown scale": ('scale = "log"', 'scale = "square"', 'must be "linear" or "log"'),
    "unknown metric": ("inner.peak_stress", "inner.peak_strain", "is not a known metric"),
    "no objective": ('["inner.peak_stress"]', "[]", "objectives: there are none"),
    "objective without a metric": ('["inner.peak_stress"]', "[{ maximise = true }]", "objectives[0].metric: is missing"),
    "maximise in words": (
        '["inner.peak_stress"]',
        '[{ metric = "inner.mass", maximise = "no" }]',
        "objectives[0].maximise: 'no' is not allowed",
    ),
    "objective twice": ('["inner.peak_stress"]', '["inner.mass", "inner.mass"]', "objectives: 'inner.mass' is given twice"),
    "constraint without a limit": ("absorbers.mass <= 200 kg/m", "absorbers.mass", 'write "METRIC <= LIMIT"'),
    "constraint of an unknown metric": ("absorbers.mass <= 200", "absorbers.weight <= 200", "constraints[0]"),
    "constraint in a wrong unit": ("200 kg/m", "200 kPa", "is not a mass per metre"),
    "impossible mass": ("200 kg/m", "20 kg/m", "the smallest within the ranges is 25 kg/m"),
    "impossible spacing": ("absorbers.mass <= 200 kg/m", "absorbers.spacing >= 20 cm", "the largest within the ranges is 0.125664 m"),
    "negative limit": ("absorbers.mass <= 200 kg/m", "inner.peak_stress <= -1 MPa", "is never below 0"),
    "infeasible start": ("seed = 3", 'seed = 3\nstart = "system"', "breaks absorbers.mass <= 200 kg/m with 250"),
    "start outside": ('to = "10 kg"', 'to = "9 kg"', "is not within 1 to 9"),
    "unknown method": ("seed = 3", 'seed = 3\nmethod = "simplex"', "allowed: auto, cma-es"),
    "method for one objective": (
        '["inner.peak_stress"]',
        '["inner.peak_stress", "outer.peak_stress"]\nmethod = "cma-es"',
        "takes one objective",
    ),
    "no evaluations": ("evaluations = 24", "evaluations = 0", "evaluations: 0 is not allowed"),
    "statistic of nothing uncertain": ("inner.peak_stress", "p95(inner.peak_stress)", "uncertain: is missing"),
    "no such setting": ("[confirm]\nmodes", "[confirm]\nmode", "confirm.mode"),
    "setting not allowed": ("[confirm]\nmodes = 12", "[confirm]\nmodes = -1", "confirm.modes"),
    "unknown entry": ("seed = 3", "sead = 3", "seed"),
    "unknown scenario": ('"absorbers"\nobj', '"absorber"\nobj', "scenario"),
    "varied twice": (
        '"absorbers.mass" =',
        'x = { from = 1, to = 2, paths = ["absorbers.damping"] }\n"absorbers.mass" =',
        "is varied twice",
    ),
    "one of each": ('to = "10 kg"', 'to = "10 kg", each = "mirror"', "has no meaning for one field"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_study_files_are_told_in_one_line(tmp_path, monkeypatch, capsys, case):
    old, new, expected = BAD[case]
    assert old in STUDY
    text = STUDY.replace(old, new)
    if case == "start outside":
        text = text.replace("seed = 3", 'seed = 3\nstart = "system"')
    (tmp_path / "study.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    assert main(["optimise", "study.toml", "--quiet", "--workers", "1"]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert expected in told
    assert "Traceback" not in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["study.toml"]


def test_the_journal_of_another_study_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    short = STUDY.replace("evaluations = 24", "evaluations = 8")
    (tmp_path / "study.toml").write_text(short)
    assert main(["optimise", "study.toml", "--quiet", "--workers", "1", "--journal", "kept"]) == 0
    assert main(["optimise", "study.toml", "--quiet", "--workers", "1", "--journal", "kept", "--force"]) == 2
    assert "use resume (--resume)" in capsys.readouterr().err
    (tmp_path / "study.toml").write_text(short.replace("200 kg/m", "199 kg/m"))
    assert main(["optimise", "study.toml", "--quiet", "--workers", "1", "--journal", "kept", "--resume"]) == 2
    assert "its constraints differ" in capsys.readouterr().err


def test_a_foreign_folder_is_not_overwritten(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").write_text("dear")
    assert main(["optimise", "study.toml", "--quiet", "--output", "mine"]) == 2
    assert "holds something else than a result" in capsys.readouterr().err
    assert (tmp_path / "mine" / "letter.txt").read_text() == "dear"


def test_functions_of_the_users_and_absorbers_without_their_image(quick):
    def tip(response):
        return float(abs(response.displacement("inner", angle=0.0)).max())

    found = searched(quick, objectives=tip, evaluations=6)
    assert found.targets.goals[0].target.name == "tip"
    lonely = cx.presets.load("absorbers").replace(absorbers=[cx.Absorber(angle=30, mass=5, damping=1e5)])
    with pytest.raises(cx.InputError, match="has no mirror image about 0 deg"):
        cx.optimise(lonely, variables={"absorbers[*].mass": cx.Range(1, 2, each="mirror")}, objectives="inner.peak_stress", **quick)
