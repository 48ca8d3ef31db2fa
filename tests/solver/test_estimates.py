"""The engine's own error estimates, and the number of modes chosen by them, against many more modes."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.synthesis import mean_square
from coaxshell.solver import estimates
from coaxshell.solver.interface import seen

STEP = {"duration": 3.0, "time_step": 2e-3}
MANY = 600


@pytest.fixture(scope="module", params=["bare", "iakovlev-evacuated", "iakovlev-double"])
def case(request: pytest.FixtureRequest) -> tuple[cx.System, cx.Response]:
    system = cx.presets.load(request.param)
    return system, cx.simulate(system, **STEP, modes=MANY)


def stress_error(response: cx.Response, many: cx.Response, shell: int) -> float:
    """Return the relative L2 error over surface and time of the stress that comes from leaving out orders above M."""
    full = np.asarray(many.modal(shell, "stress"))
    left_out = full.copy()
    left_out[:, : response.modes + 1] = 0.0
    return float(np.sqrt(mean_square(left_out).sum() / mean_square(full).sum()))


@pytest.mark.slow_for("bare-40")
@pytest.mark.parametrize("modes", [40, 120])
def test_truncation_is_estimated_within_a_factor(case: tuple[cx.System, cx.Response], modes: int) -> None:
    system, many = case
    response = cx.simulate(system, **STEP, modes=modes)
    for shell in range(response.shells):
        true = stress_error(response, many, shell)
        assert 0.5 < response.estimates.modal_stress[shell] / true < 6  # it aims at twice the true one


@pytest.mark.parametrize("tolerance", [3e-2, 3e-3])
def test_auto_modes_meet_the_tolerance(case: tuple[cx.System, cx.Response], tolerance: float) -> None:
    system, many = case
    response = cx.simulate(system, **STEP, modes="auto", tolerance=tolerance)
    assert 8 <= response.modes < MANY
    errors = [stress_error(response, many, shell) for shell in range(response.shells)]
    assert max(errors) < 1.3 * tolerance
    assert max(errors) > tolerance / 5  # nor far too many


def test_modes_are_independent_of_how_many_there_are(case: tuple[cx.System, cx.Response]) -> None:
    system, many = case
    few = cx.simulate(system, **STEP, modes=30).solution.normal
    expected = many.solution.normal[:, :, :31]
    np.testing.assert_allclose(few, expected, rtol=0, atol=1e-9 * abs(expected).max())


SETTINGS = {"duration": 2.0, "time_step": 1e-2, "modes": 16}
GAP = cx.System(
    shells=[cx.Shell(radius=radius, layers=[cx.Layer("aluminium", 6e-3)]) for radius in (0.5, 1.0)],
    fluids=["vacuum", "vacuum", "water-1400"],
    source=cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=2e-5)),
    absorbers=cx.absorber_ring(5, mass=10, damping=1e4, linear_stiffness=1e9),
)


def motions(response: cx.Response, every: int = 1) -> np.ndarray:
    """Return displacement and strain, shape (shells, 2, parities, M + 1, T)."""
    w, v = (x[..., ::every] for x in (response.solution.normal, response.solution.tangential))
    return np.stack([w, np.arange(w.shape[2])[:, None] * v - w], axis=1)


def true_error(found: cx.Response, fine: cx.Response, every: int = 1) -> np.ndarray:
    """Return |found - fine|/|fine| over surface and time, shape (shells, 2)."""
    expected = motions(fine, every)
    actual = np.zeros_like(expected)
    actual[..., : found.modes + 1, :] = motions(found)
    weight = np.where(np.arange(expected.shape[3]) == 0, 1.0, 0.5)[:, None]
    squares = [(weight * x**2).sum(axis=(2, 3, 4)) for x in (actual - expected, expected)]
    return np.sqrt(squares[0] / squares[1])


def within(printed: np.ndarray, true: np.ndarray, least: float, most: float) -> None:
    assert np.all(printed > least * true)
    assert np.all(printed < most * true)


def test_what_absorbers_excite_counts() -> None:
    # Behind a vacuum nothing else moves the inner shell: its orders above M, and the softness of both walls that they make.
    coarse, many = (cx.simulate(GAP, **{**SETTINGS, "modes": modes}) for modes in (64, 300))
    within(coarse.estimates.orders, true_error(coarse, many), 0.5, 20)
    assert coarse.estimates.orders.min() > 1e-3


def test_auto_modes_count_absorbers() -> None:
    chosen, bare = (
        cx.prepare(system, **{**SETTINGS, "modes": "auto"}, tolerance=2e-2).settings.modes for system in (GAP, GAP.replace(absorbers=()))
    )
    assert chosen > 2 * bare
    found = cx.simulate(GAP, **{**SETTINGS, "modes": chosen})
    assert true_error(found, cx.simulate(GAP, **{**SETTINGS, "modes": 400}))[:, 1].max() < 2e-2


@pytest.mark.parametrize("preset", ["bare", "iakovlev-double"])
def test_the_band_limit_is_estimated_within_a_factor(preset: str) -> None:
    system = cx.presets.load(preset)
    coarse, fine = (cx.simulate(system, **{**SETTINGS, "time_step": step}) for step in (1e-2, 1e-3))
    within(coarse.estimates.time_step, true_error(coarse, fine, 10), 0.5, 20)
    assert np.all(coarse.estimates.march == 0)


@pytest.mark.parametrize("width", [1e-5, 1.1e-5, 1.2e-5, 1.3e-5])
def test_the_band_limit_of_spectra_that_fall_off_steeply_is_not_overrated(width: float) -> None:
    """What a Gaussian pulse leaves below the top of the band says little of what is above: 26 to 140 times the true error was printed."""
    one = GAP.replace(absorbers=(), shells=GAP.shells[1:], fluids=["vacuum", "water-1400"])
    system = one.replace(source=cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=width)))
    coarse, fine = (cx.simulate(system, **{**SETTINGS, "time_step": step}) for step in (1e-2, 2.5e-3))
    within(coarse.estimates.time_step, true_error(coarse, fine, 4), 1.0, 12)


def test_the_march_is_estimated_within_a_factor() -> None:
    ring = cx.absorber_ring(3, mass=10, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e20)
    system = cx.presets.load("bare").replace(absorbers=ring)
    coarse, fine = (cx.simulate(system, **{**SETTINGS, "time_step": step}) for step in (1e-2, 1e-3))
    within(coarse.estimates.march, true_error(coarse, fine, 10), 0.5, 20)


@pytest.mark.parametrize("angle", [45.0, 90.0, -163.0])
def test_turned_sources_print_the_same_errors(angle: float) -> None:
    cubic = GAP.absorbers.replace(cubic_stiffness=1e20)
    turned = [
        GAP.replace(source=GAP.source.replace(angle=by), absorbers=cubic.replace(offset=by), fluids=["vacuum", "water-1400", "water-1400"])
        for by in (0.0, angle)
    ]
    straight, other = (cx.simulate(system, **SETTINGS).estimates.by_cause() for system in turned)
    np.testing.assert_allclose(other, straight, rtol=0.02)  # the phases of what is left out are drawn for each absorber carried
    alone = [cx.simulate(system.replace(absorbers=()), **SETTINGS).estimates.by_cause() for system in turned]
    np.testing.assert_allclose(alone[1], alone[0], rtol=1e-6)


def test_a_shell_not_yet_reached_is_at_rest() -> None:
    system = cx.presets.load("bare")
    errors = cx.simulate(system, duration=0.3, time_step=1e-2, modes=16).estimates.by_cause()
    assert errors[0, :, 0].max() < 2 * errors[1, :, 0].max()
    assert errors[0].max() < 1


def test_errors_are_one_labelled_array() -> None:
    response = cx.simulate(GAP, **SETTINGS)
    errors = response.errors()
    assert errors.dims == ("shell", "quantity", "cause")
    assert list(errors["cause"].values) == ["orders", "time step", "march", "combined"]
    np.testing.assert_array_equal(errors.sel(cause="combined"), errors.sel(cause=["orders", "time step", "march"]).sum("cause"))
    shown = response.summary().shells[0].errors
    assert shown["stress"]["orders"] == float(errors.sel(shell="inner", quantity="stress", cause="orders"))
    assert f"{shown['stress']['combined']:.1e}" in str(response.summary())


def test_a_rigid_shell_has_no_errors() -> None:
    core = GAP.replace(shells=[cx.RigidShell(radius=0.5), GAP.shells[1]], absorbers=())
    errors = cx.simulate(core, **SETTINGS).errors()
    assert np.isnan(errors[0]).all()
    assert np.isfinite(errors[1]).all()


def test_each_cause_warns_with_both_numbers_and_the_remedy() -> None:
    ring = GAP.absorbers.replace(cubic_stiffness=1e20)
    system = GAP.replace(absorbers=ring, source=cx.PlaneWave(pulse=cx.Step(pressure=1e6)))
    response = cx.simulate(system, duration=2.0, time_step=4e-2, modes=8)
    warnings = " ".join(response.warnings)
    errors = response.errors()
    for cause, remedy in (("orders", "modes=16"), ("time step", "time_step = 0.02"), ("march", "refinement = 2")):
        worst = float(errors.sel(cause=cause).max())
        assert f"by {worst:.2g}" in warnings
        assert remedy in warnings


def test_the_direct_engine_says_what_it_does_not_know() -> None:
    response = cx.simulate(GAP, duration=1.0, time_step=5e-3, modes=12, engine="direct", refinement=4)
    errors = response.errors()
    assert np.isfinite(errors.sel(cause="orders")).all()
    assert np.isnan(errors.sel(cause="combined")).all()
    assert response.summary().shells[0].errors["stress"]["time step"] is None
    assert "unknown" in str(response.summary())


@pytest.mark.slow_for("False-100000.0", "True-100000.0")
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
@pytest.mark.parametrize("limit", [2e4, 1e5, 6e5])
@pytest.mark.parametrize("plane", [False, True])
def test_orders_left_out_count_where_actuators_saturate(limit: float, plane: bool) -> None:
    """Their harmonics, and what the orders above ask for beside: without, the printed error was up to 2000 times too small."""
    active = cx.presets.load("active")
    pulse = cx.Gaussian(peak_pressure=1e5, width=1.5e-4)
    system = active.replace(
        source=cx.PlaneWave(pulse=pulse) if plane else active.source,
        control=active.control.replace(saturation=True, field_limit=limit),
    )
    coarse, many = (cx.simulate(system, **{**SETTINGS, "modes": modes}) for modes in (10, 60))
    within(coarse.estimates.orders, true_error(coarse, many), 0.1, 50)


@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_a_limit_out_of_reach_changes_nothing() -> None:
    active = cx.presets.load("active")
    high = active.replace(control=active.control.replace(saturation=True, field_limit=1e12))
    linear, limited = (cx.simulate(system, **SETTINGS).estimates.orders for system in (active, high))
    np.testing.assert_allclose(limited, linear, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_the_march_of_a_lightly_damped_shell_is_not_told_from_steps_that_have_lost_its_phase() -> None:
    """At four times the step its membranes, which the step hardly resolves, ring out of phase: a fifth of that is less than the error."""
    coating = 5e-4
    layers = [cx.Layer("pzt-4", coating, role="sensor"), cx.Layer("aluminium", 2e-3), cx.Layer("pzt-4", coating, role="actuator")]
    system = cx.System(
        shells=[cx.Shell(radius=0.2, layers=layers)],
        fluids=["vacuum", "air"],
        source=cx.PlaneWave(pulse=cx.Exponential(peak_pressure=1e3, decay_time=2e-4)),
        control=cx.PDControl(proportional=-2e3, derivative=-2.0, saturation=True, field_limit=1e5),
    )
    step = 0.02
    coarse, fine = (cx.simulate(system, duration=800 * step, time_step=one, modes=10) for one in (step, step / 4))
    printed = coarse.estimates.by_cause()[..., 1:].sum(axis=-1)
    within(printed, true_error(coarse, fine, 4), 0.8, 20)
    assert true_error(coarse, fine, 4).max() > 0.5


@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_weights_of_membranes_that_the_step_does_not_resolve_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """They are the same at all longer steps, and stiff dampers feel them: against a march with those of all other orders."""
    ring = cx.absorber_ring(3, mass=10, damping=1e8, linear_stiffness=1e7, cubic_stiffness=1e17)
    system = GAP.replace(fluids=["vacuum", "water-1400", "water-1400"], absorbers=ring)
    settings = {"duration": 2.0, "time_step": 2e-2, "modes": 20}
    told = []
    membrane_error = estimates.membrane_error
    monkeypatch.setattr(estimates, "membrane_error", lambda *given: told.append(membrane_error(*given)) or told[-1])
    found = cx.simulate(system, **settings)
    march = found.estimates.march
    assert told[0].max() > 1e-4
    monkeypatch.setattr(seen, "unresolved_orders", lambda problem, grid, modes: np.zeros(modes.count, bool))
    without = cx.simulate(system, **settings)
    within(told[0], true_error(without, found), 0.8, 1.3)
    assert np.all(march > 1.9 * told[0])


def test_auto_says_when_saturating_actuators_leave_more_than_the_tolerance() -> None:
    active = cx.presets.load("active")
    limited = active.replace(control=active.control.replace(saturation=True, field_limit=1e5))
    auto = {"duration": 1.0, "time_step": 2e-2, "modes": "auto", "tolerance": 1e-2}
    linear, found = (cx.simulate(system, **auto) for system in (active, limited))
    assert found.modes == linear.modes
    missed = [text for text in found.warnings if text.startswith('modes="auto" chose')]
    assert f"{float(found.estimates.modal_stress.max()):.2g}" in missed[0]
    assert "0.01; what saturating actuators change" in missed[0]
    assert f"modes={2 * found.modes}" in missed[0]
    assert not any(text.startswith('modes="auto"') for text in linear.warnings)
    assert not any('or modes="auto"' in text for text in found.warnings)
