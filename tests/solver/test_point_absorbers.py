"""Point absorbers of three-dimensional runs: symmetry, exact against marched, moved and turned systems, rows of them, what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial import solve as axial_solve
from coaxshell.solver.axial.blocks import node_blocks, on_threads
from coaxshell.solver.axial.linked import point_structure
from coaxshell.solver.axial.points import pair_classes, point_layout, point_sums
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.scaling import dimensionless

RUN = {"duration": 2.0, "time_step": 2e-2, "modes": 12, "dimensions": 3}
LINKS = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8, "footprint": 0.2}
BARE = cx.presets.load("bare")


def off(found, true):
    found, true = np.asarray(found), np.asarray(true)
    return float(np.linalg.norm(found - true) / np.linalg.norm(true))


def run(absorbers, system=BARE, **changes):
    return cx.simulate(system.replace(absorbers=absorbers), **{**RUN, **changes})


def test_marched_forces_tend_to_the_exact_ones_at_second_order():
    ring = cx.absorber_ring(4, z=[-0.4, 0.0, 0.4], **LINKS)
    almost = cx.absorber_ring(4, z=[-0.4, 0.0, 0.4], **LINKS, cubic_stiffness=1e-3)
    errors = []
    for step in (2e-2, 1e-2):
        exact, marched = run(ring, time_step=step), run(almost, time_step=step)
        errors.append(off(marched.absorber_force(), exact.absorber_force()))
        told = marched.errors().sel(cause="march", quantity="stress").to_numpy()
        assert off(marched.stress("inner"), exact.stress("inner")) < 5 * told.max()
    assert errors[0] < 5e-3
    assert errors[1] < errors[0] / 3


@pytest.mark.slow_for("in both planes")
@pytest.mark.parametrize("source", [{}, {"z": 0.2}, {"angle": 20.0}], ids=["in both planes", "beside z = 0", "beside theta = 0"])
def test_mirror_images_carried_once_do_what_all_of_them_do(source):
    system = BARE.replace(source=BARE.source.model_copy(update=source))
    ring = cx.absorber_ring(4, z=[-0.4, 0.4], **LINKS, cubic_stiffness=1e17)
    nothing = cx.PointAbsorber(angle=17, z=0.13, mass=1e-9, linear_stiffness=1e-9)  # alike on no side
    once, all_of_them = run(ring, system), run((*ring, nothing), system)
    assert off(once.stress("outer", [0, 50]), all_of_them.stress("outer", [0, 50])) < 1e-9
    assert off(once.absorber_force(), all_of_them.absorber_force()[:-1]) < 1e-9


@pytest.mark.slow
def test_a_system_that_is_moved_and_turned_does_the_same_there():
    here = run([cx.PointAbsorber(angle=15, z=0.3, **LINKS)], stations=0.5)
    source = BARE.source.model_copy(update={"angle": 25.0, "z": 0.1})
    there = run([cx.PointAbsorber(angle=40, z=0.4, **LINKS)], BARE.replace(source=source), stations=0.6)
    for component in ("hoop", "axial", "shear"):
        moved = there.stress("inner", [25, 60, 200], component=component)
        assert off(moved, here.stress("inner", [0, 35, 175], component=component)) < 1e-10
    assert off(there.absorber_force(), here.absorber_force()) < 1e-10


def test_a_row_of_points_closer_than_any_wave_is_a_line(monkeypatch):
    plane = BARE.replace(source=cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.3e-4))
    per_metre = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8, "cubic_stiffness": 1e20}
    line = cx.simulate(plane.replace(absorbers=cx.absorber_ring(4, **per_metre)), duration=2.0, time_step=2e-2, modes=12)
    errors = []
    monkeypatch.setattr(axial_solve, "require_room", lambda *_, **__: None)  # it asks for the period that causality does
    for spacing in (0.8, 0.4, 0.1):
        points = cx.absorber_ring(4, z=0.0, **{name: value * spacing for name, value in per_metre.items()}, footprint=1e-9)
        # one absorber in an axial period of its spacing is an endless row of them
        monkeypatch.setattr(axial_solve, "resolved_sampling", lambda *_, spacing=spacing: (AxialSampling(spacing, 12, 40.0), []))
        row = run(points, plane, stations=[spacing / 2])
        errors.append(off(row.stress("inner", station=spacing / 2), line.stress("inner")))
    assert errors[-1] < 1e-12  # the first wavenumber but 0 lies above the highest
    assert errors[0] > errors[-1]


def test_points_off_the_plane_answer_each_other():
    # reciprocity: inner against outer wall, at other angles and stations, orders and wavenumbers added up
    places = [cx.PointAbsorber(angle=angle, z=z, mass=1.0, footprint=0.1) for angle, z in ((0, 0.0), (80, 0.37), (200, -0.6))]
    problem, grid = (
        dimensionless(BARE.with_overrides({"source.angle": 30.0, "source.z": 0.2}).replace(absorbers=places), 3),
        LaplaceGrid(0.05, 40),
    )
    structure = point_structure(problem, grid, AxialSampling(9.0, 8, 8.0), point_layout(problem), node_blocks(grid), on_threads)
    assert structure.receptance.shape[:2] == (6, 6)
    asymmetry = abs(structure.receptance - structure.receptance.swapaxes(0, 1))
    assert asymmetry.max() < 1e-13 * abs(structure.receptance).max()


def test_what_is_read_of_them():
    found = run([cx.PointAbsorber(angle=0, z="20 cm", **LINKS), cx.PointAbsorber(angle=90, z=0.0, **LINKS)])
    force, moved = found.absorber_force(), found.absorber_displacement()
    assert force.dims == ("absorber", "side", "time")
    assert force.attrs["units"] == "N"
    assert force["z"].to_numpy().tolist() == [0.2, 0.0]
    assert moved.attrs["units"] == "m"
    told = found.summary().to_dict()
    assert told["absorber_force"] == pytest.approx(float(abs(force).max()))
    # the mass answers the sum of both links' forces: m q'' = -(f_0 + f_1)
    time = force["time_seconds"].to_numpy()
    velocity = np.gradient(moved[0], time)
    acceleration = np.gradient(velocity, time)
    assert off(LINKS["mass"] * acceleration[4:-4], -force[0].sum("side")[4:-4]) < 0.1


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: cx.simulate(BARE.replace(absorbers=[cx.PointAbsorber(z=0, mass=1)]), duration=1, time_step=0.1, modes=4), "dimensions=3"),
        (lambda: run([cx.Absorber(mass=1), cx.PointAbsorber(z=0, mass=1)]), "are not solved together"),
        (lambda: cx.PointAbsorber(z=0, mass=0), "undetermined"),
        (lambda: cx.PointAbsorber(z="3 kg", mass=1), "z"),
        (lambda: BARE.replace(absorbers=[cx.PointAbsorber(z=0, mass=1, inner_shell=1)]), "no shell outside"),
        (lambda: BARE.replace(absorbers=[cx.PointAbsorber(z=0, mass=1, footprint=50)]), r"absorbers\[0\]\.footprint: 50 m is more than"),
        (lambda: cx.prepare(BARE, duration=1, time_step=0.1, modes=4).simulate([cx.PointAbsorber(z=0, mass=1)]), "dimensions=3"),
        (lambda: run([cx.PointAbsorber(z=1e6, mass=1)]), "absorbers: an axial period"),
        (lambda: cx.absorber_ring(3, z=[], mass=1), "z: there is none"),
        (lambda: cx.absorber_ring(3, z=[0.5, 0.5], mass=1), "z: .* names a position twice"),
        (lambda: cx.absorber_ring(3, z=0, angle=3, mass=1), "angle: belongs to a single absorber"),
    ],
)
def test_what_does_not_fit_is_refused(make, match):
    with pytest.raises(InputError, match=match):
        make()


def test_a_point_of_a_large_wall_moves_as_that_of_an_infinite_plate():
    # the velocity under a force that is there from t = 0 on is 1/(8 sqrt(D rho h)) of the force, before curvature (t << R/c) is felt
    thickness, modulus, density = 0.02, 210e9, 7800.0
    steel = cx.Elastic(name="steel", density=density, youngs_modulus=modulus, poisson_ratio=0.3)
    shells = [cx.Shell(radius=radius, layers=[cx.Layer(material=steel, thickness=thickness)]) for radius in (0.5, 1.0)]
    system = cx.System(
        shells=shells,
        fluids=[cx.VACUUM, cx.VACUUM, cx.Fluid(density=1e-3, sound_speed=1000.0)],
        source=cx.SphericalShock(peak_pressure=1, decay_time=1e-4, distance=3),
        absorbers=[cx.PointAbsorber(z=0, mass=1, footprint="5 mm")],
    )
    problem, grid, sampling = dimensionless(system, 3), LaplaceGrid(1e-3, 50), AxialSampling(1.0, 200, 200.0)
    layout = point_layout(problem)
    classes = pair_classes(layout)
    found = point_sums(problem, grid, sampling, layout, classes, slice(0, grid.nodes.size))["receptance"]
    scales, plate = problem.scales, 1 / (8 * np.sqrt(modulus * thickness**3 / 12 / (1 - 0.3**2) * density * thickness))
    for moved, pressed, receptance in zip(classes.moved, classes.pressed, found, strict=True):
        mobility = grid.invert(receptance)[20:40] * scales.velocity / scales.force  # at 20 to 40 microseconds
        if moved == pressed:
            np.testing.assert_allclose(mobility / plate, 1.0, atol=0.035)
        else:
            assert not mobility.any()  # a vacuum between the shells carries nothing


def test_the_wall_at_an_absorber_moves_as_its_links_say():
    # without a damper f = k (q - w) on each side: what the forces do at a station is what they do to the absorber's own points
    links = {"mass": 20.0, "linear_stiffness": 1e8, "footprint": 1e-4}
    found = run([cx.PointAbsorber(angle=30, z=0.3, **links)], stations=[0.3, 0.5])
    bare = run((), stations=[0.3])
    force, moved = found.absorber_force(), found.absorber_displacement()
    for side in ("inner", "outer"):
        wall = moved[0] - force[0].sel(side=side) / links["linear_stiffness"]
        told = found.displacement(side, angle=30, station=0.3)
        assert off(told, wall) < 1e-6
        assert off(bare.displacement(side, angle=30, station=0.3), wall) > 0.01


def test_rings_stand_where_numbers_of_any_kind_say():
    for z in (0.5, "50 cm", np.float64(0.5), np.array(0.5), [0.5], np.array([0.5]), iter([0.5])):
        ring = cx.absorber_ring(3, z=z, offset=10, mass=1)
        assert [(one.z, one.angle) for one in ring] == [(0.5, 10), (0.5, 130), (0.5, 250)]


def test_toml_holds_them_without_loss(tmp_path):
    system = BARE.replace(absorbers=cx.absorber_ring(3, z=[-0.5, 0.5], mass=1, linear_stiffness="1 MN/m", footprint="12 mm"))
    path = tmp_path / "system.toml"
    system.to_toml(path)
    assert cx.System.from_toml(path) == system


def test_files_hold_what_they_did(tmp_path):
    found = run(cx.absorber_ring(3, z=[0.1], **LINKS, cubic_stiffness=1e17))
    loaded = cx.load_response(found.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(loaded.absorber_force(), found.absorber_force())
    np.testing.assert_array_equal(loaded.absorber_displacement(), found.absorber_displacement())
    np.testing.assert_array_equal(loaded.stress("inner"), found.stress("inner"))
    again = loaded.without_transforms().shell_velocity("outer")
    np.testing.assert_allclose(again, found.shell_velocity("outer"), rtol=0, atol=1e-12 * float(abs(again).max()))
    few = found.thin(5)
    np.testing.assert_array_equal(few.absorber_force(), found.absorber_force()[..., ::5])
    assert cx.load_response(few.save(tmp_path / "few.nc")).absorber_force().shape == few.absorber_force().shape
