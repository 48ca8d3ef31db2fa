"""The slips of the paper's printed equations, in words (theory manual, section "Slips"). What was in the authors' program is not known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

InCode = Literal["possible", "implausible", "no effect"]


@dataclass(frozen=True)
class Slip:
    """One place where a printed equation does not follow from the others.

    Attributes
    ----------
    key : str
        Name of the switch.
    where : str
        Equations of the paper.
    printed, corrected : str
        What is printed, and what follows from the paper's own model.
    in_code : str
        Whether results like the paper's could come from a program with the printed form: "possible", "implausible", or "no effect" where
        nothing that the paper reports depends on it. A judgement on computed consequences, not on the program, which is not public.
    why : str
        What speaks for or against.
    """

    key: str
    where: str
    printed: str
    corrected: str
    in_code: InCode
    why: str


_ALL = (
    Slip(
        "permittivity",
        "Eq. A.11",
        "reduced permittivity mu33 - e33^2/c33",
        "mu33 + e33^2/c33, from sigma_33 = 0",
        "possible",
        "It only scales the sensor's gain, hence the effect of a given k_p and k_d. The paper's presets keep the printed form, so that its "
        "gains mean what they mean there.",
    ),
    Slip(
        "control-sign",
        "Eq. 19",
        "control term +e32 (k_p phi + k_d dphi/dt)",
        "-e32, as in Eqs. 4 and 13",
        "implausible",
        "With the printed sign and the paper's negative gains the loop is unstable within a small fraction of a transit; the paper shows "
        "five transits of damped motion.",
    ),
    Slip(
        "missing-traction",
        "Eqs. 4, 13, 19",
        "the actuator as a normal pressure -(e32/R) u on W alone",
        "the traction (1/R) dN/dtheta and the moment N z_a of its hoop force N = -e32 u too",
        "possible",
        "No piezoelectric layer can exert the pressure alone, and all printed curves of control are drawn with it. With all of it "
        "the paper's gains multiply the stress by five and more: its law is not one that its actuators can carry out.",
    ),
    Slip(
        "doubled-curvature",
        "Eqs. A.11, 5, 14, 20",
        "1/(R + z)^2 within the integral for zeta22, and 1/R^2 once more where zeta22 is used",
        "once",
        "no effect",
        "It touches only how piezoelectric layers see high orders, and on the inner shell alone (R = 0.5 m; the outer one has R = 1 m).",
    ),
    Slip(
        "printed-strain",
        "Eqs. A.1, A.3",
        "strain ((1 - z/R) dv/dtheta - w)/R: no curvature from w",
        "(dv/dtheta - w)/R - z (d2w/dtheta2 + dv/dtheta)/R^2, which Eqs. 3, 4, 18 and 19 have",
        "no effect",
        "The equations of motion that are said to be integrated have the full curvature; and shocks stretch these shells more than they "
        "bend them, so that no curve would show it.",
    ),
    Slip(
        "radius-factor",
        "Eqs. B.8, B.10",
        "(R1/R2)^2 in front of Xi^(1) and Xi^(i), the two response functions of the inner shell's motion",
        "no factor",
        "possible",
        "With it the inner shell is stressed over twice as much as the outer and its tail has extrema at the instants that the paper's "
        "text names; without it neither is so. The factor suits displacements scaled by R1, but all are scaled by R2 (Eq. 10).",
    ),
    Slip(
        "interior-derivative",
        "Eq. B.10",
        "I_m'(s) in the denominator of Xi^(i)",
        "I_m'(r1 s): the wall that moves is at r1",
        "implausible",
        "The water inside then answers its own wall only after the time 1 - r1, and feeds energy into the shell: the motion grows.",
    ),
    Slip(
        "interior-function",
        "Eq. B.13, P^(r,i)",
        "xi^(1), the gap's response function, in the pressure of the interior",
        "xi^(i)",
        "implausible",
        "It describes an annulus outside r1, not the disc inside; evaluated within the disc it grows without bound towards the axis, where "
        "the paper shows a focused wave.",
    ),
    Slip(
        "incident-potential",
        "Eq. 2",
        "psi_0 = -(lambda p S/(rho R)) e^{-x/lambda} H(x), its derivative taken behind the front",
        "-(lambda p S/(rho R)) (1 - e^{-x/lambda}) H(x)",
        "implausible",
        "The printed potential gives the pressure -p0 behind the front and a velocity of the wrong sign; a rigid head would feel about "
        "none of the incident pressure at first, not twice.",
    ),
    Slip(
        "incident-potential-impulse",
        "Eq. 2",
        "the same potential, with the impulse that its jump at the front gives",
        "as above",
        "implausible",
        "The front becomes an impulse of pressure of area lambda, which no curve of the paper shows.",
    ),
    Slip(
        "diffraction-sign",
        "Eqs. B.3, B.7",
        "psi_d = +B Xi_e with Xi_e = K_m(rs)/(s K_m'(s))",
        "psi_d = -B Xi_e, or Xi_e = -K_m(rs)/(s K_m'(s))",
        "implausible",
        "The diffracted pressure then cancels the incident one at the head instead of doubling it; the paper's verification against "
        "published rigid-cylinder pressures could not agree.",
    ),
    Slip(
        "outside-sum",
        "Eq. 19",
        "cos(m theta_n) outside the sum over n; read with n left at the last absorber, N",
        "inside the sum",
        "implausible",
        "All forces would act where one absorber sits, while each reads the motion where it is: many undamped absorbers then feed energy "
        "into the shells, and stresses grow far beyond what the paper shows for N = 25. For one absorber both readings agree.",
    ),
    Slip(
        "outside-sum-first",
        "Eq. 19",
        "the same, read with n = 1: all forces act at the first absorber, the head",
        "inside the sum",
        "implausible",
        "As above.",
    ),
    Slip(
        "missing-projection",
        "Eq. 19",
        "no 1/(beta pi) in front of the forces of the absorbers",
        "1/(beta pi), beta = 2 for m = 0, else 1, as in Eq. B.14",
        "possible",
        "It makes every absorber pull pi times as hard on the shells (2 pi times on order 0), while its own mass feels the true force "
        "(Eq. 21). Nothing in the printed curves excludes it by its looks.",
    ),
    Slip(
        "cosine-only",
        "Eq. 16 with Fig. 8",
        "cosine series for a system with one absorber off the axis",
        "cosines and sines",
        "possible",
        "The series is printed as the whole solution. It describes two absorbers of half the strength at +theta_n and -theta_n; rings that "
        "are symmetric about the axis are not touched.",
    ),
    Slip(
        "scattering-delay",
        "Eq. B.13, P^(d)",
        "b_m(t)/sqrt(r)",
        "b_m(t - (r - 1))/sqrt(r)",
        "implausible",
        "At the shell, r = 1, both are the same: no load, displacement or stress depends on it. Outside, the diffracted wave would be "
        "everywhere at once, far ahead of the reflected front that the paper's snapshots are said to show.",
    ),
    Slip(
        "radiation-sign",
        "Eq. B.13, P^(r,e) with B.7",
        "-(d2W/dt2 * xi_e) with Xi_e = +K_m(rs)/(s K_m'(s))",
        "+, or Xi_e with a minus",
        "implausible",
        "Taken together they give the exterior fluid a negative radiation resistance: the shell gains energy by radiating.",
    ),
)

SLIPS: Mapping[str, Slip] = MappingProxyType({slip.key: slip for slip in _ALL})
"""Slips by their key, in the order in which they are applied."""
