"""Natural frequencies: against own determinants, published rings in water, rigid cavities and the decay of time runs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy import special

import coaxshell as cx
from coaxshell import plotting
from coaxshell.apps.verification.checks.published_frequencies import RING_177, WATER_177
from coaxshell.errors import InputError

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
SHOCK = cx.PlaneShock(peak_pressure=1.0, decay_time=1e-4)
RADIUS, THICKNESS = 1.0, 0.02


def one_shell(material=STEEL, inside=WATER, **shell):
    layers = [cx.Layer(material, THICKNESS)]
    return cx.System(shells=[cx.Shell(radius=RADIUS, layers=layers, **shell)], fluids=[inside, WATER], source=SHOCK)


def determinant(s, order, k=0.0):
    """Return what vanishes at the poles of a steel shell full of water in water, s in 1/s: Z + rho s^2 (I/(kappa I') - K/(kappa K'))."""
    kappa = np.sqrt(s / 1400.0 - 1j * k) * np.sqrt(s / 1400.0 + 1j * k)
    z = kappa * RADIUS
    i = special.iv(order, z) / (kappa * special.ivp(order, z))
    outside = special.kv(order, z) / (kappa * special.kvp(order, z))
    d, m, mass = 210e9 / (1 - 0.3**2), order / RADIUS, 7800 * THICKNESS
    bending = d * THICKNESS**3 / 12 / RADIUS**4
    stretching = d * THICKNESS
    vv = stretching * m**2 + bending * order**2
    vw = -stretching * m - bending * order**3
    ww = stretching / RADIUS**2 + bending * order**4
    wall = mass * s**2 + ww - vw**2 / (mass * s**2 + vv)
    return wall + 1000.0 * s**2 * (i - outside)


@pytest.mark.parametrize("order", [1, 2, 5])
def test_poles_are_the_zeros_of_the_determinant_and_all_of_them(order):
    up_to, damped = 1800.0, 0.2
    found = cx.natural_frequencies(one_shell(), order, up_to=up_to, most_damped=damped)
    frequency, ratio = (found[name].values[0] for name in ("frequency", "damping_ratio"))
    omega = 2 * np.pi * frequency
    poles = omega * (1j - ratio / np.sqrt(1 - ratio**2))
    beside = np.abs(determinant(poles * (1 + 1e-4), order))
    assert np.all(np.abs(determinant(poles, order)) < 1e-8 * beside)
    # Zeros of D less its poles, those of 1/I' and of the stretching wall on the axis, around a region that all of them lie in or out of.
    corners = 2 * np.pi * up_to * np.array([-1e-4 + 1e-3j, 1e-4 + 1e-3j, 1e-4 + 1j, -damped + 1j, -1e-4 + 1e-3j])
    edge = np.concatenate([np.linspace(a, b, 4_000) for a, b in pairwise(corners)])
    values = determinant(edge, order)
    turns = np.angle(values[1:] / values[:-1]).sum() / (2 * np.pi)
    cavity = special.jnp_zeros(order, 8) * 1400.0 / (2 * np.pi)
    stretched = np.sqrt(210e9 / (1 - 0.3**2) / 7800 * (1 + THICKNESS**2 / 12)) * order / (2 * np.pi)
    zeros = round(turns) + np.count_nonzero(cavity < up_to) + int(stretched < up_to)
    assert zeros == np.count_nonzero((ratio < damped) & (frequency > 1.8))


def test_published_ring_in_water():
    """ANSYS VM177, order 2."""
    radius, thickness, modulus, density = RING_177
    material = cx.Elastic(name="ring", density=density, youngs_modulus=modulus, poisson_ratio=0.0)
    shell = cx.Shell(radius=radius, layers=[cx.Layer(material, thickness)])
    system = cx.System(shells=[shell], fluids=[cx.VACUUM, WATER_177], source=SHOCK)
    assert float(cx.natural_frequencies(system, 2, up_to=100.0)["frequency"][0, 0]) == pytest.approx(10.198, rel=2e-4)


def test_axial_waves_slower_than_sound_do_not_radiate():
    found = cx.natural_frequencies(one_shell(), [2], ["1 m", 2.0], up_to="1 kHz")
    assert found["frequency"].dims == ("axial_half_wavelength", "order", "mode")
    slow = found["frequency"].values < 1400.0 / (2 * np.array([1.0, 2.0]))[:, None, None]
    assert slow.any(axis=(1, 2)).all()
    assert np.all(found["damping_ratio"].values[slow] == 0.0)
    s = 2j * np.pi * found["frequency"].values[0, 0, 0]
    single = cx.natural_frequencies(one_shell(), [2], "1 m", up_to="1 kHz")
    assert float(single["frequency"][0, 0]) == pytest.approx(s.imag / (2 * np.pi), rel=1e-12)


def test_long_waves_along_the_axis_ring_as_none():
    """Modes that radiate tend to those of two dimensions, whose damping says that what leaves is an outgoing wave."""
    none, long = (cx.natural_frequencies("bare", 1, length, up_to=1300.0) for length in (None, 100.0))
    for frequency, ratio in zip(none["frequency"].values[0], none["damping_ratio"].values[0], strict=True):
        near = np.nanargmin(np.abs(long["frequency"].values[0] - frequency))  # others move along the axis, or bend as a beam
        assert float(long["frequency"][0, near]) == pytest.approx(frequency, rel=2e-3)
        assert float(long["damping_ratio"][0, near]) == pytest.approx(ratio, rel=2e-2)


def test_a_cavity_rings_as_between_rigid_walls():
    """A wall a thousand times as stiff as steel gives way by some thousandths."""
    stiff = cx.Elastic(name="stiff", density=7800, youngs_modulus=210e13, poisson_ratio=0.3)
    found = cx.natural_frequencies(one_shell(stiff), 0, up_to=1800.0)
    np.testing.assert_allclose(found["frequency"].values[0, :2], special.jnp_zeros(0, 2) * 1400.0 / (2 * np.pi), rtol=5e-3)


def test_a_run_dies_away_as_its_poles_say():
    """What is left of order 1 after a smooth pulse is a sum of the modes found, and each of the least damped ones is wanted for it."""
    system = cx.presets.load("bare")
    transit = system.transit_time
    system = system.replace(source=cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=1.0, width=0.25 * transit, centre=1.5 * transit)))
    found = cx.natural_frequencies(system, 1, up_to="3.5 kHz", most_damped=0.3)
    frequency, ratio = (found[name].values[0] for name in ("frequency", "damping_ratio"))
    poles = 2 * np.pi * frequency * (1j - ratio / np.sqrt(1 - ratio**2)) * transit
    run = cx.simulate(system, duration=24.0, time_step=1e-2, modes=1)
    acceleration = np.diff(run.modal("inner", "displacement").isel(mode=1).squeeze().values, n=2)[1000:]  # translation drifts

    def left(poles):
        waves = np.exp(poles * 1e-2 * np.arange(acceleration.size)[:, None])
        rows = np.hstack([waves.real, waves.imag])
        fit, *_ = np.linalg.lstsq(rows, acceleration, rcond=None)
        return np.linalg.norm(rows @ fit - acceleration) / np.linalg.norm(acceleration)

    assert poles.size == 6
    assert left(poles) < 5e-4
    assert [left(np.delete(poles, i)) > bound for i, bound in enumerate((0.5, 0.5, 8e-3, 1.5e-3, 5e-3))] == [True] * 5


def test_losses_damp_dry_modes_by_half_the_loss_factor():
    lossy = STEEL.replace(loss_factor=0.02, reference_frequency="1 kHz")
    found = cx.natural_frequencies(one_shell(lossy), [0], up_to=1500.0)
    assert float(found["dry_damping_ratio"][0, 0, 0]) == pytest.approx(0.01, rel=0.05)


def test_feedback_damps_and_elastic_walls_agree_with_thin_ones():
    bare, active = (cx.natural_frequencies(cx.presets.load(name), [2], up_to=600.0) for name in ("bare", "active"))
    assert np.all(active["damping_ratio"].values > 1e3 * bare["damping_ratio"].values)
    thin, solid = (cx.natural_frequencies(one_shell(theory=theory), [2, 3], up_to=300.0) for theory in ("thin", "elastic"))
    np.testing.assert_allclose(thin["frequency"][:, 0], solid["frequency"][:, 0], rtol=3e-2)
    np.testing.assert_allclose(thin["dry_frequency"][0, :, 0], solid["dry_frequency"][0, :, 0], rtol=1e-3)


def test_shapes_and_free_translation():
    found = cx.natural_frequencies("hybrid", [1, 2], up_to=700.0)
    assert found.attrs["absorbers"] == "left out"
    assert found["frequency"].values[0, 0] > 100.0  # order 1 moves freely at 0 Hz, which is no vibration
    largest = np.abs(found["shape"].values).max(axis=-1)
    np.testing.assert_allclose(largest[~np.isnan(largest)], 1.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"order": -1}, "order: -1 is not allowed"),
        ({"order": []}, "order: is empty"),
        ({"order": [2, 2]}, "names one twice"),
        ({"order": 1.5}, "order: 1.5 is not allowed"),
        ({"axial_half_wavelength": 0}, "axial_half_wavelength: 0 m is not allowed"),
        ({"axial_half_wavelength": "3 kg"}, "axial_half_wavelength: "),
        ({"up_to": -5}, "up_to: -5 Hz is not allowed"),
        ({"up_to": "1 MHz"}, "up_to: 1e+06 Hz is not allowed"),
        ({"most_damped": 0.9}, "most_damped: 0.9 is not allowed"),
    ],
)
def test_bad_arguments(arguments, words):
    with pytest.raises(InputError) as caught:
        cx.natural_frequencies("bare", **arguments)
    assert words in str(caught.value)


def test_rubber_damps_what_steel_does_not():
    """Both are looked for on walls of elastic solids, rubber by its potentials, to the left of the imaginary axis."""
    coated = cx.presets.load("coated")
    found = cx.natural_frequencies(coated, 2, up_to=30.0)
    assert np.all(found["dry_damping_ratio"].sel(shell="inner").values > 1e-4)
    assert np.all(found["dry_damping_ratio"].sel(shell="outer").values == 0.0)


def test_a_real_pole_does_not_ring():
    """Growth or decay without oscillation is no natural frequency, whatever rounding makes of it."""
    from coaxshell.numerics.poles import poles_near_axis

    found = poles_near_axis(lambda s: 1.0 / (s - 0.3) + 1.0 / ((s + 0.01) ** 2 + 1.0), 3.0, 0.2)
    np.testing.assert_allclose(found, [-0.01 + 1.0j], rtol=1e-9)


def test_dispersion_curves_by_wavenumber():
    by_k = cx.natural_frequencies("bare", [2], axial_wavenumber=[0.5, 2.0], up_to="300 Hz")
    by_length = cx.natural_frequencies("bare", [2], [np.pi / 0.5, np.pi / 2.0], up_to="300 Hz")
    np.testing.assert_array_equal(by_k["frequency"], by_length["frequency"])
    np.testing.assert_allclose(by_k["axial_wavenumber"], [0.5, 2.0])
    ax = plotting.plot_natural_frequencies(by_k)
    assert ax.get_xlabel() == "axial wavenumber (rad/m)"
    with pytest.raises(cx.InputError, match="axial_wavenumber: is given beside axial_half_wavelength"):
        cx.natural_frequencies("bare", [2], 3.0, axial_wavenumber=1.0)
    with pytest.raises(cx.InputError, match=r"axial_wavenumber: \[0.0, 1.0\] is not allowed"):
        cx.natural_frequencies("bare", [2], axial_wavenumber=[0.0, 1.0])
