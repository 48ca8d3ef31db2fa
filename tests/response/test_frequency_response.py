"""Answers at given frequencies: against separation of variables with own potentials, a plane layer, reciprocity and energy."""

from __future__ import annotations

import warnings

import mpmath as mp
import numpy as np
import pytest
from scipy.special import jv

import coaxshell as cx
from coaxshell.errors import InputError

SPEED, DENSITY = 1400.0, 1000.0
WATER = cx.Fluid(density=DENSITY, sound_speed=SPEED)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
NOTHING = cx.Elastic(name="nothing", density=1e-2, youngs_modulus=1e4, poisson_ratio=0.3)  # 1 mm: 1e-8 of the water
WAVE = cx.PlaneShock(peak_pressure=1.0, decay_time=1e-4)
THICK = 0.2


def alone(shell, inside=cx.VACUUM, source=WAVE):
    return cx.System(shells=[shell], fluids=[inside, WATER], source=source)


def thick_tube(inside):
    """A steel tube of inner radius 0.9 m and outer radius 1.1 m, its theory exact."""
    return alone(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, THICK)], theory="elastic"), inside)


def hertz(wavenumber):
    return np.asarray(wavenumber) * SPEED / (2 * np.pi)


def series(k, b, coefficients, angle):
    """Return f = 2/sqrt(pi k b) e^{i pi/4} sum eps_m (-1)^m b_m cos m theta of p_s = sum eps_m i^m b_m H_m^(2)(kr) cos m theta."""
    terms = ((1 if m == 0 else 2) * (-1) ** m * value * mp.cos(m * mp.radians(angle)) for m, value in enumerate(coefficients))
    return complex(2 / mp.sqrt(mp.pi * k * b) * mp.expjpi(0.25) * mp.fsum(terms))


def scattered_alone(k, b, rigid):
    """Return b_m of a rigid or a soft cylinder."""
    slope = 1 if rigid else 0
    orders = range(int(k * b) + 14)
    return [-mp.besselj(m, k * b, slope) / (mp.besselj(m, k * b, slope) - 1j * mp.bessely(m, k * b, slope)) for m in orders]


def elastic_coefficients(k, b, a, inside, orders):
    """Return (b_m, E_m): scattered wave, and E_m J_m(kr) of the fluid inside per eps_m i^m, by potentials of the solid.

    u_r = phi' + (m/r) psi, u_t = -(m/r) phi - psi' with phi and psi of J_m and Y_m, cos m theta and sin m theta.
    """
    omega, found = k * SPEED, []
    mu = STEEL.youngs_modulus / (2 * (1 + STEEL.poisson_ratio))
    lame = 2 * mu * STEEL.poisson_ratio / (1 - 2 * STEEL.poisson_ratio)
    long, short = omega * mp.sqrt(STEEL.density / (lame + 2 * mu)), omega * mp.sqrt(STEEL.density / mu)

    def solid(m, r):
        """Return (u_r, sigma_rr, sigma_rt) of the four potentials at r."""
        columns = []
        for q, kind in ((long, "phi"), (short, "psi")):
            for bessel in (mp.besselj, mp.bessely):
                f, f1 = bessel(m, q * r), q * bessel(m, q * r, 1)
                f2 = -f1 / r - (q * q - m * m / r**2) * f
                if kind == "phi":
                    columns.append((f1, -lame * q * q * f + 2 * mu * f2, mu * (-2 * m * f1 / r + 2 * m * f / r**2)))
                else:
                    columns.append((m * f / r, 2 * mu * (m * f1 / r - m * f / r**2), mu * (-m * m * f / r**2 + f1 / r - f2)))
        return columns

    for m in range(orders):
        j, j1 = (mp.besselj(m, k * b, n) * k**n for n in (0, 1))
        h, h1 = ((mp.besselj(m, k * b, n) - 1j * mp.bessely(m, k * b, n)) * k**n for n in (0, 1))
        i, i1 = (mp.besselj(m, k * a, n) * k**n for n in (0, 1))
        outer, inner = solid(m, b), solid(m, a)
        rows = [
            [DENSITY * omega**2 * c[0] for c in outer] + [-h1, 0],
            [c[1] for c in outer] + [h, 0],
            [c[2] for c in outer] + [0, 0],
            [c[1] for c in inner] + [0, i if inside else 0],
            [c[2] for c in inner] + [0, 0],
            [DENSITY * omega**2 * c[0] for c in inner] + [0, -i1] if inside else [0] * 5 + [1],
        ]
        matrix, right = mp.matrix(rows), mp.matrix([j1, -j, 0, 0, 0, 0])
        scale = [max(abs(x) for x in row) or 1 for row in rows]
        wide = [max(abs(row[column]) / size for row, size in zip(rows, scale, strict=True)) for column in range(6)]
        for i, j in np.ndindex(6, 6):
            matrix[i, j] = matrix[i, j] / scale[i] / wide[j]
        answer = mp.lu_solve(matrix, mp.matrix([value / size for value, size in zip(right, scale, strict=True)]))
        found.append((answer[4] / wide[4], answer[5] / wide[5]))
    return found


