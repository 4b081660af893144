"""Basic twin of the gear: five and three states in plain NumPy, one file, nothing of `damperopt`.

Written from the equations of the theory page (Thota, Krauskopf & Lowenberg 2009) so that the composed model can be
compared with something short enough to be read in one go. All numbers are SI, angles in rad. Every function takes
complex numbers too, so that a Jacobian can be had to rounding by complex steps.

States: (psi, psi', delta, delta', y) of the fifth-order gear, (psi, psi', y) of the third-order gear. psi yaw angle, delta
lateral bending angle, y deflection of the tyre string at its leading point.
"""

from types import SimpleNamespace

import numpy as np

E_STEEL = 200e9
LAYOUT = {"L": 0.6, "gamma": np.deg2rad(31.0), "b": 0.2}
"""Torque-link length [m], angle [rad] and side distance [m] of thesis Table 0.1."""


def parameters(**changes):
    """Thesis Table 0.1 (the 2009 set of Thota et al., C_M with its physical sign), with some numbers changed."""
    table = {
        "I_z": 100.0,
        "I_x": 600.0,
        "k_psi": 3.8e5,
        "c_psi": 300.0,
        "k_delta": 6.1e6,
        "c_delta": 300.0,
        "l_g": 2.5,
        "e": 0.12,
        "R_w": 0.362,
        "phi": 0.0,
        "a": 0.1,
        "sigma": 0.3,
        "kappa": 570.0,
        "law": "nonlinear",
        "C_F": 0.002,
        "C_M": 1.0,
        "alpha_m": np.deg2rad(10.0),
        "torque": None,
    }
    return SimpleNamespace(**(table | changes))


def effective_caster(p):
    """Caster with rake, e cos(phi) + (R_w + e sin(phi)) tan(phi)."""
    return p.e * np.cos(p.phi) + (p.R_w + p.e * np.sin(p.phi)) * np.tan(p.phi)


def side_force(y, F_z, p):
    """F_y, positive for a positive string deflection."""
    if p.law == "straight_tangent":
        return p.C_F * y / p.sigma
    alpha = np.arctan(y / p.sigma)
    if p.law == "linear":
        return p.C_F * alpha * F_z
    X = np.arctan(7 * np.tan(alpha))
    return p.C_F * X * np.cos(0.95 * X) * F_z


def aligning_moment(y, F_z, p):
    """M_z, positive (restoring) for a positive string deflection."""
    if p.law == "straight_tangent":
        return p.C_M * y / p.sigma
    alpha = np.arctan(y / p.sigma)
    if p.law == "linear":
        return p.C_M * alpha * F_z
    if abs(np.real(alpha)) > p.alpha_m:
        return 0.0
    return p.C_M * p.alpha_m / np.pi * np.sin(np.pi * alpha / p.alpha_m) * F_z


def tyre_slopes(F_z, p):
    """(dF_y/dy, dM_z/dy) at y = 0."""
    if p.law == "straight_tangent":
        return p.C_F / p.sigma, p.C_M / p.sigma
    slope = 7 * p.C_F if p.law == "nonlinear" else p.C_F
    return slope * F_z / p.sigma, p.C_M * F_z / p.sigma


def right_hand_side(x, V, F_z, p):
    """x' of the five-state gear, or of the three-state gear if x has three entries."""
    if len(x) == 5:
        psi, psi_t, delta, delta_t, y = x
    else:
        (psi, psi_t, y), delta, delta_t = x, 0.0, 0.0
    cos, sin = np.cos, np.sin
    theta, e_eff = psi * cos(p.phi), effective_caster(p)
    F_y, M_z = side_force(y, F_z, p), aligning_moment(y, F_z, p)
    damper = p.torque(psi, psi_t) if p.torque else -p.k_psi * psi - p.c_psi * psi_t
    yaw = damper - e_eff * F_y - M_z - p.kappa * cos(p.phi) / V * psi_t + F_z * sin(p.phi) * e_eff * sin(theta)
    bending = -p.k_delta * delta - p.c_delta * delta_t
    bending += -p.l_g * F_y * cos(theta) * cos(p.phi) * cos(delta) + F_z * e_eff * sin(theta)
    y_t = V * sin(theta) + (e_eff - p.a) * psi_t * cos(theta) * cos(p.phi) - V / p.sigma * y * cos(theta)
    y_t += p.l_g * delta_t * cos(delta)
    if len(x) == 5:
        return np.array([psi_t, yaw / p.I_z, delta_t, bending / p.I_x, y_t])
    return np.array([psi_t, yaw / p.I_z, y_t])


