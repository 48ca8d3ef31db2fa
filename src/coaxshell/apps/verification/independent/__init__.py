"""The same physics by other means: spectral elements in r, implicit Gauss integration in t; no Laplace transform, no Bessel function.

Only the description of a system is taken from the package; section integrals, modal stiffness, feedback, scaling and incident waves
are written out again from the theory.
"""

from coaxshell.apps.verification.independent.radial_elements import RadialElements

__all__ = ["RadialElements"]