@pytest.mark.parametrize("rigid", [True, False])
def test_rigid_and_soft_cylinders_have_the_form_functions_of_the_series(rigid):
    wavenumbers, angles = [0.3, 2.0, 11.0], [0.0, 70.0, 180.0]
    shell = cx.RigidShell(radius=1.0) if rigid else cx.Shell(radius=1.0, layers=[cx.Layer(NOTHING, 1e-3)])
    found = cx.frequency_response(alone(shell), hertz(wavenumbers), "form_function", angle=angles, modes=30)
    expected = [[series(k, 1.0, scattered_alone(k, 1.0, rigid), angle) for angle in angles] for k in wavenumbers]
    np.testing.assert_allclose(found, expected, rtol=1e-9 if rigid else 3e-7)


@pytest.mark.parametrize("inside", [True, False])
def test_an_elastic_cylinder_has_the_form_function_of_its_potentials_and_lets_in_what_they_let_in(inside):
    wavenumbers = [0.4, 3.1, 7.3]
    system = thick_tube(WATER if inside else cx.VACUUM)
    with mp.workdps(30):
        waves = [elastic_coefficients(mp.mpf(k), mp.mpf(1.1), mp.mpf("0.9"), inside, int(1.1 * k) + 10) for k in wavenumbers]
        expected = [[series(k, 1.1, [b for b, _ in wave], t) for t in (0.0, 110.0)] for k, wave in zip(wavenumbers, waves, strict=True)]
    found = cx.frequency_response(system, hertz(wavenumbers), "form_function", angle=[0.0, 110.0])
    np.testing.assert_allclose(found, expected, rtol=1e-8)
    if inside:
        loss = cx.frequency_response(system, hertz(wavenumbers), "transmission_loss")
        np.testing.assert_allclose(loss, [-20 * np.log10(abs(complex(wave[0][1]))) for wave in waves], atol=1e-7)
        r = np.linspace(0.0, 0.9, 4001)
        squares = np.zeros((3, r.size))
        for row, (k, wave) in enumerate(zip(wavenumbers, waves, strict=True)):
            for m, (_, e) in enumerate(wave):
                squares[row] += (1.0 if m == 0 else 2.0) * abs(complex(e)) ** 2 * jv(m, k * r) ** 2
        mean = np.trapezoid(squares * r, r, axis=1) / (0.5 * 0.9**2)
        loss = cx.frequency_response(system, hertz(wavenumbers), "transmission_loss", region="interior")
        np.testing.assert_allclose(loss, -10 * np.log10(mean), atol=1e-5)


