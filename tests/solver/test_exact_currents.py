"""Limits of current on walls of elastic solids: the linear answer, open circuits of the walls themselves, thin walls, energy, order."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.electrical import of_segments
from coaxshell.structure.lossy_solid import LossySolidWall

PAIRS = cx.presets.load("electrodes")
LAW: dict[str, Any] = {"proportional": 0.0, "derivative": 2.0, "transducers": "electrodes"}
SOURCE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
RUN: dict[str, Any] = {"duration": 0.6, "time_step": 2e-2, "modes": 6}


def system(theory: Any = "elastic", scale: float = 1.0, roles: tuple[str, str] | None = None, **control: Any) -> cx.System:
    """Return pairs of electrodes on walls of a theory, all layers *scale* times as thick, ceramics without printed slips."""
    shells = []
    for shell, kind in zip(PAIRS.shells, (theory, theory) if isinstance(theory, str) else theory, strict=True):
        assert isinstance(shell, cx.Shell)
        layers = [layer.replace(thickness=scale * layer.thickness) for layer in shell.layers]
        for place, role in zip((0, 2), roles or ("self-sensing", "self-sensing"), strict=True):
            ceramic = layers[place].material.replace(permittivity_reduction="standard")
            layers[place] = layers[place].replace(material=ceramic, role=role)
        shells.append(shell.replace(layers=layers, theory=kind, **({"wetted": "faces"} if kind == "thin" else {})))
    return PAIRS.replace(shells=shells, source=SOURCE, control=cx.PDControl(**{**LAW, **control}))


def limited(limit: str | float = 3.0, stops: bool = True) -> dict[str, Any]:
    return {"segments": 6, "current_limit": limit, "current_saturation": stops}


@cache
def run(theory: tuple[str, str] | str = "elastic", scale: float = 1.0, limit: float = 3.0, stops: bool = True) -> cx.Response:
    return cx.simulate(system(theory, scale, **limited(limit, stops)), **RUN)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def test_what_reaches_no_limit_is_the_linear_answer_and_what_just_does_is_close_to_it() -> None:
    linear = run(stops=False)
    asked, free = max(one.current or 0.0 for one in linear.control_effort().shells), linear.solution.normal
    np.testing.assert_array_equal(run(limit=1.001 * asked).solution.normal, free)
    assert 0.0 < apart(run(limit=0.999 * asked).solution.normal, free) < 1e-5
    assert apart(run().solution.normal, free) > 2e-3


def test_no_current_is_the_open_circuit_that_the_walls_close_themselves() -> None:
    """A sensor beside a grounded layer charges itself at every point, within the wall; segments of no current do as they get short."""
    opened = cx.simulate(system(roles=("sensor", "actuator"), proportional=0.0, derivative=1e-9), **{**RUN, "modes": 10})
    control: dict[str, Any] = {"segments": 10, "current_saturation": True}
    held = [
        cx.simulate(system(roles=("self-sensing", "passive"), **control, current_limit=limit), **{**RUN, "modes": 10}).solution
        for limit in ("0.1 mA/m^2", "1 kA/m^2")
    ]
    none, free = (apart(one.normal[:, :, 1:3], opened.solution.normal[:, :, 1:3]) for one in held)
    assert none < 3e-4
    assert free > 40.0 * none


def test_limits_tend_to_those_of_thin_walls() -> None:
    errors = [apart(run("elastic", scale).solution.normal, run("thin", scale).solution.normal) for scale in (1.0, 0.25)]
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] > 3.0


@pytest.mark.parametrize("kind", ["elastic", "mixed", "lossy"])
def test_energies_close_where_currents_are_held(kind: str, tmp_path: Any) -> None:
    found = run(("thin", "elastic") if kind == "mixed" else "elastic")
    if kind == "lossy":
        described = system(**limited()).with_overrides({"shells[0].layers[1].material.loss_factor": 0.02})
        found = cx.simulate(described, **{**RUN, "duration": 0.4})
        assert isinstance(found.solution.problem.shells[0], LossySolidWall)
    energy = found.energy(every=5)
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - energy.actuator_field + energy.actuator_work
    assert np.abs(electrical).max() < 1e-9 * np.abs(energy.amplifier_work).max()
    told = sum("the current was held at 3.000 A/m^2" in text for text in found.warnings)
    assert told == (1 if kind == "lossy" else 2)  # in so short a run the front has hardly reached the inner shell: 0.03 A/m^2
    if kind == "elastic":
        kept = cx.load_response(found.save(tmp_path / "run.nc"))
        np.testing.assert_allclose(kept.solution.normal, found.solution.normal, rtol=1e-9, atol=1e-12)


def test_each_segment_takes_what_its_amplifier_lets_through() -> None:
    """Its charge, summed from strokes and voltages of the run, grows by the limit where it is held, but for what the band rounds off."""
    found = run(limit=1.0)
    effort, cut = found.control_effort()["outer"], of_segments(found.motion, 1)
    assert cut is not None
    assert effort.current == 1.0
    assert len(effort.segments) == 6
    steps = np.abs(np.diff(cut.charge[0])) / (RUN["time_step"] * found.solution.problem.scales.time)
    assert np.sum(np.abs(steps - 1.0) < 0.05) >= 10
    assert np.sum(steps > 1.05) == 2


def test_steps_converge() -> None:
    runs = [run().solution.normal]
    for step, every in ((0.01, 2), (0.005, 4)):
        runs.append(cx.simulate(system(**limited()), **{**RUN, "time_step": step}).solution.normal[..., ::every])
    first, second = (apart(a, b) for a, b in pairwise(runs))
    assert first < 1e-3
    assert first / second > 2.0


def test_a_limit_judges_what_is_asked_for_as_on_thin_walls() -> None:
    found, thin = (run(theory, 0.25, stops=False) for theory in ("elastic", "thin"))
    efforts = [one.control_effort()["outer"].current for one in (found, thin)]
    assert efforts[0] == pytest.approx(efforts[1], rel=0.05)
    assert any("times the 3.000 A/m^2 of its amplifier; set control.current_saturation = true" in text for text in found.warnings)
