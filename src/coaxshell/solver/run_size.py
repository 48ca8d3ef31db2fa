"""The size of a run: the numbers on which its cost depends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.model.gains import saturates, segments_of
from coaxshell.model.pulses import Sampled
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.lattice import channels
from coaxshell.solver.interface.linear_ring import is_ring
from coaxshell.solver.rounds import rounds
from coaxshell.solver.sampled_orders import crossing_order
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES, Settings
from coaxshell.solver.solid_spectra import band
from coaxshell.structure.elastic_basis import plane_bytes
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import shaped_layers

COMPLEX, REAL = 16.0, 8.0
"""Bytes of a number."""
_MODES_OF_AUTO = 300
"""Orders that "auto" is taken for until it is known how many it finds."""


@dataclass(frozen=True)
class Size:
    """The numbers on which the cost of a run depends.

    Attributes
    ----------
    shells, controlled : int
        All, and those whose actuators have limits.
    feedback : bool
        Whether there is control at all.
    points : int
        Where absorbers touch shells, two each; mirror images are carried once where all is symmetric.
    nonlinear, ring : bool
        Whether absorbers have cubic springs, and whether linear ones are an even ring.
    source_parities, parities : int
        Of the Fourier series that the sources excite, and the absorbers.
    orders, nodes, instants : int
        M + 1; of the Laplace contour; of the march, refinement included.
    sampled_top : float
        The highest order that the estimate of what is left out looks at.
    tabulated : int
        Sources of a spherical wave, whose projections are made at all nodes at once.
    samples : int
        Of records.
    """

    shells: int
    controlled: int
    feedback: bool
    points: int
    nonlinear: bool
    ring: bool
    source_parities: int
    parities: int
    orders: int
    nodes: int
    instants: int
    sampled_top: float
    tabulated: int
    samples: int

    solids: int = 0
    """Transforms of each shell beside W and V, where walls are elastic solids: hoop stress, faces, loads on them, potentials."""
    shapes: float = 0.0
    """Bytes of the shapes of elastic walls in two dimensions, which outlast the run."""
    reflections: int = 0
    """Rounds of the series that planes of the sea send back."""
    surfaces: int = 0
    """Surfaces on which links act."""
    kernels: int = 0
    """Kernels that a march without limits of actuators sums over the past."""
    patterns: int = 0
    """Of the voltages of all walls, where feedback ties orders or walls: then every point moves every other by itself."""

    @property
    def plane(self) -> float:
        """Bytes of one complex number for each order and node."""
        return COMPLEX * self.orders * self.nodes

    @property
    def history(self) -> float:
        """Bytes of one real number for each order and instant."""
        return REAL * self.orders * self.instants

    @property
    def linked(self) -> bool:
        """Whether forces act on the structure beside those of the sources."""
        return self.points > 0 or self.controlled > 0

    @property
    def marched(self) -> bool:
        """Whether they are nonlinear."""
        return self.nonlinear or self.controlled > 0


def size_of(problem: Problem, settings: Settings) -> Size:
    """Return the numbers of a run; "auto" counts as 300 orders."""
    system, steps = problem.system, settings.steps * settings.refinement
    grid = LaplaceGrid(settings.time_step / settings.refinement, steps)
    excited = source_parities(problem)
    links = absorber_set(problem, system.absorber_list, excited)
    orders = (_MODES_OF_AUTO if settings.modes == "auto" else settings.modes) + 1
    feedback = [i for i, shell in enumerate(problem.shells) if shell.gains is not None]
    solids = [wall for wall in problem.shells if isinstance(wall, ElasticWall)]
    limited, parities = saturates(system), links.parities if links.count else excited
    patterns = len(feedback) * (segments_of(system) or parities * orders) if problem.tied else 0
    return Size(
        shells=len(problem.shells),
        controlled=len(feedback) if limited else 0,
        feedback=bool(feedback),
        points=2 * links.count,
        nonlinear=not links.is_linear,
        ring=links.count > 0 and is_ring(links),
        source_parities=excited,
        parities=parities,
        orders=orders,
        nodes=grid.samples // 2 + 1,
        instants=steps + 1,
        sampled_top=min(2.0 * MAX_MODES, max(4.0 * orders, 2.2 * crossing_order(problem), orders + 32.0)),
        tabulated=sum(source.geometry == "spherical" for source in problem.emitters),
        solids=5 + max(wall.shown_potentials for wall in solids) if solids else 0,
        shapes=_shapes(problem.resolving(band(grid)), orders, band(grid)) * (2.0 if feedback else 1.0),  # whose stability has its own
        reflections=rounds(problem, settings.duration).done if settings.dimensions == 2 else 0,
        surfaces=len(problem.surfaces),
        kernels=4 * links.count**2 if patterns else channels(problem, links, orders - 1).kernels,
        patterns=patterns,
        samples=sum(len(source.pulse.time) for source in system.sources if isinstance(source.pulse, Sampled)),
    )


def _shapes(problem: Problem, orders: int, frequency: float) -> float:
    """Return the bytes of the shapes of all elastic walls in two dimensions."""
    solids = [wall for wall in problem.shells if isinstance(wall, ElasticWall)]
    numbers = np.arange(orders, dtype=np.float64)
    return float(sum(plane_bytes(layers, numbers, frequency) for wall in solids for layers in shaped_layers(wall)))