def test_a_large_cylinder_lets_in_what_a_plane_layer_does():
    """On the axis E = T/(1 - R e^{...}): a cylindrical wave goes through the wall as a plane one does, out again through the axis."""
    k, h, errors = 1.7, 0.05, []
    omega = k * SPEED
    modulus = STEEL.youngs_modulus * (1 - 0.3) / ((1 + 0.3) * (1 - 2 * 0.3))
    speed = np.sqrt(modulus / STEEL.density)
    z, water, turn = STEEL.density * speed, DENSITY * SPEED, omega * h / speed
    both = np.cos(turn) + 0.5j * (z / water + water / z) * np.sin(turn)
    through, back = 1.0 / both, 0.5j * (z / water - water / z) * np.sin(turn) / both
    for radius in (40.0, 160.0):
        shell = cx.Shell(radius=radius, layers=[cx.Layer(STEEL, h)], theory="elastic")
        inner, outer = radius - h / 2, radius + h / 2
        found = cx.frequency_response(alone(shell, WATER), hertz(k), "pressure", radius=0.0, angle=0.0, modes=1)
        arrived = through * np.exp(1j * k * h) * np.exp(-1j * k * outer)  # per unit at the head, which is that much before the axis
        expected = arrived / (1.0 - back * np.exp(-1j * (2 * k * inner - np.pi / 2)))
        errors.append(abs(complex(found) - expected) / abs(expected))
    assert errors[0] < 0.02
    assert errors[1] < 0.3 * errors[0]


def double(absorbers=(), control=None, loss=0.0, source=WAVE, theory="thin"):
    """Two steel shells in water, 1 m and 0.7 m, 20 mm and 15 mm thick."""
    steel = STEEL.model_copy(update={"loss_factor": loss})
    shells = [cx.Shell(radius=r, layers=[cx.Layer(steel, t)], theory=theory) for r, t in ((0.7, 0.015), (1.0, 0.02))]
    return cx.System(shells=shells, fluids=[WATER, WATER, WATER], source=source, absorbers=absorbers, control=control)


UNEVEN = [
    cx.Absorber(angle=20.0, mass=30.0, damping=4e4, linear_stiffness=2e8),
    cx.Absorber(angle=145.0, mass=10.0, damping=1e5, linear_stiffness=1e7),
    cx.Absorber(angle=250.0, mass=0.0, damping=2e4, linear_stiffness=5e7),
]


def test_a_force_here_moves_there_as_one_there_moves_here():
    system, f = double(UNEVEN), [120.0, 333.0, 700.0]
    there = cx.frequency_response(system, f, "receptance", shell="inner", angle=30.0, force=("outer", 100.0))
    here = cx.frequency_response(system, f, "receptance", shell="outer", angle=100.0, force=("inner", 30.0))
    np.testing.assert_allclose(there, here, rtol=1e-10)
    faster = cx.frequency_response(system, f, "mobility", shell="outer", angle=100.0, force=("inner", 30.0))
    np.testing.assert_allclose(faster, 2j * np.pi * np.array(f) * here, rtol=1e-10)


@pytest.mark.filterwarnings("ignore:modes:coaxshell.PhysicsWarning")
@pytest.mark.parametrize("theory", ["thin", "elastic"])
def test_what_dampers_take_is_what_the_forward_wave_loses_and_does_not_scatter(theory):
    f = np.array([90.0, 210.0, 480.0, 900.0])
    lossless = double(theory=theory)
    lost, scattered = (cx.frequency_response(lossless, f, name).values for name in ("extinction_width", "scattering_width"))
    np.testing.assert_allclose(scattered, lost, rtol=1e-8)
    system = double(UNEVEN, theory=theory)
    forces = cx.frequency_response(system, f, "absorber_force", modes=60).values
    omega = 2 * np.pi * f[:, None, None]
    law = np.array([one.linear_stiffness for one in UNEVEN])[:, None] + 1j * omega * np.array([one.damping for one in UNEVEN])[:, None]
    damping = np.array([one.damping for one in UNEVEN])[:, None]
    power = (0.5 * damping * omega**2 * np.abs(forces / law) ** 2).sum(axis=(1, 2))
    width = cx.frequency_response(system, f, "absorption_width", modes=60)
    np.testing.assert_allclose(width, power * 2 * DENSITY * SPEED, atol=1e-11)  # a small difference of two widths
    assert np.all(width.values > 1e-4)
    with_loss = cx.frequency_response(double(loss=0.1, theory=theory), f, "absorption_width")
    assert np.all(with_loss.values > 0)


