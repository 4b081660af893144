"""Basic twin of a gear on a string with contact memory: plain NumPy, one file, nothing of `damperopt`.

The linear gear of `basic_twin` with the exact contact line, twice: as a characteristic function, written out by hand, and as a
matrix, with the contact line collocated at Chebyshev points and integrated with Clenshaw and Curtis' weights.
"""

from functools import cache

import numpy as np
from basic_twin import effective_caster, parameters, tyre_slopes

T = {"law": "straight_tangent", "C_F": 2100.0, "C_M": 1.5e5}
"""The thesis' main gear (Table 0.1) at 150 kN as stiffnesses: C_Fa [N/rad], C_Ma [N m/rad]."""
CARCASS = 1.4e6
S = T | {"C_F": 2 * CARCASS * 0.4**2, "C_M": 2 * CARCASS * 0.1 * (0.3 * 0.4 + 0.01 / 3)}
"""The same with a string of the size of a real tyre, c_c = 1.4e6 N/m^2."""
O = T | {"k_psi": 1.4507e6, "c_psi": 2047.7}
"""With stiffness and damping of a design that a straight tangent had proved stable with a margin of 0.1 1/s."""
F_Z = 150e3


def study_text(p, low=5.0, high=100.0, load=F_Z, contact="memory", order=5):
    """The twin's numbers as a study."""
    lateral = f"lateral: {{inertia: {p.I_x!r}, stiffness: {p.k_delta!r}, damping: {p.c_delta!r}, height: {p.l_g!r}}}"
    return f"""
name: twin
gear: {{order: {order}, yaw_inertia: {p.I_z!r}, caster_length: {p.e!r}, rake_angle: {p.phi!r}, wheel_radius: {p.R_w!r}
       {", " + lateral if order == 5 else ""}}}
tyre: {{law: stiffness, half_contact_length: {p.a!r}, relaxation_length: {p.sigma!r}, cornering_stiffness: {float(p.C_F)!r},
       aligning_stiffness: {float(p.C_M)!r}, tread_width_moment: {p.kappa!r}, contact: {contact}}}
damper: {{topology: rotational, torsional_stiffness: {p.k_psi!r}, torsional_damping: {p.c_psi!r}}}
envelope: {{speed: {{min: {low!r}, max: {high!r}}}, vertical_load: {load!r}}}
"""


def gear(numbers=None, **changes):
    """Numbers of a gear: Table 0.1 with some changed."""
    return parameters(**(numbers or T), **changes) if not changes else parameters(**((numbers or T) | changes))


def _scales(p, F_z):
    force, moment = (slope * p.sigma for slope in tyre_slopes(F_z, p))
    a, sigma = p.a, p.sigma
    return force / (2 * (a + sigma) ** 2), moment / (2 * a * (sigma * (a + sigma) + a**2 / 3))


def characteristic(l, V, F_z, p, order=5):
    """D(lambda), entire; of degree 5 or 3 in lambda with the coefficient sigma I_z (I_x)/V."""
    a, sigma, c, e, s = p.a, p.sigma, np.cos(p.phi), effective_caster(p), l / V
    c_F, c_M = _scales(p, F_z)
    z = 2 * a * s
    E = np.exp(-z)
    f = 2 * a * (1 - E) / z + sigma * (1 + E)
    m = 2 * a**2 * ((1 + E) / z - 2 * (1 - E) / z**2) + sigma * (a + sigma) * (1 - E)
    S_F, S_M = 2 * c_F * (a + sigma), c_M * (2 * a**3 / 3 + 2 * a * sigma * (a + sigma))
    K11 = p.I_z * l**2 + (p.c_psi + p.kappa * c / V) * l + p.k_psi - F_z * np.sin(p.phi) * e * c + e**2 * c * S_F + S_M * c
    b1, g1 = c_F * e * f - c_M * m, (a + sigma - e) * c
    if order == 3:
        return (1 + sigma * s) * K11 + g1 * b1
    K12, K21 = e * S_F * p.l_g, p.l_g * c**2 * e * S_F - F_z * e * c
    K22 = p.I_x * l**2 + p.c_delta * l + p.k_delta + p.l_g**2 * c * S_F
    b2, g2 = c_F * p.l_g * c * f, -p.l_g
    return (1 + sigma * s) * (K11 * K22 - K12 * K21) + g1 * (K22 * b1 - K12 * b2) + g2 * (K11 * b2 - K21 * b1)


@cache
def _chebyshev(n):
    """Points from 0 to 1, their differentiation matrix, and Clenshaw-Curtis weights."""
    k = np.arange(n + 1)
    u = (1 - np.cos(np.pi * k / n)) / 2
    ends = np.where((k == 0) | (k == n), 2.0, 1.0) * (-1.0) ** k
    D = np.outer(ends, 1 / ends) / (u[:, None] - u[None, :] + np.eye(n + 1))
    D -= np.diag(D.sum(axis=1))
    moments = np.array([0 if j % 2 else 1 / (1 - j**2) for j in k])
    weights = np.linalg.solve(np.cos(np.outer(k, np.pi * k / n)), moments)
    return u, D, weights


def matrix(V, F_z, p, order=5, nodes=40):
    """State matrix with the contact line at `nodes` points behind its foremost one."""
    a, sigma, c, e, tau = p.a, p.sigma, np.cos(p.phi), effective_caster(p), 2 * p.a / V
    c_F, c_M = _scales(p, F_z)
    u, D, w = _chebyshev(nodes)
    N = 4 + nodes + 1
    psi, psi_t, delta, delta_t = np.eye(4, N)
    eta, theta = -(e * c * psi + p.l_g * delta), c * psi
    q = np.eye(N)[4:]
    v1, v2 = q[0] - eta - a * theta, q[-1] - eta + a * theta
    x = a - 2 * a * u
    F = c_F * (2 * a * (w @ q) - 2 * a * eta + sigma * (v1 + v2))
    M = -c_M * (2 * a * ((w * x) @ q) - 2 * a**3 / 3 * theta + sigma * (a + sigma) * (v1 - v2))
    A = np.zeros((N, N))
    A[0], A[2] = psi_t, delta_t
    A[1] = -(p.k_psi * psi + p.c_psi * psi_t + p.kappa * c / V * psi_t + e * F + M - F_z * np.sin(p.phi) * e * theta) / p.I_z
    A[3] = -(p.k_delta * delta + p.c_delta * delta_t + p.l_g * c * F - F_z * e * theta) / p.I_x
    A[4] = V / sigma * (eta + (a + sigma) * theta - q[0])
    A[5:] = -(D @ q)[1:] / tau
    kept = np.arange(N) if order == 5 else np.array([0, 1, *range(4, N)])
    return A[np.ix_(kept, kept)]


def rightmost(V, F_z, p, order=5, nodes=40, count=5):
    """Rightmost eigenvalues from right to left."""
    found = np.linalg.eigvals(matrix(V, F_z, p, order, nodes))
    return found[np.argsort(-found.real)][:count]
