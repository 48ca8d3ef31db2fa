"""Runs near surface and bottom: images of sources until the scattered wave is back, the series of its reflections after that."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.solver.emitters import emitters
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import dimensionless

BARE = cx.presets.load("bare")
SETTINGS = {"duration": 2.4, "time_step": 1e-2, "modes": 12}
SMOOTH = cx.Gaussian(peak_pressure=2.5e4, width=8e-5)
ANGLES = [0.0, 75.0, 200.0]


def test_an_image_is_a_source_of_its_own() -> None:
    """d = 3, upward 90 degrees, R0 = 5: the image at 7.810249676, 50.19442891 degrees, later by 2.810249676."""
    shock = cx.SphericalShock(distance=5.0, peak_pressure=1e5, decay_time=1e-4)
    system = BARE.replace(source=shock, sea=cx.Sea(depth=3.0))
    _, image = emitters(system, 2, 5.0)
    assert image.geometry.distance == pytest.approx(7.810249676, rel=1e-9)
    assert image.source.angle == pytest.approx(50.19442891, rel=1e-9)
    assert image.source.delay / system.transit_time == pytest.approx(2.810249676, rel=1e-9)
    assert image.source.pulse.peak_pressure == pytest.approx(-1e5 * 4.0 / 6.810249676, rel=1e-9)


@pytest.mark.parametrize("kind", ["spherical", "plane"])
def test_images_are_a_run_of_two_sources_until_the_scattered_wave_is_back(kind: str) -> None:
    depth = 1.4
    if kind == "spherical":
        source = cx.SphericalWave(distance=2.0, pulse=SMOOTH)
        away = math.hypot(2.0, 2 * depth)
        pulse = SMOOTH.replace(peak_pressure=-SMOOTH.peak_pressure * 1.0 / (away - 1.0))
        angle = 90.0 + math.degrees(math.atan2(-2.0, 2 * depth))
        image = cx.SphericalWave(distance=away, angle=angle, delay=(away - 2.0) * BARE.transit_time, pulse=pulse)
    else:
        source = cx.PlaneWave(angle=240.0, pulse=SMOOTH)
        later = 2 * depth * math.cos(math.radians(30.0)) * BARE.transit_time
        image = cx.PlaneWave(angle=120.0, delay=later, pulse=SMOOTH.replace(peak_pressure=-SMOOTH.peak_pressure))
    near, two = (
        cx.simulate(BARE.replace(**what), **SETTINGS)
        for what in ({"source": source, "sea": cx.Sea(depth=depth)}, {"source": [source, image]})
    )
    found, expected = (np.asarray(run.stress("outer", ANGLES)) for run in (near, two))
    apart = np.abs(found - expected).max(axis=1) / np.abs(expected).max()
    time = near.solution.time
    assert apart[time < 2 * (depth - 1) - 0.1].max() < 1e-8
    assert apart[time > 2 * (depth - 1)].max() > 1e-3
    assert np.abs(near.energy(every=20).closure_relative).max() < 2e-4  # 1e-4 without a sea


def test_images_alone_where_nothing_comes_back_in_time() -> None:
    """To the last bit; a bottom's image has the same sign, and a wave along it is its own."""
    source = cx.SphericalWave(distance=2.0, pulse=SMOOTH)
    away = math.hypot(2.0, 8.0)
    pulse = SMOOTH.replace(peak_pressure=SMOOTH.peak_pressure / (away - 1.0))
    image = cx.SphericalWave(
        distance=away, angle=-90.0 + math.degrees(math.atan2(2.0, 8.0)), delay=(away - 2.0) * BARE.transit_time, pulse=pulse
    )
    short = SETTINGS | {"duration": 1.0}
    deep = cx.simulate(BARE.replace(source=source, sea=cx.Sea(depth=9.0, surface=False, bottom=4.0)), **short)
    two = cx.simulate(BARE.replace(source=[source, image]), **short)
    np.testing.assert_allclose(
        deep.stress("outer", ANGLES), two.stress("outer", ANGLES), rtol=0, atol=1e-9 * float(abs(two.stress("outer")).max())
    )
    along = BARE.replace(source=cx.PlaneWave(pulse=SMOOTH), sea=cx.Sea(depth=9.0, surface=False, bottom=4.0))
    assert dimensionless(along).images == ()


DEPTH, WALL = 1.6, cx.Shell(radius=1.0, layers=[cx.Layer("steel", "20 mm")])


def dense(problem, s, order: int, distance: float):
    """W of an evacuated thin shell under a line source at 180 degrees from the surface, with its mirror image: one dense system at s."""
    m = np.arange(order + 1)
    a, scale = problem.scales.length, problem.scales.pressure
    modulus = 210e9 / (1 - 0.3**2)
    membrane, bending = modulus * 0.02 / scale / a, modulus * 0.02**3 / 12 / scale / a**3
    mass = 7850 * 0.02 / (problem.system.exterior.density * a)
    aa, bb, cc = membrane * m**2 + bending * m**2, -membrane * m - bending * m**3, membrane + bending * m**4
    stiffness = cc + mass * s**2 - bb**2 / (aa + mass * s**2)
    i, di, k, dk = iv(m, s), ivp(m, s), kv(m, s), kvp(m, s)
    eps = np.where(m == 0, 1.0, 2.0)
    start = kv(0, s * (distance - 1.0))
    incident = eps * (-1.0) ** m * kv(m, s * distance) / start - eps * kv(m, s * (distance + 2 * DEPTH)) / start
    regular = i - di * k / dk  # load on the wall of I_m, rigid scattering included
    moved = regular / (stiffness - s**2 * k / (s * dk))
    leaving = -di / dk + s**2 * moved / (s * dk)  # factor of K_m outside
    n, total = m[:, None], m[None, :]
    back = -0.5 * eps[:, None] * (kv(total + n, 2 * DEPTH * s) + kv(total - n, 2 * DEPTH * s))
    coefficients = np.linalg.solve(np.eye(order + 1) - back * leaving[None, :], incident)
    return moved * coefficients


