"""The mutations of three dimensions."""

from __future__ import annotations

from mutation import Mutation

SPATIAL = (
    Mutation(
        "spherical-front-phase",
        "acoustics/sources/spherical_front.py",
        "/ (surface.kappa + basis.s)",
        "/ (2.0 * surface.kappa)",
        "phase of the spherical source at an axial wavenumber",
        "acoustics/test_spherical_front.py",
    ),
    Mutation(
        "axial-reach",
        "solver/axial/causality.py",
        "return speed * time + start / (speed + _faster(speed))",
        "return speed * time + start / (2.0 * speed)",
        "how far a head wave gets along the axis, and with it the axial period",
        "solver/test_axial_sampling.py",
    ),
    Mutation(
        "axial-shares",
        "solver/axial/sampling.py",
        "np.where(self.wavenumbers == 0.0, 2.0, 4.0)",
        "np.where(self.wavenumbers == 0.0, 4.0, 4.0)",
        "sum over axial wavenumbers: that of k = 0 counts once",
        "solver/test_axial_sampling.py",
    ),
    Mutation(
        "inclined-trace",
        "acoustics/sources/plane.py",
        "+ z * self._ray[1]",
        "- z * self._ray[1]",
        "which way an inclined plane wave runs along the axis",
        "acoustics/test_spatial_field.py",
    ),
    Mutation(
        "bending-ahead-of-the-front",
        "solver/axial/inclination.py",
        "b * b - 4.0 * square",
        "b * b - 2.0 * square",
        "bending waves that keep pace with the trace of an inclined wave",
        "solver/test_inclination.py",
    ),
    Mutation(
        "source-off-plane",
        "solver/axial/families.py",
        "sampling.shares(stations - z0)",
        "sampling.shares(stations + z0)",
        "a source at z0 is the same shock further along the axis",
        "analytic/test_stations.py",
    ),
    Mutation(
        "axial-displacement-side",
        "solver/axial/sums.py",
        '"u": (odd, u)',
        '"u": (-odd, u)',
        "axial displacement of a wave: sin kz",
        "independent/test_axial_waves.py",
    ),
    Mutation(
        "axial-strain-sign",
        "solver/axial/sums.py",
        '"u_z": (k * even, u)',
        '"u_z": (-k * even, u)',
        "axial strain of a wave: k cos kz",
        "reference/test_spherical_bare.py",
    ),
    # structure
    Mutation(
        "axial-tilt",
        "structure/axial.py",
        "[zero + m / radius**2, zero - k / radius,",
        "[zero, zero - k / radius,",
        "twist of a wall by its axial displacement: a tilt is free of strain",
        "structure/test_axial_walls.py",
    ),
    Mutation(
        "axial-elimination",
        "structure/axial.py",
        "axial = (uv * vw - vv * uw)",
        "axial = (uv * vw + vv * uw)",
        "axial displacement per normal one: sign",
        "structure/test_axial_walls.py",
    ),
    Mutation(
        "axial-potential",
        "structure/axial.py",
        "+ k**2 * _axial(layer).zeta11)",
        "- k**2 * _axial(layer).zeta11)",
        "permittivity of an open-circuit layer along the axis",
        "structure/test_axial_walls.py",
    ),
    Mutation(
        "axial-shear",
        "structure/axial_stress.py",
        "w_z=-2.0 * shear",
        "w_z=2.0 * shear",
        "shear stress by the twist of a station's field",
        "structure/test_axial_stress.py",
    ),
    # what is kept of stations
    Mutation(
        "stations-alone",
        "solver/axial/solution.py",
        "spectra.normal[chosen]",
        "spectra.normal",
        "transforms of stations that are read alone: those of another station",
        "response/test_station_files.py",
    ),
    Mutation(
        "potential-rates",
        "response/thinning.py",
        "time_derivative(values, step) for name, values in potentials",
        "time_derivative(values, 2.0 * step) for name, values in potentials",
        "rates of voltages kept where instants are left out",
        "response/test_station_files.py",
    ),
)
