"""Walls of solids with losses: against a dense solve at every node, closed forms, the limit of no loss, and the decay of a free ring."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure import solid_pieces
from coaxshell.structure.elastic_basis import PotentialOfLayer, displacements, layer_strains
from coaxshell.structure.elastic_mesh import wall_mesh
from coaxshell.structure.elastic_wall import Asked, ElasticWall
from coaxshell.structure.losses import Band, constant_q, prony_fit
from coaxshell.structure.lossy_solid import LossySolidWall
from coaxshell.structure.solid import AXIAL, HOOP, HOOP_AXIAL, RADIAL, RADIAL_AXIAL, RADIAL_HOOP, require_solid, solid_layers
from coaxshell.structure.solid_potentials import Potentials, moduli

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
DAMPED = STEEL.replace(loss_factor=0.1)
RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="6 MPa", poisson_ratio=0.499, prony=[("30 MPa", "1e-4 s"), ("5 MPa", "2 ms")])
EPOXY = cx.Viscoelastic(density=1150, long_term_modulus="3 GPa", poisson_ratio=0.35, prony=[("1 GPa", "1e-4 s")])
PZT = cx.materials.PZT4_STANDARD.replace(loss_factor=0.2, loss_model="constant-q")
SHOCK = cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.3e-4)
TRANSIT = 1.0 / 1400.0
NODES = np.array([1.2 + 0.4j, 1.2 + 7j, 1.2 + 60j])


def wall_of(*layers: tuple[object, float], radius: float = 1.0, frequency: float = 100.0) -> ElasticWall:
    built = [cx.Layer(material, thickness, role="passive") for material, thickness in layers]
    shell = cx.Shell(radius=radius, layers=built)
    require_solid(shell, "shells[0]")
    solids = tuple(x.in_units(1.0, 1000.0 * 1400.0**2, 1000.0) for x in solid_layers(shell, TRANSIT))
    kind = ElasticWall if all(x.factor is None for x in solids) else LossySolidWall
    return kind.of(solids, 0).resolving(frequency)


def matrix_of(layer, s: complex) -> np.ndarray:
    """Return C(s) of a layer, at constant field."""
    if not layer.shear_alone:
        return layer.matrix * (1.0 if layer.factor is None else layer.factor.at(np.array([s]))[0])
    bulk, shear = (x[0] for x in moduli(layer, np.array([s])))
    found = np.diag([2.0 * shear] * 3 + [shear] * 3)
    found[:3, :3] += bulk - 2.0 / 3.0 * shear
    return found


class Dense:
    """A wall at one order, wavenumber and node: the complex stiffness of all points, solved."""

    def __init__(self, wall: ElasticWall, order: int, s: complex, degree: int = 12, wavenumber: float = 0.0) -> None:
        self.wall, self.s, self.order, self.k = wall, s, np.array([float(order)]), wavenumber
        self.mesh = wall_mesh(wall.layers, [degree] * len(wall.layers))
        count, moves = self.mesh.radius.size, displacements(wavenumber)
        stiffness = np.zeros((moves, count, moves, count), complex)
        for part in self.mesh.layers:
            b = layer_strains(part, self.order, wavenumber)[0]
            stiffness[:, part.nodes, :, part.nodes] += np.einsum("q,iqap,ij,jqbs->apbs", part.weights, b, matrix_of(part.layer, s), b)
            if part.layer.coupling is not None:
                rows = PotentialOfLayer(part, self.order, wavenumber).rows[0]
                stiffness[:, part.nodes, :, part.nodes] += np.einsum("iap,ibs->apbs", rows, rows)
        dynamic = stiffness.reshape(moves * count, -1) + s * s * np.diag(np.tile(self.mesh.mass, moves))
        loads = np.zeros((moves * count, 2))
        loads[0, 0], loads[count - 1, 1] = -wall.wetted[0], -wall.wetted[1]
        self.x = np.linalg.solve(dynamic, loads).reshape(moves, count, 2)

    @property
    def faces(self) -> np.ndarray:
        """H_ii, H_io, H_oo."""
        inner, outer = self.wall.wetted
        return np.array([-self.x[0, 0, 0] / inner, -self.x[0, -1, 0] / inner, -self.x[0, -1, 1] / outer])

    def stress(self, number: int, point: int, component: int) -> np.ndarray:
        """Return a stress at a point of a layer per load on either face."""
        part = self.mesh.layers[number]
        b = layer_strains(part, self.order, self.k)[0][:, point]
        moved = self.x[:, part.nodes]
        found = matrix_of(part.layer, self.s)[component] @ np.einsum("iap,apl->il", b, moved)
        if part.layer.coupling is not None:
            phi = np.einsum("qap,apl->ql", PotentialOfLayer(part, self.order, self.k).values[0], moved)
            e = np.array(part.layer.coupling)[:, component]
            along = e[1] * self.order / part.radius[point] + e[2] * self.k
            found = found + e[0] * (part.derivative @ phi)[point] - along * phi[point]
        return np.asarray(found)


def every_row(part, rows) -> np.ndarray:
    """Keep all rows of the potentials of ceramics."""
    return np.eye(rows.shape[1])[None]


WALLS = {
    "one layer": [(DAMPED, 0.02)],
    "two factors": [(DAMPED, 0.02), (STEEL, 0.01)],
    "rubber outside": [(STEEL, 0.02), (RUBBER, 0.03)],
    "rubber between": [(STEEL, 0.004), (RUBBER, 0.004), (DAMPED, 0.002)],
    "epoxy": [(STEEL, 0.01), (EPOXY, 0.001)],
    "ceramics": [(PZT, 0.002), (STEEL.replace(loss_factor=0.2, loss_model="constant-q"), 0.01), (PZT, 0.002)],
    "ceramics alone": [(STEEL, 0.01), (PZT, 0.002)],
}


@pytest.mark.slow_for(
    "9-30.0-rubber outside",
    "60-0.0-rubber outside",
    "9-0.0-rubber outside",
    "9-30.0-ceramics",
    "9-30.0-rubber between",
)
@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize(("order", "wavenumber"), [*((m, 0.0) for m in (0, 1, 2, 9, 60)), (0, 0.2), (9, 30.0)])
def test_receptances_and_stresses_agree_with_a_dense_solve(name, order, wavenumber, monkeypatch):
    monkeypatch.setattr(solid_pieces, "kept_rows", every_row)  # what is left out has a test of its own
    # Degrees are those for 1e-6 of receptances; stresses are compared where they are resolved as well.
    wall = wall_of(*WALLS[name], frequency=2000.0 if order > 9 or wavenumber > 9.0 else 100.0)
    modes = Modes(np.array([float(order)]), wavenumber)
    found = wall.receptance(modes, NODES)
    shown = {"hoop": HOOP, "radial": RADIAL, "axial": AXIAL}
    if order:
        shown |= {"radial_hoop": RADIAL_HOOP}
    if wavenumber:
        shown |= {"radial_axial": RADIAL_AXIAL} | ({"shear": HOOP_AXIAL} if order else {})
    degree = 26 if "rubber outside" in name else 12
    for k, s in enumerate(NODES):
        dense = Dense(wall, order, s, degree, wavenumber)
        faces = np.array([x[0, k] for x in (found.inner, found.across, found.outer)])
        np.testing.assert_allclose(faces, dense.faces, rtol=1e-6, atol=1e-7 * np.abs(dense.faces).max())
        for number, part in enumerate(dense.mesh.layers):
            point = degree // 3
            depth = part.radius[point] - wall.radius
            values = wall.transfer(modes, np.array([s]), [Asked(what, depth) for what in shown])[:, :, 0, 0]
            expected = np.array([dense.stress(number, point, component) for component in shown.values()])
            np.testing.assert_allclose(values, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("order", [0, 2, 9])
def test_what_is_left_out_of_the_fields_of_ceramics_is_next_to_nothing(order, monkeypatch):
    """Against all of their rows, at a loss factor of 0.2: faces to 1e-6, stresses to 2e-5 of the largest."""
    modes, found = Modes(np.array([float(order)])), []
    asked = [Asked(what, depth) for what in ("hoop", "radial") for depth in (-7e-3, 0.0, 6e-3)]
    for _ in range(2):
        wall = wall_of(*WALLS["ceramics"])
        faces = wall.receptance(modes, NODES)
        found.append((np.stack([faces.inner, faces.across, faces.outer]), wall.transfer(modes, NODES, asked)))
        monkeypatch.setattr(solid_pieces, "kept_rows", every_row)
    (faces, stresses), (all_faces, all_stresses) = found
    np.testing.assert_allclose(faces, all_faces, rtol=1e-6)
    np.testing.assert_allclose(stresses, all_stresses, rtol=0, atol=2e-5 * np.abs(all_stresses).max())


# Limits


def test_without_losses_it_is_the_elastic_wall_and_small_losses_tend_to_it():
    modes, changes = Modes.up_to(6), []
    elastic = wall_of((STEEL, 0.02), (PZT.replace(loss_factor=0.0), 0.003))
    assert type(elastic) is ElasticWall
    expected = elastic.two_port(modes, NODES)
    for eta in (1e-3, 1e-4):
        found = wall_of((STEEL.replace(loss_factor=eta), 0.02), (PZT.replace(loss_factor=eta, loss_model="prony"), 0.003)).two_port(
            modes, NODES
        )
        changes.append(np.abs(found[1] / np.where(expected[1] == 0.0, 1.0, expected[1]) - 1.0)[expected[1] != 0.0].max())
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=0.05)


def test_a_static_load_meets_the_relaxed_modulus_even_if_nearly_incompressible():
    """Lame in plane strain, u = A r + B/r, at a node so low that nothing moves and 3e-5 of the arms are left."""
    for nu in (0.3, 0.49, 0.4999):
        wall = wall_of((RUBBER.replace(poisson_ratio=nu), 0.1))
        (layer,), (a, b), s = wall.layers, wall.wetted, np.array([1e-5 + 0j])
        bulk, shear = (x[0].real for x in moduli(layer, s))
        assert shear == pytest.approx(layer.shear, rel=4e-5)
        stretch = -(b * b) / (b * b - a * a) / (2.0 * (bulk + shear / 3.0))
        twist = -(a * a * b * b) / (b * b - a * a) / (2.0 * shear)
        radial = wall.transfer(Modes.up_to(0), s, [Asked("normal", r - wall.radius) for r in (a, b)])[:, 1, 0, 0]
        np.testing.assert_allclose(-radial, [stretch * r + twist / r for r in (a, b)], rtol=1e-6)


def test_a_front_meets_a_face_with_the_impedance_of_pressure_waves():
    """rho c_L sqrt(g) s H_oo r_o tends to 1, of a metal with losses and of a coat of rubber."""
    for layers in ([(DAMPED, 0.05)], [(STEEL, 0.02), (RUBBER, 0.03)]):
        wall = wall_of(*layers, frequency=2000.0)
        outer = wall.layers[-1]
        for s, near in ((500.0, 0.03), (2000.0, 0.008)):
            node = np.array([s + 0j])
            found = wall.receptance(Modes.up_to(0), node).outer[0, 0]
            if outer.shear_alone:
                bulk, shear = (x[0] for x in moduli(outer, node))
                stiff = bulk + 4.0 / 3.0 * shear
            else:
                stiff = outer.stiffness[0][0] * outer.factor.at(node)[0]
            assert abs(np.sqrt(outer.density * stiff) * s * found * outer.outer - 1.0) < near


@pytest.mark.parametrize("eta", [0.02, 0.3])
def test_thin_walls_with_losses_are_their_limit(eta):
    """The impedance of the middle differs from the thin wall's by O(h)."""
    errors, s = [], np.array([1.0 + 2j])
    for h in (8e-3, 4e-3, 2e-3):
        layers = [cx.Layer(STEEL.replace(loss_factor=eta), h / 2), cx.Layer(STEEL.replace(loss_factor=3 * eta), h / 2, role="passive")]
        thin = cx.System(
            shells=[cx.Shell(radius=1.0, layers=layers)], fluids=[cx.VACUUM, cx.Fluid(density=1000, sound_speed=1400)], source=SHOCK
        )
        solid = thin.replace(shells=[thin.shells[0].replace(theory="elastic")])
        modes = Modes(np.array([0.0, 2.0, 5.0]))
        both = [dimensionless(system).shells[0].receptance(modes, s).outer for system in (thin, solid)]
        errors.append(float(np.abs(both[1] / both[0] - 1.0).max()))
    assert errors[2] < 0.01
    assert errors[0] / errors[1] > 1.8
    assert errors[1] / errors[2] > 1.8