def test_the_series_is_the_direct_solution_of_the_shell_and_its_mirror_image() -> None:
    """After four reflections, to 3.5 transits, against a dense system of all orders at every node; surface at 0 degrees, source below."""
    distance, order = 1.9, 8
    source = cx.LineWave(distance=distance, angle=180.0, pulse=SMOOTH)
    system = cx.System(shells=[WALL], fluids=["vacuum", "water-1400"], source=source, sea=cx.Sea(depth=DEPTH, up=0.0))
    run = cx.simulate(system, duration=3.5, time_step=1e-2, modes=order)
    problem, grid = run.solution.problem, run.solution.spectra.grid
    assert rounds(problem, 3.5).done == 2
    assert run.solution.normal.shape[1] == 1
    from coaxshell.acoustics.pulse_transforms import pulse_transform

    pulse = pulse_transform(SMOOTH, grid.nodes, problem.scales.time, problem.scales.pressure)
    kept = grid.nodes.imag < 60.0  # the pulse has nothing above
    spectra = np.zeros((order + 1, grid.nodes.size), np.complex128)
    for j in np.flatnonzero(kept):
        spectra[:, j] = dense(problem, grid.nodes[j], order, distance) * pulse[j]
    expected = grid.invert(spectra)
    np.testing.assert_allclose(run.solution.normal[0, 0], expected, rtol=0, atol=1e-7 * np.abs(expected).max())
    alone = cx.simulate(system.replace(sea=None), duration=3.5, time_step=1e-2, modes=order).solution.normal[0, 0]
    assert np.abs(alone - expected).max() > 0.1 * np.abs(expected).max()


def test_absorbers_and_saturating_actuators_feel_what_comes_back() -> None:
    """The water beside the wall moves with it: its velocity is that of a point field, which knows images and not Graf's sum."""
    hybrid = cx.presets.load("hybrid").replace(
        source=cx.LineWave(distance=2.2, pulse=SMOOTH),
        absorbers=cx.absorber_ring(5, mass=10, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e20),
    )
    run = cx.simulate(hybrid.replace(sea=cx.Sea(depth=1.4, up=70.0)), duration=2.0, time_step=1e-2, modes=10)
    times, around = [1.2, 1.6, 1.9], np.arange(0.0, 360.0, 7.5)
    water = run.velocity(radius=[1.0], angle=around, time=times).values[:, 0, 0]
    wall = run.shell_velocity("outer", angle=around).sel(time=times, method="nearest").values
    low = [np.fft.rfft(values, axis=1)[:, :8] for values in (water, -wall)]  # the undisturbed wave has orders above the run's too
    np.testing.assert_allclose(*low, rtol=0, atol=1e-3 * np.abs(low[1]).max())
    assert np.abs(run.energy(every=20).closure_relative).max() < 1e-3


def test_a_saved_run_has_its_sea(tmp_path) -> None:
    run = cx.simulate(BARE.replace(sea=cx.Sea(depth=1.5)), **SETTINGS)
    loaded = cx.load_response(run.save(tmp_path / "run.nc"))
    place = {"x": [1.2], "y": [0.7], "time": [1.5, 2.3]}
    np.testing.assert_array_equal(loaded.pressure(**place), run.pressure(**place))


def test_what_is_not_reflected_is_told() -> None:
    system = BARE.replace(source=cx.SphericalWave(distance=3.0, pulse=SMOOTH), sea=cx.Sea(depth=1.5))
    with pytest.raises(InputError, match="use duration=1, or engine"):
        cx.simulate(system, **SETTINGS, engine="direct")
    short = SETTINGS | {"duration": 0.9}
    direct, spectral = (
        np.asarray(cx.simulate(system, **short, engine=engine).displacement("outer", ANGLES)) for engine in ("direct", "spectral")
    )
    np.testing.assert_allclose(direct, spectral, rtol=0, atol=2e-2 * np.abs(spectral).max())
    run = cx.simulate(system, duration=1.2, time_step=2e-2, modes=6, dimensions=3)
    (told,) = [text for text in run.warnings if text.startswith("sea")]
    assert "exact until t = 1 " in told
    assert not [text for text in cx.simulate(system, **SETTINGS).warnings if text.startswith("sea")]
    close = cx.simulate(system.replace(sea=cx.Sea(depth=1.01)), duration=1.5, time_step=0.05, modes=2)
    assert any("more than the 64 that are added up; it is exact until t = 1.3 " in text for text in close.warnings)


def test_what_knows_no_reflections_says_so() -> None:
    near = BARE.replace(sea=cx.Sea(depth=3.0))
    with pytest.raises(InputError, match="unbounded water"):
        cx.frequency_response(near, frequency=100.0, quantity="stress", shell="inner", angle=0.0)
    solid = near.replace(shells=[shell.replace(theory="elastic") for shell in near.shells])
    with pytest.raises(InputError, match="not run backwards"):
        cx.gradient(solid, metric="inner.rms_stress", variables=["shells[0].radius"], duration=1.0, time_step=0.05, modes=4)