def test_pressures_are_continuous_on_the_walls_and_scatter_into_the_far_field():
    system, f = double(UNEVEN[:1]), hertz([3.0])
    beyond = cx.frequency_response(system, f, "pressure", radius=[1.0, 1e6], angle=[0.0, 50.0], part="scattered").values[0]
    form = cx.frequency_response(system, f, "form_function", angle=[0.0, 50.0]).values[0]
    far = form * np.sqrt(1.0 / 2e6) * np.exp(-3j * 1e6) * np.exp(-3j)  # p_i on the axis is one radius behind the head
    np.testing.assert_allclose(beyond[1], far, rtol=1e-5)
    parts = [cx.frequency_response(system, f, "pressure", radius=1.2, angle=70.0, part=part) for part in ("incident", "scattered", "total")]
    np.testing.assert_allclose(parts[0] + parts[1], parts[2], rtol=1e-12)
    assert abs(complex(parts[0][0])) == pytest.approx(1.0)


def test_an_inclined_wave_meets_a_rigid_cylinder_as_a_slower_one_in_the_section():
    inclined = alone(cx.RigidShell(radius=1.0), source=cx.PlaneShock(peak_pressure=1.0, decay_time=1e-4, inclination=35.0))
    flat = alone(cx.RigidShell(radius=1.0))
    f = hertz(np.array([1.0, 6.0]))
    found = cx.frequency_response(inclined, f, "form_function", dimensions=3)
    expected = cx.frequency_response(flat, f * np.cos(np.radians(35.0)), "form_function")
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_a_coating_that_is_not_there_changes_nothing_and_rubber_keeps_sound_out():
    rubber = cx.Viscoelastic(name="rubber", density=1100, long_term_modulus=3e6, poisson_ratio=0.48, prony=[("20 MPa", "1e-4 s")])
    bare = alone(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 0.02)], theory="elastic"), WATER)
    coat = [cx.Layer(STEEL, 0.02, role="core"), cx.Layer(rubber, 0.05)]
    coated = alone(cx.Shell(radius=1.025, layers=coat, theory="elastic"), WATER)
    f = [800.0, 2000.0]
    gain = cx.frequency_response(coated, f, "insertion_loss", against=bare, region="interior")
    losses = [cx.frequency_response(one, f, "transmission_loss", region="interior").values for one in (coated, bare)]
    np.testing.assert_allclose(gain, losses[0] - losses[1], rtol=1e-12)
    assert gain.attrs["units"] == "dB"
    np.testing.assert_allclose(cx.frequency_response(bare, f, "insertion_loss", against=bare), 0.0, atol=1e-12)


def test_target_strengths_of_a_long_rigid_cylinder_are_those_of_the_books():
    """Urick: a L^2/(2 lambda) broadside for ka >> 1; per length r |p_s/p_i|^2 = a/2."""
    system, k = alone(cx.RigidShell(radius=2.0)), 60.0
    per_length = cx.frequency_response(system, hertz(k), "target_strength")
    assert float(per_length) == pytest.approx(10 * np.log10(2.0 / 2), abs=0.05)
    body = cx.frequency_response(system, hertz(k), "target_strength", length=7.0)
    assert float(body) == pytest.approx(10 * np.log10(2.0 * 7.0**2 * k / (4 * np.pi)), abs=0.05)
    assert body.attrs["units"] == "dB re 1 m^2"


def test_cubic_stiffness_is_left_out_with_its_reach():
    absorbers = [cx.Absorber(angle=0.0, mass=10.0, linear_stiffness=1e8, cubic_stiffness=1e18)]
    with pytest.warns(cx.PhysicsWarning, match="below a stretch of 10.00 µm"):
        found = cx.frequency_response(double(absorbers), 200.0, "absorber_displacement")
    linear = [one.model_copy(update={"cubic_stiffness": 0.0}) for one in absorbers]
    np.testing.assert_allclose(found, cx.frequency_response(double(linear), 200.0, "absorber_displacement"), rtol=1e-12)


