"""The same physics by other means: spectral elements in r, implicit Gauss integration in t. No Laplace transform, no Bessel function.

Only the description of a system is taken from the package; section integrals, ring stiffness, feedback, scaling and incident waves
are written out again from the theory. In each fluid a velocity potential carries the motion, u = grad phi, p = -rho dphi/dt, the
exterior one the scattered wave alone. It is truncated so far away that nothing returns. Lengths are in a, times in a/c_e, pressures in
rho_e c_e^2; w is positive inward, so u_r = -dw/dt at a wall.

All modes, shells, fluids and absorbers make one system M x'' + C x' + K x = g(t) + B f(P x, P x'), f diagonal: the links of the
absorbers and, if the controller saturates, the voltage at a row of angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.polynomial import legendre
from scipy.sparse.linalg import splu
from scipy.special import erf

DEGREE = 8
ELEMENT = 0.125
MARGIN = 0.1


# --- the wall, by hand ---------------------------------------------------------------------------------------------------------


@dataclass
class Wall:
    """Constants of one shell in SI: integrals of rho, Q, Q z, Q z^2 over the wall, piezoelectric layers, modulus of the core."""

    radius: float
    inertia: float
    a22: float
    b22: float
    d22: float
    piezo: list
    core: float


def wall(shell):
    z = -shell.thickness / 2
    inertia = a22 = b22 = d22 = 0.0
    piezo = []
    for layer in shell.layers:
        t, x = layer.thickness, layer.material
        if hasattr(x, "youngs_modulus"):
            q = x.youngs_modulus / (1 - x.poisson_ratio**2)
        else:
            q = x.c22 - x.c23**2 / x.c33
            e32 = x.e32 - x.c23 * x.e33 / x.c33
            mu33 = x.permittivity_33 + (1 if x.permittivity_reduction == "standard" else -1) * x.e33**2 / x.c33
            piezo.append(
                {
                    "role": layer.role,
                    "E": e32 * 2 * t / np.pi,
                    "zeta33": mu33 * np.pi**2 / (2 * t),
                    "zeta22": x.permittivity_22 * t / 2,
                    "e32": x.e32 if x.actuator_coupling == "printed" else e32,
                    "limit": x.field_limit * t,
                }
            )
        inertia += x.density * t
        a22 += q * t
        b22 += q * ((z + t) ** 2 - z**2) / 2
        d22 += q * ((z + t) ** 3 - z**3) / 3
        z += t
    core = next(layer.material for layer in shell.layers if layer.role == "core")
    return Wall(shell.radius, inertia, a22, b22, d22, piezo, core.youngs_modulus / (1 - core.poisson_ratio**2))


def stiffness(w, m):
    """Return K on (V, W) in N/m^3."""
    e = np.array([m, -1.0]) / w.radius
    k = np.array([-m, m * m]) / w.radius**2  # z inward, as in the theory; b22 below counts z outward
    d = w.d22 + sum(x["E"] ** 2 / (x["zeta33"] + m * m * x["zeta22"] / w.radius**2) for x in w.piezo)
    return w.a22 * np.outer(e, e) - w.b22 * (np.outer(e, k) + np.outer(k, e)) + d * np.outer(k, k)


def sensor(w, m):
    """Return volts of the sensor per metre of (V, W)."""
    x = next(p for p in w.piezo if p["role"] == "sensor")
    return x["E"] * np.array([m, -m * m]) / (x["zeta33"] * w.radius**2 + m * m * x["zeta22"])


def actuator(w):
    return next(p for p in w.piezo if p["role"] == "actuator")


# --- one fluid -----------------------------------------------------------------------------------------------------------------


def elements(r_min, r_max):
    """Return (nodes, mass, radial, angular): integrals of N N r, N' N' r and N N/r over [r_min, r_max]."""
    inner = legendre.Legendre.basis(DEGREE).deriv().roots()
    local = np.concatenate([[-1.0], inner, [1.0]])
    x, weight = legendre.leggauss(DEGREE + 2)
    to_modal = np.linalg.inv(legendre.legvander(local, DEGREE))
    shape = legendre.legvander(x, DEGREE) @ to_modal
    slope = legendre.legval(x, legendre.legder(np.eye(DEGREE + 1))).T @ to_modal
    count = max(1, int(np.ceil((r_max - r_min) / ELEMENT)))
    half = (r_max - r_min) / count / 2
    size = count * DEGREE + 1
    nodes, mass, radial, angular = np.zeros(size), *(np.zeros((size, size)) for _ in range(3))
    for k in range(count):
        rows = slice(k * DEGREE, (k + 1) * DEGREE + 1)
        middle = r_min + (2 * k + 1) * half
        nodes[rows] = middle + half * local
        r = middle + half * x
        mass[rows, rows] += half * (shape.T * (weight * r)) @ shape
        radial[rows, rows] += (slope.T * (weight * r)) @ slope / half
        angular[rows, rows] += half * (shape.T * (weight / r)) @ shape
    return nodes, mass, radial, angular


# --- the incident wave ---------------------------------------------------------------------------------------------------------


def pulse_and_integral(pulse, x, transit, pressure):
    """Return f and its integral since the front, x in transits behind the front."""
    if hasattr(pulse, "decay_time"):
        decay, peak = pulse.decay_time / transit, pulse.peak_pressure / pressure
        return peak * np.exp(-x / decay), peak * decay * (1 - np.exp(-x / decay))
    width, centre, peak = pulse.width / transit, pulse.centre / transit, pulse.peak_pressure / pressure
    f = peak * np.exp(-(((x - centre) / width) ** 2) / 2)
    root = np.sqrt(2) * width
    return f, peak * width * np.sqrt(np.pi / 2) * (erf((x - centre) / root) + erf(centre / root))


def incident(source, distance, orders, time, transit, pressure):
    """Return modal pressure and radial velocity at r = 1, (orders, T), about the source's own axis: Gauss points on the wetted arc."""
    x, weight = legendre.leggauss(80)
    t = np.asarray(time)[:, None]
    reach = np.maximum(t, 0.0)  # path beyond the head
    if distance is None:
        front = 1 - reach
    else:
        front = (1 + distance**2 - (distance - 1 + reach) ** 2) / (2 * distance)
    arc = np.arccos(np.clip(front, -1, 1))
    theta = arc * (x + 1) / 2
    if distance is None:
        range_, spread, slope, curvature = 1 - np.cos(theta), 1.0, -np.cos(theta), 0.0
    else:
        far = np.sqrt(1 + distance**2 - 2 * distance * np.cos(theta))
        range_, spread, slope, curvature = far - (distance - 1), (distance - 1) / far, (1 - distance * np.cos(theta)) / far, 1 / far
    f, integral = pulse_and_integral(source.pulse, t - range_, transit, pressure)
    p, v = spread * f, spread * slope * (f + curvature * integral)
    shares = arc * weight / 2
    modal = [[2 * (g * np.cos(m * theta) * shares).sum(1) / (np.pi * (2 if m == 0 else 1)) for m in orders] for g in (p, v)]
    return np.array(modal[0]), np.array(modal[1])


