"""The direct engine against the spectral one: two solution paths that share the model and the fluids' operators only."""

import numpy as np
import pytest

import coaxshell as cx

MODES, DURATION = 24, 2.0
STEPS = (8e-3, 4e-3, 2e-3)

BARE = cx.presets.load("bare")
CASES = {
    "bare": BARE,
    "plane step": BARE.replace(source=cx.PlaneWave(pulse=cx.Step(pressure=1e4))),
    "line source": BARE.replace(source=cx.LineShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)),
    "gaussian off axis": BARE.replace(source=cx.SphericalWave(distance=3.0, angle=40.0, pulse=cx.Gaussian(peak_pressure=1e4, width=1e-4))),
    "absorbers": cx.presets.load("absorbers"),
    "unequal absorbers off axis": BARE.replace(
        absorbers=[
            cx.Absorber(angle=20.0, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e21),
            cx.Absorber(angle=-70.0, mass=30, damping=1e5, linear_stiffness=3e9, cubic_stiffness=0.0),
        ]
    ),
    "massless absorber": BARE.replace(absorbers=cx.absorber_ring(3, mass=0, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20)),
    "active": cx.presets.load("active"),
    "saturated": BARE.replace(control=cx.PDControl(proportional=-2e4, derivative=-150, saturation=True)),
    "hybrid": cx.presets.load("hybrid"),
    "evacuated single shell": cx.presets.load("iakovlev-evacuated"),
    "double with hollow inner shell": cx.presets.load("iakovlev-double"),
}


def strains(response: cx.Response) -> np.ndarray:
    m = np.arange(response.modes + 1)[:, None]
    return m * response.solution.tangential - response.solution.normal


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.linalg.norm(found - expected) / np.linalg.norm(expected))


@pytest.mark.parametrize("name", CASES)
class TestDirectConvergesToSpectral:
    """Between order 1.5 and 2: modal loads start like the square root of time, which central differences see at order 1.5."""

    rate = 1.4

    def test_displacement_and_strain(self, name: str) -> None:
        system = CASES[name]
        fine = cx.simulate(system, duration=DURATION, time_step=STEPS[-1] / 4, modes=MODES)
        errors = []
        for step in STEPS:
            response = cx.simulate(system, duration=DURATION, time_step=step, modes=MODES, engine="direct")
            stride = round(step / fine.settings.time_step)
            w = relative(response.solution.normal, fine.solution.normal[..., ::stride])
            errors.append((w, relative(strains(response), strains(fine)[..., ::stride])))
        displacement, strain = np.array(errors).T
        assert displacement[-1] < 3e-3
        assert strain[-1] < 2.5e-2
        assert np.log2(displacement[0] / displacement[-1]) / 2 > self.rate
        assert np.log2(strain[0] / strain[-1]) / 2 > self.rate


def test_absorber_histories_agree() -> None:
    system = CASES["unequal absorbers off axis"]
    direct = cx.simulate(system, duration=DURATION, time_step=1e-3, modes=MODES, engine="direct")
    spectral = cx.simulate(system, duration=DURATION, time_step=1e-3, modes=MODES)
    assert relative(direct.absorber_force().values, spectral.absorber_force().values) < 4e-3
    assert relative(direct.absorber_displacement().values, spectral.absorber_displacement().values) < 1.5e-3


@pytest.mark.parametrize(
    ("changes", "settings", "named"),
    [
        ({}, {"modes": 400, "time_step": 2e-3}, "vibrates at up to"),
        ({"absorbers": cx.absorber_ring(3, mass=10, linear_stiffness=1e13)}, {"modes": 20, "time_step": 2e-3}, "stiffest absorber"),
    ],
)
def test_unstable_step_is_refused(changes: dict, settings: dict, named: str) -> None:
    with pytest.raises(cx.InputError, match=named) as caught:
        cx.simulate(BARE.replace(**changes), engine="direct", duration=1.0, **settings)
    assert "time_step" in str(caught.value)
    assert "\n" not in str(caught.value)