def test_short_bending_waves_of_thin_walls_are_told():
    with pytest.warns(cx.PhysicsWarning, match="bending waves are about"):
        cx.frequency_response(double(), 20_000.0, "stress")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"quantity": "echo"}, "quantity: 'echo' is unknown"),
        ({"frequency": 0.0}, "frequency: 0 Hz is not allowed"),
        ({"frequency": [1e9]}, "frequency: 1e.09 Hz is not allowed"),
        ({"quantity": "stress", "component": "von_mises"}, "component: 'von_mises' is no linear"),
        ({"quantity": "stress", "radius": 1.0}, "radius: has no effect on stress"),
        ({"quantity": "sensor_voltage"}, "there is no sensor"),
        ({"quantity": "absorber_force"}, "without absorbers"),
        ({"quantity": "insertion_loss"}, "against: is missing"),
        ({"quantity": "receptance", "angle": [0, 1]}, "force: is missing"),
        ({"quantity": "receptance", "force": "outer"}, "force: 'outer' is not allowed"),
        ({"quantity": "transmission_loss", "region": "exterior"}, "region: 'exterior' is no fluid within"),
        ({"modes": 0}, "modes: 0 is not allowed"),
        ({"quantity": "target_strength", "length": -1}, "length: -1 m is not allowed"),
        ({"quantity": "displacement", "depth": "outer"}, "depth: a thin wall moves as"),
        ({"source": 3}, "source: 3 is not allowed"),
    ],
)
def test_bad_arguments_are_refused_by_name(arguments, told):
    with pytest.raises(InputError, match=told):
        cx.frequency_response(double(), **{"frequency": 100.0, **arguments})


def test_several_sources_have_no_answer_per_incident_pressure():
    two = double(source=[WAVE, cx.PlaneShock(peak_pressure=2.0, decay_time=1e-4, angle=60.0)])
    with pytest.raises(InputError, match="source: there are 2"):
        cx.frequency_response(two, 100.0, "stress")
    second = cx.frequency_response(two, 100.0, "stress", source=1, angle=60.0)
    first = cx.frequency_response(two, 100.0, "stress", source=0, angle=0.0)
    assert complex(second) == pytest.approx(complex(first), rel=1e-12)


def test_an_unstable_loop_has_no_steady_state():
    with pytest.raises(InputError, match="unstable"):
        cx.frequency_response(cx.presets.load("active").replace_path("control.derivative", 100.0), 100.0, "stress")


@pytest.mark.parametrize("preset", ["hybrid", "electrodes"])
def test_controlled_shells_answer(preset):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        volts = cx.frequency_response(preset, [100.0, 500.0], "actuator_voltage", shell="inner", modes=40)
        sensed = cx.frequency_response(preset, [100.0, 500.0], "sensor_voltage", shell="inner", modes=40)
    assert np.all(np.isfinite(volts.values))
    control = cx.presets.load(preset).control
    s = 2j * np.pi * np.array([100.0, 500.0]) * cx.presets.load(preset).reference_radius / cx.presets.load(preset).exterior.sound_speed
    law = np.broadcast_to(control.proportional, 1)[0] + np.broadcast_to(control.derivative, 1)[0] * s
    np.testing.assert_allclose(volts, law[:, None] * sensed.values, rtol=1e-9)