# Constant Q (theory-beyond, section 18.9) and the free ring


def of_ring(eta: float, model: str, order: int, thickness: float = 2e-4) -> tuple[LossySolidWall, float]:
    """Return a wall whose loss factor holds at its lowest frequency, and that frequency."""
    modes = Modes(np.array([float(order)]))
    layer = solid_layers(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)]), TRANSIT)[0].in_units(1.0, 1.96e9, 1000.0)
    squares = ElasticWall.of((layer,), 0).basis(modes)[0].squares[0]
    frequency = float(np.sqrt(squares[int(order == 0)]))  # of order 0 the torsion of the section is the rigid one
    band = Band(frequency / 300.0, frequency * 300.0)
    factor = constant_q(eta, frequency, band) if model == "constant-q" else prony_fit(eta, frequency, band)
    return LossySolidWall.of((replace(layer, factor=factor),), 0).resolving(4.0 * frequency), frequency


def test_the_impulse_of_a_ring_of_constant_q():
    wall, frequency = of_ring(0.1, "constant-q", 0)
    step = 0.01 / frequency
    grid = LaplaceGrid(step, 2500)
    receptance = wall.receptance(Modes.up_to(0), grid.nodes).outer[0]
    mass = wall.mass * wall.radius  # w of a thin ring per force R q
    found = grid.invert(receptance * mass)
    at = [round(t / frequency / step) for t in (1.0, 5.0, 20.0)]
    np.testing.assert_allclose(found[at] * frequency, [0.8296565626, -0.7645238651, 0.3281566592], rtol=0, atol=1e-4)