def state_matrix(V, F_z, p, order=5):
    """Jacobian of the right-hand side at x = 0, worked out by hand; uses k_psi and c_psi, not the torque."""
    e_eff, cos_phi = effective_caster(p), np.cos(p.phi)
    F_y, M_z = tyre_slopes(F_z, p)
    A = np.zeros((5, 5))
    A[0, 1] = A[2, 3] = 1.0
    A[1, 0] = (-p.k_psi + F_z * np.sin(p.phi) * e_eff * cos_phi) / p.I_z
    A[1, 1] = -(p.c_psi + p.kappa * cos_phi / V) / p.I_z
    A[1, 4] = -(e_eff * F_y + M_z) / p.I_z
    A[3, 0] = F_z * e_eff * cos_phi / p.I_x
    A[3, 2], A[3, 3] = -p.k_delta / p.I_x, -p.c_delta / p.I_x
    A[3, 4] = -p.l_g * F_y * cos_phi / p.I_x
    A[4, 0], A[4, 1], A[4, 3], A[4, 4] = V * cos_phi, (e_eff - p.a) * cos_phi, p.l_g, -V / p.sigma
    kept = range(5) if order == 5 else (0, 1, 4)
    return A[np.ix_(kept, kept)]


def jacobian(x, V, F_z, p, step=1e-30):
    """Jacobian of the right-hand side by complex steps, exact to rounding."""
    x = np.asarray(x, complex)
    columns = [right_hand_side(x + 1j * step * unit, V, F_z, p).imag / step for unit in np.eye(len(x))]
    return np.array(columns).T


def spectral_abscissa(A):
    """Largest real part of the eigenvalues."""
    return np.linalg.eigvals(A).real.max()


def published_coefficients(topology, E=E_STEEL, **d):
    """(k_psi, c_psi) as the thesis prints them: (3-11), (3-12); (3-26), (3-30); (3-42), (3-45)."""
    ell = d["L"] * np.sin(d["gamma"])
    if topology == "boeing":
        return d["k_lambda"] * ell**2, d["c_lambda"] * ell**2
    if topology == "utas":
        R = np.hypot(ell, d["b"])
        sin_alpha = np.sin(np.arctan(ell / d["b"]))
        return 2 * E * d["I_arm"] * ell * sin_alpha / R**2, d["c_lambda"] * ell**2 * d["b"] / (10 * R)
    return 2 * E * d["I_arm"] / ell, d["c_lambda"] * ell**2


def planar_coefficients(topology, E=E_STEEL, **d):
    """(k_psi, c_psi) of the same pictures by virtual work, tip stiffness 3 E I/length^3."""
    ell = d["L"] * np.sin(d["gamma"])
    if topology == "boeing":
        return d["k_lambda"] * ell**2, d["c_lambda"] * ell**2
    if topology == "utas":
        R = np.hypot(ell, d["b"])
        lever = ell * np.sin(np.arctan(ell / d["b"]))
        return 3 * E * d["I_arm"] / R**3 * lever**2, d["c_lambda"] * (ell * d["b"] / R) ** 2
    return 3 * E * d["I_arm"] / ell, d["c_lambda"] * ell**2


def planar_torque(topology, E=E_STEEL, **d):
    """Torque of the planar linkage as a function (psi, psi') -> N m: restoring force times lever arm of every element."""
    k_0, c_0 = planar_coefficients(topology, E, **d)
    ell, b = d["L"] * np.sin(d["gamma"]), d.get("b")

    def torque(psi, rate):
        # every spring is stretched by lever sin(psi); the damper of UTAS lies on the chord from the apex to (0, b)
        damping = c_0 * np.cos(psi) ** 2
        if topology == "utas":
            damping = d["c_lambda"] * (ell * b * np.cos(psi)) ** 2 / (ell**2 + b**2 - 2 * ell * b * np.sin(psi))
        return -k_0 * np.sin(psi) * np.cos(psi) - damping * rate

    return torque