def test_a_law_with_delay_filter_and_weights_answers_by_its_own_h():
    case, frequency = cx.presets.load("electrodes"), np.array([100.0, 500.0])
    law = cx.Feedback(
        numerator=[2e-4], denominator=[1e-4, 1.0], delay="1 us", amplifier_corner="20 kHz", weights=[1.0] * 5, transducers="electrodes"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        volts, sensed = (
            cx.frequency_response(case.replace(control=law), frequency, f"{name}_voltage", shell="inner", modes=4)
            for name in ("actuator", "sensor")
        )
    s = 2j * np.pi * frequency
    expected = 2e-4 / (1.0 + 1e-4 * s) * np.exp(-1e-6 * s) / (1.0 + s / (2.0 * np.pi * 20e3))
    np.testing.assert_allclose(volts, expected[:, None] * sensed.values, rtol=1e-9)


def test_a_rational_law_with_delay_has_its_voltages_and_takes_its_power():
    law = cx.Feedback(numerator=[2e-4, 0.2], denominator=[1e-5, 1.0], delay=1e-6, transducers="electrodes")
    system = cx.presets.load("electrodes").replace(control=law)
    f = np.array([150.0, 900.0])
    volts, sensed = (
        cx.frequency_response(system, f, f"{which}_voltage", shell="inner", angle=0.0, modes=12) for which in ("actuator", "sensor")
    )
    s = 2j * np.pi * f
    np.testing.assert_allclose(volts, (2e-4 * s + 0.2) / (1e-5 * s + 1.0) * np.exp(-1e-6 * s) * sensed, rtol=1e-8)
    assert np.all(cx.frequency_response(system, f, "absorption_width", modes=12).values > 1e-6)


@pytest.mark.parametrize(("theory", "wetted"), [("thin", "faces"), ("elastic", "mid-surface")])
def test_walls_without_losses_scatter_all_that_the_wave_loses(theory, wetted):
    layers = [cx.Layer(STEEL, 0.03)]
    shells = [cx.Shell(radius=r, layers=layers, theory=theory, wetted=wetted) for r in (0.6, 1.0)]
    system = cx.System(shells=shells, fluids=[cx.VACUUM, WATER, WATER], source=WAVE)
    lost, scattered = (cx.frequency_response(system, hertz([0.7, 5.2]), name) for name in ("extinction_width", "scattering_width"))
    np.testing.assert_allclose(lost, scattered, rtol=1e-8)


POINT = cx.SphericalWave(distance=2.5, pulse=cx.Gaussian(peak_pressure=1e3, width="0.4 ms"))


def test_the_wavenumbers_of_a_point_source_add_up_to_its_wave_through_a_shell_that_is_not_there():
    z = 0.7
    system = alone(cx.Shell(radius=1.0, layers=[cx.Layer(NOTHING, 1e-3)]), WATER, POINT)
    f, radii, turns = np.array([50.0, 1500.0]), np.array([0.0, 0.4, 1.7]), np.radians([0.0, 100.0])
    found = cx.frequency_response(system, f, "pressure", radius=radii, angle=np.degrees(turns), z=z, dimensions=3)
    x, y = np.outer(radii, np.cos(turns)), np.outer(radii, np.sin(turns))
    near, r = 2.5 - system.reference_radius, np.sqrt((2.5 - x) ** 2 + y**2 + z**2)
    k = 2 * np.pi * f[:, None, None] / SPEED
    np.testing.assert_allclose(found, near / r * np.exp(-1j * k * (r - near)), atol=5e-8)


@pytest.mark.parametrize("theory", ["thin", pytest.param("elastic", marks=pytest.mark.slow)])
def test_under_a_point_source_the_answer_is_the_spectrum_of_a_run(theory):
    """Orders 0 and 1, by sums around the shell: the highest of a run have few wavenumbers. Order 1 still sways as a beam when it ends."""
    system, f, around = (
        alone(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 0.05)], theory=theory), source=POINT),
        [150.0, 500.0],
        np.arange(0.0, 181.0, 45.0),
    )
    run = cx.simulate(system, duration=12.0, time_step=0.2, modes=4, dimensions=3, axial_modes=16, stations=[0.6])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        spectrum = run.spectrum("shell_acceleration", 0, angle=around, frequency=f, per="incident").to_numpy().reshape(2, 5)
        found = cx.frequency_response(system, f, "shell_acceleration", angle=around, z=0.6, dimensions=3, modes=4).to_numpy()
    ends = np.array([0.5, 1.0, 1.0, 1.0, 0.5])
    for order, close in ((0, 2e-3), (1, 0.04)):
        weights = ends * np.cos(order * np.radians(around))
        np.testing.assert_allclose(found @ weights, spectrum @ weights, rtol=close)


def test_two_points_beside_an_exact_wall_are_reciprocal():
    """What one hears of the other does not depend on which of them sounds; a source has the strength r e^{ikr} per pressure at r."""
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL.replace(loss_factor=0.02), 0.03)], theory="elastic")
    here, there = POINT, POINT.replace(distance=1.8, angle=50.0, z=0.9)
    found = []
    for one, other in ((here, there), (there, here)):
        place = {"radius": other.distance, "angle": other.angle, "z": other.z, "part": "scattered"}
        near = one.distance - 1.015
        strength = near * np.exp(2j * np.pi * 300.0 / SPEED * near)
        with pytest.warns(cx.PhysicsWarning, match="orders"):
            heard = cx.frequency_response(alone(shell, WATER, one), 300.0, "pressure", modes=1, dimensions=3, **place)
        found.append(complex(heard) / strength)
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9)


