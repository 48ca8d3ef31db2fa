"""From a system in SI to the dimensionless problem: lengths in a, times in a/c_e, pressures in rho_e c_e^2.

a is the mid-surface radius of the outermost shell and e the exterior fluid, so one time unit is one acoustic transit of
the outer radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.images import Planes
from coaxshell.acoustics.sources import SourceGeometry
from coaxshell.model.feedback import Feedback
from coaxshell.model.fluids import Fluid
from coaxshell.model.gains import gains_of, law_of, reads_of, ties_shells
from coaxshell.model.layers import serves
from coaxshell.model.shells import RigidShell, Shell
from coaxshell.model.sources import Source
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.dimensions import require_sources_alone
from coaxshell.solver.emitters import emitters, planes_of
from coaxshell.solver.point_forces import PointForceShares, point_force_shares
from coaxshell.solver.settings import Settings
from coaxshell.structure.belts import Belts
from coaxshell.structure.constituents import constituents, loses
from coaxshell.structure.control_law import BridgedLaw, ControlGains, ControlLaw, RationalLaw
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall, LossyElectrodedWall
from coaxshell.structure.electrodes import with_plane_stress
from coaxshell.structure.losses import USUAL_BAND, Band
from coaxshell.structure.lossy_solid import LossySolidWall, resolved
from coaxshell.structure.lossy_wall import LossyWall
from coaxshell.structure.rigid import RigidWall
from coaxshell.structure.section import section
from coaxshell.structure.segmented_wall import LossySegmentedWall, SegmentedWall
from coaxshell.structure.segments import Segments
from coaxshell.structure.shell_model import ShellModel
from coaxshell.structure.solid import require_solid, solid_layers
from coaxshell.structure.solid_transducers import Transducers
from coaxshell.structure.thin_wall import ThinWall
from coaxshell.structure.tied_wall import LossyTiedWall, Read, TiedWall


@dataclass(frozen=True)
class Scales:
    """SI value of one dimensionless unit.

    Attributes
    ----------
    length : float
        a, m.
    time : float
        a/c_e, s.
    pressure : float
        rho_e c_e^2, Pa.
    """

    length: float
    time: float
    pressure: float

    @property
    def velocity(self) -> float:
        """c_e, m/s."""
        return self.length / self.time

    @property
    def line_force(self) -> float:
        """rho_e c_e^2 a, N/m."""
        return self.pressure * self.length

    @property
    def force(self) -> float:
        """rho_e c_e^2 a^2, N."""
        return self.pressure * self.length**2

    @property
    def line_energy(self) -> float:
        """rho_e c_e^2 a^2, J/m."""
        return self.pressure * self.length**2

    @property
    def energy(self) -> float:
        """rho_e c_e^2 a^3, J."""
        return self.pressure * self.length**3


@dataclass(frozen=True)
class FluidRegion:
    """One fluid in dimensionless form: density ratio rho/rho_e and slowness ratio alpha = c_e/c."""

    density: float
    slowness: float

    def wall_motion_factor(self, wall: int, radial: RadialBasis) -> ComplexArray | float:
        """Return the factor with which it feels the acceleration of a wall beside it, by number: 1, a fluid moves with its wall (Eq. 9)."""
        return 1.0


class Surface(NamedTuple):
    """A surface of a wall on which forces act.

    Attributes
    ----------
    shell : int
    side : 0, 1 or None
        Its inner or its outer face; None is the reference surface of a wall whose faces move alike.
    radius : float
        In a.
    """

    shell: int
    side: int | None
    radius: float


@dataclass(frozen=True)
class Problem:
    """The dimensionless problem.

    Attributes
    ----------
    system : System
        Where it comes from.
    scales : Scales
    shells : tuple of ShellModel
        The walls, from the inside out.
    fluids : tuple of FluidRegion or None
        From the inside out, one more than the shells; None is a vacuum.
    sources : tuple of SourceGeometry
        Where what sends waves is, one for each of the ``emitters``.
    point_force_shares : callable
        From absorbers and modes to each order's share of a line force on a circle of radius 1, shape (parities, N, M + 1).
    dimensions : int
        2, or 3 where sources are those of three dimensions.
    images : tuple of Source
        The images of the system's sources in the planes of the sea, as sources.
    planes : Planes or None
        The surface and the bottom of the sea.
    """

    system: System
    scales: Scales
    shells: tuple[ShellModel, ...]
    fluids: tuple[FluidRegion | None, ...]
    sources: tuple[SourceGeometry, ...]
    point_force_shares: PointForceShares = point_force_shares
    dimensions: int = 2
    images: tuple[Source, ...] = ()
    planes: Planes | None = None

    @property
    def emitters(self) -> tuple[Source, ...]:
        """The system's sources, and after them their images: one for each of ``sources``."""
        return (*self.system.sources, *self.images)

    @property
    def head(self) -> float:
        """Radius of the surface that the exterior fluid wets, on which the head point lies: 1 unless it is the true face of a wall."""
        return self.shells[-1].wetted[1]

    @property
    def two_faced(self) -> bool:
        """Whether any wall has faces that move differently."""
        return not all(wall.faces_move_alike for wall in self.shells)

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The surfaces on which links act, from the inside out: one a wall; of one whose faces move differently those that look at gaps.

        In a system of one shell that which looks inward, on which masses hang.
        """
        found: list[Surface] = []
        for i, wall in enumerate(self.shells):
            if wall.faces_move_alike:
                found.append(Surface(i, None, wall.radius))
                continue
            found += [Surface(i, 0, wall.wetted[0])] if i > 0 or len(self.shells) == 1 else []
            found += [Surface(i, 1, wall.wetted[1])] if i + 1 < len(self.shells) else []
        return tuple(found)

    def surface_facing(self, shell: int, side: int) -> int:
        """Return the number of the surface of a shell that looks inward (0) or outward (1)."""
        return next(n for n, one in enumerate(self.surfaces) if one.shell == shell and one.side in (None, side))

    def resolving(self, frequency: float) -> Problem:
        """Return the problem with walls that resolve waves up to a frequency, radians per transit: itself where none has such a choice."""
        shells = tuple(resolved(wall, frequency) if isinstance(wall, ElasticWall) else wall.resolving(frequency) for wall in self.shells)
        return replace(self, shells=shells) if self.two_faced else self

    @property
    def tied(self) -> bool:
        """Whether feedback runs from wall to wall or from segment to segment, so that it ties walls or orders to each other."""
        tied = (wall.shares is not None or wall.electrode_segments is not None for wall in self.shells if wall.gains is not None)
        return any(tied) or self.belts is not None

    @property
    def belts(self) -> Belts | None:
        """The belts into which electrodes are cut along the axis, alike on all walls under control; None where they are not."""
        return next((wall.belts for wall in self.shells if isinstance(wall, TiedWall | ElasticWall) and wall.gains is not None), None)

    @property
    def cut(self) -> bool:
        """Whether feedback runs from segment to segment, so that it ties orders to each other."""
        return any(wall.electrode_segments is not None for wall in self.shells if wall.gains is not None)

    @cached_property
    def open_loop(self) -> Problem:
        """The problem without feedback."""
        return replace(self, shells=tuple(shell.with_gains(None) for shell in self.shells))


def dimensionless(system: System, dimensions: int = 2, settings: Settings | None = None, band: Band | None = None) -> Problem:
    """Return the dimensionless problem of a system in two or three dimensions.

    Parameters
    ----------
    system : System
    dimensions : int
    settings : Settings, optional
        Of the run, whose band loss factors are fitted over; that of the default settings unless given.
    band : Band, optional
        That band itself, where there is no run.
    """
    if band is None:
        band = USUAL_BAND if settings is None else Band.of(settings.duration, settings.time_step / settings.refinement)
    require_sources_alone(system, dimensions)
    exterior = system.exterior
    a, c, rho = system.reference_radius, exterior.sound_speed, exterior.density
    scales = Scales(length=a, time=a / c, pressure=rho * c**2)
    shells = _reading_each_other(system, [_wall(system, i, scales, band) for i in range(len(system.shells))], scales, band)
    fluids = tuple(FluidRegion(fluid.density / rho, c / fluid.sound_speed) if isinstance(fluid, Fluid) else None for fluid in system.fluids)
    heard = emitters(system, dimensions, (settings or Settings()).duration)
    sources, images = tuple(one.geometry for one in heard), tuple(one.source for one in heard[len(system.sources) :])
    return Problem(system, scales, shells, fluids, sources, dimensions=dimensions, images=images, planes=planes_of(system))


def _wall(system: System, index: int, scales: Scales, band: Band) -> ShellModel:
    shell = system.shells[index]
    if isinstance(shell, RigidShell):
        return RigidWall(radius=shell.radius / scales.length)
    if shell.theory == "elastic":
        return _solid(system, shell, index, scales, band)
    return _thin(system, shell, index, scales, band)


def _thin(system: System, shell: Shell, index: int, scales: Scales, band: Band) -> ThinWall:
    gains, faces = _gains(system, index, scales.time), shell.wetted == "faces"
    thin: type[ThinWall] = ThinWall
    lossy: type[LossyWall] = LossyWall
    law = law_of(system, index)
    if gains is not None and law is not None and law.transducers == "electrodes":
        shell, thin, lossy = with_plane_stress(shell), ElectrodedWall, LossyElectrodedWall
    in_units = section(shell).in_units(scales.length, scales.pressure, system.exterior.density * scales.length)
    if not any(loses(layer.material) for layer in shell.layers):
        return _cut(thin.of(in_units, gains, wetted_faces=faces), system, index, scales.length)
    parts = tuple(part.in_units(scales.pressure) for part in constituents(shell, scales.time, band))
    wall = lossy.with_losses(in_units, parts, shell.layers.index(shell.core), gains, wetted_faces=faces)
    return _cut(wall, system, index, scales.length)


def _cut(wall: ThinWall, system: System, index: int, length: float) -> ThinWall:
    """Return a wall with its electrodes cut into the segments, and along the axis into the belts, that its law asks for."""
    segments, belts, lossy = _segments(system, index), _belts(system, index, length), isinstance(wall, LossyElectrodedWall)
    if not isinstance(wall, ElectrodedWall) or (segments is None and belts is None):
        return wall
    if segments is None:
        return (LossyTiedWall if lossy else TiedWall)(**vars(wall), belts=belts)
    return (LossySegmentedWall if lossy else SegmentedWall)(**vars(wall), belts=belts, segments=segments)


def _reading_each_other(system: System, walls: list[ShellModel], scales: Scales, band: Band) -> tuple[ShellModel, ...]:
    """Return the walls, those under a matrix with what their actuators answer: how strongly, an elastic one tells as its thin wall."""
    if not ties_shells(system):
        return tuple(walls)
    found, thin = list(walls), list(walls)
    for index, shell in enumerate(system.shells):
        if isinstance(shell, Shell) and shell.theory == "elastic":
            thin[index] = _thin(system, shell.replace(theory="thin"), index, scales, band)
    for index, wall in enumerate(thin):
        shares = reads_of(system, index)
        if shares is None:
            continue
        assert isinstance(wall, ElectrodedWall)  # no other transducers have a matrix
        reads = []
        for shell_, factor in sorted(shares.items()):
            read = thin[shell_].with_gains(None)
            assert isinstance(read, ElectrodedWall)
            reads.append(Read(shell_, factor, read))
        if isinstance(wall, TiedWall):
            tied = replace(wall, reads=tuple(reads))
        else:
            tied = (LossyTiedWall if isinstance(wall, LossyElectrodedWall) else TiedWall)(**vars(wall), reads=tuple(reads))
        solid = walls[index]
        found[index] = replace(solid, tied_as=tied) if isinstance(solid, ElasticWall) else tied
    return tuple(found)


def _segments(system: System, index: int) -> Segments | None:
    """Return the segments into which the law of a wall cuts its electrodes."""
    control = law_of(system, index)
    if control is None or control.segments is None:
        return None
    circumference = 2.0 * math.pi * system.shells[index].radius
    return Segments(control.segments, 1.0 - control.segments * (control.segment_gap or 0.0) / circumference, control.dead or ())


def _belts(system: System, index: int, length: float) -> Belts | None:
    """Return the belts into which the law of a wall cuts its electrodes along the axis."""
    control = law_of(system, index)
    if control is None or control.segment_pitch is None:
        return None
    dead = (control.dead_belts or (), control.dead_electrodes or ())
    return Belts(control.segment_pitch / length, (control.segment_length or control.segment_pitch) / length, *dead)


def _solid(system: System, shell: Shell, index: int, scales: Scales, band: Band) -> ElasticWall:
    require_solid(shell, f"shells[{index}]")
    density = system.exterior.density
    layers = tuple(layer.in_units(scales.length, scales.pressure, density) for layer in solid_layers(shell, scales.time, band))
    gains, core = _gains(system, index, scales.time), shell.layers.index(shell.core)
    wall = (LossySolidWall if any(layer.factor is not None for layer in layers) else ElasticWall).of(layers, core)
    if gains is None:
        return wall
    cut, belts = _segments(system, index), _belts(system, index, scales.length)
    return replace(wall, gains=gains, transducers=_transducers(system, index, scales), segments=cut, belts=belts)


def _transducers(system: System, index: int, scales: Scales) -> Transducers:
    """Return what senses and acts in an elastic wall under control."""
    shell, law = system.shells[index], law_of(system, index)
    assert isinstance(shell, Shell)
    assert law is not None
    electrodes = law.transducers == "electrodes"
    thin = section(with_plane_stress(shell) if electrodes else shell)
    in_units = thin.in_units(scales.length, scales.pressure, system.exterior.density * scales.length)
    sensors, actuators = (tuple(i for i, layer in enumerate(shell.layers) if serves(layer.role, role)) for role in ("sensor", "actuator"))
    acting = [layer for layer in in_units.piezoelectric if serves(layer.role, "actuator")]
    limit = min((layer.field_limit * layer.thickness for layer in acting), default=math.inf)
    shorted = tuple(i for i, layer in enumerate(shell.layers) if layer.role == "charge-sensor")
    return Transducers(electrodes, sensors, actuators, 0.0 if electrodes else -acting[0].actuator_coupling, limit, shorted)


def _bridged_share(system: System, index: int) -> float:
    """Return how many of a shell's sensors are self-sensing, read by a bridge, over all."""
    shell = system.shells[index]
    assert isinstance(shell, Shell)
    sensors = shell.serving("sensor")
    return sum(layer.role == "self-sensing" for layer in sensors) / max(1, len(sensors))


def _gains(system: System, index: int, time: float) -> ControlLaw | None:
    control = law_of(system, index)
    if control is None:
        return None
    if isinstance(control, Feedback):
        share = _bridged_share(system, index)
        if control.bridge_imbalance and control.delay:
            law = RationalLaw.of(*control.polynomials, control.delay, control.weights, time)
            return BridgedLaw(law.numerator, law.denominator, law.delay, law.weights, share * control.bridge_imbalance)
        return RationalLaw.of(*control.bridged(share), control.delay, control.weights, time)
    return ControlGains(*gains_of(system, index))