@pytest.mark.parametrize("model", ["prony", "constant-q"])
@pytest.mark.parametrize("order", [0, 2, 6])
def test_the_loss_factor_comes_back_from_the_decay_of_a_free_ring(order, model):
    eta = 0.1
    wall, frequency = of_ring(eta, model, order)
    period = 2.0 * np.pi / frequency
    grid = LaplaceGrid(period / 100, 1200)
    motion = grid.invert(wall.receptance(Modes(np.array([float(order)])), grid.nodes).outer[0])
    peaks = np.flatnonzero((motion[1:-1] > motion[:-2]) & (motion[1:-1] > motion[2:]) & (motion[1:-1] > 0.02 * motion.max())) + 1
    y0, y1, y2 = motion[peaks - 1], motion[peaks], motion[peaks + 1]
    shift = 0.5 * (y0 - y2) / (y0 - 2 * y1 + y2)
    instants, heights = grid.time[peaks] + shift * grid.time_step, y1 - 0.25 * (y0 - y2) * shift
    assert peaks.size > 4
    decay, measured = -np.polyfit(instants[1:], np.log(heights[1:]), 1)[0], 2 * np.pi / np.diff(instants[1:]).mean()
    assert np.tan(2 * np.arctan(decay / measured)) == pytest.approx(eta, rel=0.04)