@pytest.mark.parametrize("controlled", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_under_a_point_source_exact_walls_tend_to_thin_ones(controlled):
    apart, (f, coarse) = [], ([900.0], 0.02)
    for h in (coarse, coarse / 4):
        shells = [cx.Shell(radius=1.0, layers=[cx.Layer(STEEL.replace(loss_factor=0.05), h)])]
        system = alone(shells[0], source=POINT)
        if controlled:
            preset = cx.presets.load("electrodes")
            layers = [layer.replace(thickness=layer.thickness * h / coarse) for layer in preset.shells[1].layers]
            system = alone(preset.shells[1].replace(layers=layers), source=POINT).replace(control=preset.control)
        both = []
        for theory, wetted in (("thin", "faces"), ("elastic", "mid-surface")):
            walls = [system.shells[0].replace(theory=theory, wetted=wetted)]
            with pytest.warns(cx.PhysicsWarning, match="orders"):
                answer = cx.frequency_response(system.replace(shells=walls), f, "displacement", angle=[0, 70], z=0.6, modes=1, dimensions=3)
            both.append(answer.to_numpy())
        apart.append(np.abs(both[1] - both[0]).max() / np.abs(both[0]).max())
    assert apart[1] < 0.4 * apart[0] < 4e-3


def test_solid_walls_know_inclined_waves_at_a_frequency():
    inclined = cx.PlaneShock(peak_pressure=1.0, decay_time=1e-4, inclination=35.0)
    apart = []
    for h in (0.02, 0.005):
        layers = [cx.Layer(STEEL, h)]
        walls = [cx.Shell(radius=1.0, layers=layers, theory=theory, wetted="faces") for theory in ("thin", "elastic")]
        systems = [alone(wall, WATER, inclined) for wall in walls]
        thin, exact = (cx.frequency_response(one, [200.0, 500.0], "displacement", angle=[0.0, 70.0], dimensions=3) for one in systems)
        apart.append(float(np.abs(exact - thin).max() / np.abs(thin).max()))
    assert apart[1] < 0.5 * apart[0] < 1e-3
    later = cx.frequency_response(systems[1], [200.0, 500.0], "displacement", angle=[0.0, 70.0], dimensions=3, z=1.3)
    turn = np.exp(-2j * np.pi * np.array([200.0, 500.0]) / SPEED * 1.3 * np.sin(np.radians(35.0)))
    np.testing.assert_allclose(later, exact * turn[:, None], rtol=1e-9)


def test_waves_along_the_axis_know_what_they_cannot_do():
    near = cx.SphericalShock(distance=4.0, peak_pressure=1.0, decay_time=1e-4)
    with pytest.raises(InputError, match="quantity: 'transmission_loss' is not read under a point source"):
        cx.frequency_response(double(source=near), 100.0, "transmission_loss", dimensions=3)
    with pytest.raises(InputError, match="z: 1 m has no meaning in two dimensions"):
        cx.frequency_response(double(), 100.0, "stress", z="1 m")
    held = double([cx.PointAbsorber(angle=0.0, z=0.0, mass=1.0, linear_stiffness=1e7)])
    with pytest.raises(InputError, match="absorbers: absorbers at points scatter"):
        cx.frequency_response(held, 100.0, "stress", dimensions=3)
    with pytest.raises(InputError, match="dimensions: 4 is not allowed"):
        cx.frequency_response(double(), 100.0, "stress", dimensions=4)


def test_a_pole_without_losses_has_a_number():
    """A shell within a rigid one cannot radiate: at its resonance the answer is what a damping ratio of 1e-12 leaves of it."""
    steel = cx.Shell(radius=0.5, layers=[cx.Layer(STEEL, 0.01)])
    closed = cx.System(shells=[steel, cx.RigidShell(radius=1.0)], fluids=[WATER, WATER, WATER], source=WAVE)
    tone = float(cx.natural_frequencies(closed, 2, up_to=100.0)["frequency"].squeeze())
    found = np.abs(cx.frequency_response(closed, [tone, 2 * tone], "receptance", shell=0, modes=20))
    assert found[0] > 1e9 * found[1]
    assert np.all(np.isfinite(found))