# --- the whole -----------------------------------------------------------------------------------------------------------------


class RadialElements:
    """A system at orders 0..modes, integrated over ``duration`` transits.

    ``angles`` is the number of angles in [0, 180) degrees at which a saturating controller's voltage is taken.
    """

    def __init__(self, system, modes, duration, angles=0):
        self.system, self.modes = system, modes
        exterior = system.fluids[-1]
        self.a, self.c, self.rho = system.shells[-1].radius, exterior.sound_speed, exterior.density
        self.transit, self.pressure = self.a / self.c, self.rho * self.c**2
        self.walls = [wall(shell) for shell in system.shells]
        self.absorbers = list(system.absorber_list)
        layouts = [sorted((round(sign * x.angle % 360, 9), repr(x.replace(angle=0))) for x in self.absorbers) for sign in (1, -1)]
        symmetric = all(s.angle == 0 for s in system.sources) and layouts[0] == layouts[1]
        self.blocks = [(0, m) for m in range(modes + 1)] + ([] if symmetric else [(1, m) for m in range(1, modes + 1)])
        radii = [w.radius / self.a for w in self.walls]
        edges = [0.0, *radii, 1.0 + duration / 2 + MARGIN]
        self.regions = [
            None if not hasattr(fluid, "density") else (fluid.density / self.rho, self.c / fluid.sound_speed, *elements(*edges[j : j + 2]))
            for j, fluid in enumerate(system.fluids)
        ]
        self._assemble()
        self._links(angles)

    def _saturates(self):
        return self.system.control is not None and self.system.control.saturation

    def _assemble(self):
        parts, self.start = [], [0]
        n = len(self.walls)
        for _, m in self.blocks:
            sizes = [0 if region is None else region[2].size for region in self.regions]
            offset = 2 * n + np.concatenate([[0], np.cumsum(sizes)]).astype(int)
            size = int(offset[-1])
            M, C, K = (np.zeros((size, size)) for _ in range(3))
            for j, region in enumerate(self.regions):
                if region is None:
                    continue
                rho, slowness, nodes, mass, radial, angular = region
                rows = slice(offset[j], offset[j + 1])
                M[rows, rows] = rho * slowness**2 * mass
                K[rows, rows] = rho * (radial + m * m * angular)
                for i, point, sign in ((j - 1, offset[j], 1), (j, offset[j + 1] - 1, -1)):  # outside of shell j - 1, inside of shell j
                    if 0 <= i < n:
                        radius = self.walls[i].radius / self.a
                        C[point, n + i] = -sign * rho * radius
                        C[n + i, point] = sign * rho * radius
                if nodes[0] == 0 and m > 0:  # the potential of order m vanishes on the axis
                    M[offset[j], :] = M[:, offset[j]] = K[offset[j], :] = K[:, offset[j]] = 0.0
                    M[offset[j], offset[j]] = 1.0
            for i, w in enumerate(self.walls):
                at, radius = [i, n + i], w.radius / self.a
                M[at, at] = w.inertia / (self.rho * self.a) * radius
                K[np.ix_(at, at)] += stiffness(w, m) * self.a / self.pressure * radius
                if i in self.system.controlled_shells and not self._saturates():
                    control = self.system.control
                    volts = sensor(w, m) * self.a
                    inward = -actuator(w)["e32"] / (w.radius * self.pressure) * radius
                    K[n + i, at] -= inward * control.proportional * volts
                    C[n + i, at] -= inward * control.derivative * volts
            parts.append((M, C, K))
            self.start.append(self.start[-1] + size)
            self.exterior_point = int(offset[-2])
        masses = np.array([x.mass for x in self.absorbers]) / (self.rho * self.a**2)
        loose = np.zeros((masses.size, masses.size))
        self.M, self.C, self.K = (
            sp.block_diag([*[sp.csr_matrix(p[k]) for p in parts], sp.csr_matrix(loose if k else np.diag(masses))], format="csc")
            for k in range(3)
        )
        self.size = self.M.shape[0]

    def _shape(self, half, m, angle):
        return np.cos(m * angle) if half == 0 else np.sin(m * angle)

    def _links(self, angles):
        """Fill P and B and the law's constants: first the links of the absorbers, then the saturating voltages."""
        n, rows_p, rows_b, self.laws = len(self.walls), [], [], []
        for k, x in enumerate(self.absorbers):
            for i in (x.inner_shell, x.inner_shell + 1):
                p, b = np.zeros(self.size), np.zeros(self.size)
                p[self.start[-1] + k], b[self.start[-1] + k] = 1.0, -1.0
                for start, (half, m) in zip(self.start, self.blocks, strict=False):
                    shape = self._shape(half, m, np.radians(x.angle))
                    p[start + n + i] = -shape
                    b[start + n + i] = shape / (np.pi * (2 if m == 0 else 1))  # the row is multiplied by R, the load f/R
                rows_p.append(p)
                rows_b.append(b)
        self.c = np.repeat([x.damping for x in self.absorbers], 2) * self.c / (self.pressure * self.a) if self.absorbers else np.zeros(0)
        self.k_l = np.repeat([x.linear_stiffness for x in self.absorbers], 2) / self.pressure
        self.k_nl = np.repeat([x.cubic_stiffness for x in self.absorbers], 2) * self.a**2 / self.pressure
        self.links, self.limit = len(rows_p), []
        for i in self.system.controlled_shells if self._saturates() else ():
            w = self.walls[i]
            inward = -actuator(w)["e32"] / (w.radius * self.pressure) * w.radius / self.a
            for angle in np.pi * (np.arange(angles) + 0.5) / angles:
                p, b = np.zeros(self.size), np.zeros(self.size)
                for start, (half, m) in zip(self.start, self.blocks, strict=False):
                    assert half == 0, "saturation is written for symmetric systems here"
                    p[[start + i, start + n + i]] = sensor(w, m) * self.a * np.cos(m * angle)
                    b[start + n + i] = inward * (1 if m == 0 else 2) / angles * np.cos(m * angle)
                rows_p.append(p)
                rows_b.append(b)
                self.limit.append(actuator(w)["limit"])
        self.limit = np.array(self.limit)
        self.P = np.array(rows_p).reshape(-1, self.size)
        self.B = np.array(rows_b).reshape(-1, self.size).T

    def law(self, y, dy):
        """Return (f, df/dy, df/ddy) of all links, y of shape (2 stages * links,)."""
        count = self.links + self.limit.size
        y, dy = y.reshape(2, count), dy.reshape(2, count)
        a, s = slice(0, self.links), slice(self.links, count)
        f, by, bd = np.zeros_like(y), np.zeros_like(y), np.zeros_like(y)
        f[:, a] = self.c * dy[:, a] + self.k_l * y[:, a] + self.k_nl * y[:, a] ** 3
        by[:, a], bd[:, a] = self.k_l + 3 * self.k_nl * y[:, a] ** 2, self.c
        if self.limit.size:
            control = self.system.control
            asked = control.proportional * y[:, s] + control.derivative * dy[:, s]
            free = np.abs(asked) < self.limit
            f[:, s] = np.clip(asked, -self.limit, self.limit)
            by[:, s], bd[:, s] = control.proportional * free, control.derivative * free
        return f.ravel(), by.ravel(), bd.ravel()

    def load(self, time):
        """Return g(t), shape (size, T): incident pressure on the outer shell, minus its normal velocity into the scattered wave."""
        n, g = len(self.walls), np.zeros((self.size, len(time)))
        for source, distance in zip(self.system.sources, self.system.source_distances, strict=True):
            far = None if distance is None else distance / self.a
            p, v = incident(source, far, range(self.modes + 1), time, self.transit, self.pressure)
            for start, (half, m) in zip(self.start, self.blocks, strict=False):
                turn = self._shape(half, m, np.radians(source.angle))
                g[start + 2 * n - 1] += turn * p[m]
                g[start + self.exterior_point] += turn * v[m]
        return g

    def solve(self, time_step, steps):
        """Integrate by Gauss's method of two stages (order 4) and keep V and W of every block: self.v, self.w (shells, blocks, T)."""
        h, root = time_step, np.sqrt(3.0)
        a = np.array([[1 / 4, 1 / 4 - root / 6], [1 / 4 + root / 6, 1 / 4]])
        nodes, square = a.sum(1), a @ a
        factor = splu((sp.kron(np.eye(2), self.M) + h * sp.kron(a, self.C) + h**2 * sp.kron(square, self.K)).tocsc())
        count = self.P.shape[0]
        if count:
            reach = factor.solve(np.kron(np.eye(2), self.B))
            stacked = (self.P @ reach.reshape(2, self.size, -1)).reshape(2, -1)
            to_y = (h**2 * square @ stacked).reshape(2 * count, 2 * count)
            to_dy = (h * a @ stacked).reshape(2 * count, 2 * count)
            force = np.zeros(2 * count)
        x, v = np.zeros(self.size), np.zeros(self.size)
        n = len(self.walls)
        at = np.array(self.start[:-1])
        self.v, self.w = np.zeros((2, n, at.size, steps + 1))
        times = (h * (np.arange(steps)[:, None] + nodes)).ravel()
        active = np.unique(np.concatenate([at + 2 * n - 1, at + self.exterior_point]))
        load = self.load(times)[active]
        for step in range(steps):
            right = np.zeros((2, self.size))
            right[:, active] = load[:, 2 * step : 2 * step + 2].T
            right -= (self.C @ v + self.K @ x) + h * nodes[:, None] * (self.K @ v)
            acceleration = factor.solve(right.ravel())
            if count:
                seen = self.P @ acceleration.reshape(2, -1).T
                y0 = ((self.P @ x) + h * nodes[:, None] * (self.P @ v) + h**2 * square @ seen.T).ravel()
                dy0 = ((self.P @ v) + h * a @ seen.T).ravel()
                force = self._newton(force, y0, dy0, to_y, to_dy)
                acceleration = acceleration + reach @ force
            A = acceleration.reshape(2, -1)
            x = x + h * v + h**2 * 0.5 * (a.sum(0) @ A)
            v = v + h * 0.5 * A.sum(0)
            for i in range(n):
                self.v[i, :, step + 1], self.w[i, :, step + 1] = x[at + i], x[at + n + i]
        return self

    def _newton(self, force, y0, dy0, to_y, to_dy):
        for _ in range(60):
            f, by, bd = self.law(y0 + to_y @ force, dy0 + to_dy @ force)
            residual = force - f
            change = np.linalg.solve(np.eye(force.size) - by[:, None] * to_y - bd[:, None] * to_dy, residual)
            force = force - change
            if np.abs(change).max() <= 1e-12 * max(np.abs(force).max(), 1e-300):
                return force
        raise RuntimeError("the interface forces did not converge")

    def displacement(self, shell, degrees):
        """Return w in m at one angle, shape (T,)."""
        shapes = np.array([self._shape(half, m, np.radians(degrees)) for half, m in self.blocks])
        return self.a * shapes @ self.w[shell]

    def stress(self, shell, degrees):
        """Return the design stress in Pa at one angle, shape (T,)."""
        shapes = np.array([self._shape(half, m, np.radians(degrees)) for half, m in self.blocks])
        orders = np.array([m for _, m in self.blocks])[:, None]
        w = self.walls[shell]
        return w.core / w.radius * self.a * shapes @ (orders * self.v[shell] - self.w[shell])
