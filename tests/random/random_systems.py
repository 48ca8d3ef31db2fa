"""Random valid systems: every kind of shell, fluid, source, pulse, absorber and controller, from one seed each.

Everything is drawn on the scales on which it matters (an absorber's frequency in transits, its mass against the wall's, the cubic spring
against the stretch that the shock makes), so that most systems do something; sizes in SI go over three decades.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import coaxshell as cx

FLUIDS = (("freshwater", 0.35), ("seawater", 0.15), ("oil", 0.15), ("glycerin", 0.1), ("air", 0.25))
METALS = ("aluminium", "structural-steel", "titanium-ti6al4v", "brass")
ATTEMPTS = 40


@dataclass(frozen=True, eq=False)
class Case:
    """A system with a resolution at which it is cheap."""

    seed: int
    system: cx.System
    settings: dict[str, Any]

    @property
    def kind(self) -> str:
        """What matters for the numerics, in a word or two."""
        control = self.system.control
        absorbers = self.system.absorber_list
        words = []
        if absorbers:
            words.append("cubic" if any(a.cubic_stiffness for a in absorbers) else "linear")
        if control is not None:
            words.append("saturated" if control.saturation else "controlled")
        return "+".join(words) or "plain"


def random_case(seed: int) -> Case:
    """Return the case of a seed; descriptions that the package refuses (unstable gains, walls that touch) are drawn again."""
    random = np.random.default_rng(seed)
    for _ in range(ATTEMPTS):
        try:
            system = _system(random)
            settings = _settings(random)
            if system.control is not None:
                cx.prepare(system, **settings)  # refuses what would grow
        except cx.InputError:
            continue
        return Case(seed, system, settings)
    raise AssertionError(f"no valid system in {ATTEMPTS} attempts from seed {seed}")


def _settings(random: np.random.Generator) -> dict[str, Any]:
    return {
        "duration": float(random.uniform(1.0, 2.2)),
        "time_step": float(_log(random, 8e-3, 2e-2)),
        "modes": int(random.integers(8, 21)),
    }


def _log(random: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def _one_of(random: np.random.Generator, *weighted: tuple[Any, float]) -> Any:
    weights = np.array([weight for _, weight in weighted])
    return weighted[int(random.choice(len(weighted), p=weights / weights.sum()))][0]


def _system(random: np.random.Generator) -> cx.System:
    size, count = _log(random, 5e-3, 5.0), _one_of(random, (1, 0.2), (2, 0.45), (3, 0.2), (4, 0.15))
    radii = [size]
    while len(radii) < count:
        radii.append(radii[-1] * random.uniform(0.5, 0.93))
    radii.reverse()
    controlled = random.random() < 0.22
    shells = [_shell(random, radius, controlled) for radius in radii]
    if random.random() < 0.12:
        shells[0] = cx.RigidShell(radius=radii[0])
    if count > 1 and isinstance(shells[0], cx.RigidShell) and controlled:
        control = _control(random, list(range(1, count)))
    else:
        control = _control(random, list(range(count))) if controlled and not isinstance(shells[0], cx.RigidShell) else None
    outside = cx.fluids.get(_one_of(random, *FLUIDS[:4], ("air", 0.06)))
    inside = [_one_of(random, ("vacuum", 0.25), *FLUIDS) for _ in range(count)]
    transit = size / outside.sound_speed
    sources = [_source(random, size, transit, outside) for _ in range(_one_of(random, (1, 0.75), (2, 0.2), (3, 0.05)))]
    peak = max(source.pulse.peak for source in sources)
    pairs = [i for i in range(count - 1) if not isinstance(shells[i], cx.RigidShell)]
    absorbers: Any = ()
    if pairs and random.random() < 0.75:
        absorbers = _absorbers(random, shells, int(random.choice(pairs)), transit, peak / (outside.density * outside.sound_speed**2))
    return cx.System(shells=shells, fluids=[*inside, outside], source=sources, absorbers=absorbers, control=control)


def _shell(random: np.random.Generator, radius: float, controlled: bool) -> cx.Shell:
    thickness = radius * _log(random, 2e-3, 0.06)
    layers = []
    for _ in range(int(random.integers(1, 4))):
        material = _one_of(random, (None, 0.3), *((metal, 0.7 / len(METALS)) for metal in METALS)) or _material(random)
        layers.append(cx.Layer(material, thickness * random.uniform(0.2, 1.0)))
    if controlled:
        coating = thickness * random.uniform(0.1, 0.4)
        layers = [cx.Layer("pzt-4", coating, role="sensor"), *layers, cx.Layer("pzt-4", coating, role="actuator")]
    return cx.Shell(radius=radius, layers=layers)


def _material(random: np.random.Generator) -> cx.Elastic:
    density, speed = _log(random, 900.0, 9000.0), _log(random, 800.0, 6000.0)
    return cx.Elastic(name="made", density=density, youngs_modulus=density * speed**2, poisson_ratio=float(random.uniform(0.0, 0.45)))


def _control(random: np.random.Generator, shells: list[int]) -> cx.PDControl:
    chosen = sorted({int(random.choice(shells)) for _ in range(len(shells))})
    return cx.PDControl(
        proportional=-_log(random, 1e2, 1e5),
        derivative=-_log(random, 1.0, 3e2),
        shells=chosen,
        saturation=bool(random.random() < 0.5),
        field_limit=_log(random, 1e2, 1e6),
    )


def _source(random: np.random.Generator, size: float, transit: float, outside: cx.Fluid) -> Any:
    angle = _one_of(random, (0.0, 0.35), (180.0, 0.05), (90.0, 0.05), (float(random.uniform(-180, 180)), 0.55))
    delay = _one_of(random, (0.0, 0.7), (float(random.uniform(0.0, 0.4)) * transit, 0.3))
    pulse = _pulse(random, transit, _log(random, 1e-6, 3e-3) * outside.density * outside.sound_speed**2)
    place = {"distance": size * (1.0 + _log(random, 0.2, 20.0)), "angle": angle, "delay": delay}
    kind = _one_of(random, (cx.SphericalWave, 0.4), (cx.PlaneWave, 0.35), (cx.LineWave, 0.25))
    if kind is cx.PlaneWave:
        del place["distance"]
    return kind(pulse=pulse, **place)


def _pulse(random: np.random.Generator, transit: float, peak: float) -> Any:
    kind = random.choice(["exponential", "step", "ramp", "gaussian", "sampled"])
    width = _log(random, 0.03, 1.0) * transit
    if kind == "exponential":
        return cx.Exponential(peak_pressure=peak, decay_time=width)
    if kind == "step":
        return cx.Step(pressure=peak)
    if kind == "ramp":
        return cx.Step(pressure=peak, rise_time=width)
    if kind == "gaussian":
        return cx.Gaussian(peak_pressure=peak, width=0.3 * width)
    times = np.concatenate([[0.0], np.cumsum(random.uniform(0.2, 1.0, 5)) * width])
    return cx.Sampled(time=times, pressure=peak * random.uniform(-1.0, 1.0, times.size))


def _absorbers(random: np.random.Generator, shells: list[Any], inner: int, transit: float, strength: float) -> Any:
    """Return single absorbers or a ring between two shells; *strength* is the peak pressure over rho c^2."""
    wall = shells[inner]
    count = int(random.integers(1, 9))
    weight = 2 * math.pi * wall.radius * sum(layer.material.density * layer.thickness for layer in wall.layers)
    mass = _log(random, 0.01, 0.5) * weight / count
    frequency = _log(random, 0.5, 15.0) / transit
    stiffness = 0.5 * mass * frequency**2
    stretch = strength * shells[-1].radius * _log(random, 0.1, 3.0)
    made = {
        "mass": mass,
        "linear_stiffness": stiffness,
        "damping": _one_of(random, (0.0, 0.25), (_log(random, 0.01, 1.0) * mass * frequency, 0.6), (1e3 * mass * frequency, 0.15)),
        "cubic_stiffness": _one_of(random, (0.0, 0.4), (stiffness / stretch**2 * _log(random, 0.1, 10.0), 0.6)),
        "inner_shell": inner,
    }
    apart = random.spawn(1)[0]  # what follows is drawn as ever
    if len(shells) - inner > 2 and apart.random() < 0.3:
        made["outer_shell"] = int(apart.integers(inner + 2, len(shells)))
    if random.random() < 0.12:
        made["mass"] = 0.0
    if random.random() < 0.1 and made["cubic_stiffness"] and made["mass"]:
        made["linear_stiffness"] = 0.0
    if random.random() < 0.5:
        return cx.absorber_ring(count, offset=_one_of(random, (0.0, 0.5), (float(random.uniform(0, 360)), 0.5)), **made)
    scatter = ("mass", "damping", "linear_stiffness", "cubic_stiffness")
    return [
        cx.Absorber(
            angle=float(random.uniform(-180, 180)), **{k: v * random.uniform(0.5, 2.0) if k in scatter else v for k, v in made.items()}
        )
        for _ in range(count)
    ]