# Rubber


@pytest.mark.parametrize("wavenumber", [0.0, 4.0])
def test_a_rubber_by_potentials_is_symmetric_and_passive(wavenumber):
    layer = wall_of((RUBBER.replace(poisson_ratio=0.4999), 0.03)).layers[0]
    modes, names = Modes.up_to(40, wavenumber), ("normal", "tangential", "along_axis")[: displacements(wavenumber)]
    fields = Potentials(layer, modes, NODES)
    moved = np.concatenate([fields.rows(radius, names) for radius in (layer.inner, layer.outer)])
    outward = np.tile([-1.0, 1.0, 1.0][: len(names)], 2)[:, None, None, None]
    matrix = np.moveaxis(fields.per_force(outward * moved), (0, 1), (2, 3))
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 2, 3), rtol=0, atol=1e-9 * np.abs(matrix).max())
    power = (matrix * NODES[:, None, None] + np.conj(np.swapaxes(matrix * NODES[:, None, None], 2, 3))) / 2.0
    assert np.linalg.eigvalsh(power).min() > -1e-12 * np.abs(power).max()


@pytest.mark.parametrize("nu", [0.49, 0.4999])
def test_elements_converge_to_the_potentials_without_locking(nu):
    """Degrees 6, 10, 14: each takes a factor off, as fast at nu = 0.4999 as at 0.49."""
    wall = wall_of((STEEL, 0.02), (RUBBER.replace(poisson_ratio=nu), 0.03))
    s, exact = 1.2 + 20j, None
    exact = wall.receptance(Modes(np.array([6.0])), np.array([s])).outer[0, 0]
    errors = [abs(Dense(wall, 6, s, degree).faces[2] / exact - 1.0) for degree in (4, 7, 10)]
    assert errors[0] > 10.0 * errors[1] > 100.0 * errors[2]
    assert errors[2] < 1e-6


def test_a_soft_layer_with_a_loss_factor_answers_by_potentials_as_by_shapes():
    soft = STEEL.replace(youngs_modulus=3e7, density=1100, poisson_ratio=0.48, loss_factor=0.3)
    modes = Modes(np.array([0.0, 3.0, 12.0]))
    low, high = (wall_of((STEEL, 0.01), (soft, 0.01), frequency=f) for f in (40.0, 400.0))
    assert [piece.by_potentials for piece in low.pieces] == [False, False]
    assert [piece.by_potentials for piece in high.pieces] == [False, True]
    s = np.array([1.2 + 0.4j, 1.2 + 20j])
    for name in ("inner", "across", "outer"):
        np.testing.assert_allclose(*(getattr(wall.receptance(modes, s), name) for wall in (low, high)), rtol=1e-6)
