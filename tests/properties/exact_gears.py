"""A second exact method for the certificate, which shares nothing with the package.

The linear gear without rake and with a linear tyre is written down again in rational numbers, its Hurwitz determinants
come from `fmpq_mat.det` at some speeds and are interpolated, and their zeros are isolated by Arb (`complex_roots`) where
`certify` counts with Sturm's chain.
"""

import math
from fractions import Fraction

import flint
from random_gears import rotational

from damperopt import linear_gear

TOUCH = 1e-9
"""[1/s] How far a counterexample may stay below the margin: zeros in speed are enclosed to 1e-9 of the range."""

Q = flint.fmpq


def rational(value):
    """The shortest decimal that returns a float, exactly: what somebody wrote."""
    return Q(*Fraction(str(float(value))).as_integer_ratio())


def abscissa_at(study, point):
    return float(linear_gear(study, {}).abscissa(*point)[0])


def fails_at_its_counterexample(study, certificate):
    """Whether the point named lies in the envelope and misses the margin there (or touches it)."""
    speed, load = certificate.counterexample
    inside = study.envelope.speed.min <= speed <= study.envelope.speed.max
    loads = study.envelope.loads
    inside &= loads[0] <= load <= loads[-1] if study.envelope.load_is_range else load in loads
    return inside and abscissa_at(study, (speed, load)) >= -certificate.margin - TOUCH


def exact_matrix(study, V, F_z):
    """State matrix in rational numbers, from section 2 of the theory page."""
    gear, tyre, damper = study.gear, study.tyre, study.damper
    I_z, e, a, sigma = map(rational, (gear.yaw_inertia, gear.caster_length, tyre.half_contact_length, tyre.relaxation_length))
    kappa, slope, C_M = map(rational, (tyre.tread_width_moment, tyre.cornering_slope, tyre.aligning_coefficient))
    k_psi, c_psi = map(rational, (damper.torsional_stiffness, damper.torsional_damping))
    yaw = [-k_psi / I_z, -(c_psi + kappa / V) / I_z], [-(e * slope + C_M) * F_z / (I_z * sigma)]
    if gear.order == 3:
        return [[Q(0), Q(1), Q(0)], [*yaw[0], *yaw[1]], [V, e - a, -V / sigma]]
    strut = gear.lateral
    I_x, k_delta, c_delta, l_g = map(rational, (strut.inertia, strut.stiffness, strut.damping, strut.height))
    return [
        [Q(0), Q(1), Q(0), Q(0), Q(0)],
        [*yaw[0], Q(0), Q(0), *yaw[1]],
        [Q(0), Q(0), Q(0), Q(1), Q(0)],
        [F_z * e / I_x, Q(0), -k_delta / I_x, -c_delta / I_x, -l_g * slope * F_z / (I_x * sigma)],
        [V, e - a, Q(0), l_g, -V / sigma],
    ]


def exact_hurwitz(study, V, F_z, margin):
    """[a_n, H_1, ..., H_n] of det(s - margin - A), by determinants of the Hurwitz matrix."""
    rows = exact_matrix(study, V, F_z)
    n = len(rows)
    moved = flint.fmpq_mat([[x + (margin if i == j else 0) for j, x in enumerate(row)] for i, row in enumerate(rows)])
    a = moved.charpoly().coeffs()[::-1]
    full = [[a[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else Q(0) for j in range(n)] for i in range(n)]
    return [a[n], *(flint.fmpq_mat([row[:m] for row in full[:m]]).det() for m in range(1, n + 1))]


def interpolated(values, speeds):
    vandermonde = flint.fmpq_mat([[V**k for k in range(len(speeds))] for V in speeds])
    solution = vandermonde.solve(flint.fmpq_mat([[value] for value in values]))
    return flint.fmpq_poly([solution[k, 0] for k in range(len(speeds))])


def exactly_stable(study, margin):
    """Whether every speed of the envelope is strictly stable with the margin at its (one) load."""
    low, high = rational(study.envelope.speed.min), rational(study.envelope.speed.max)
    F_z, margin, n = rational(study.envelope.loads[0]), rational(margin), study.gear.order
    if min(exact_hurwitz(study, low, F_z, margin)[1:]) <= 0:
        return False
    # V a_k is quadratic in V, so V a_n and V^(n-1) H_(n-1) have degrees 2 and 2 (n - 1)
    speeds = [Q(k) for k in range(1, 2 * n)]
    samples = [exact_hurwitz(study, V, F_z, margin) for V in speeds]
    for k, power in ((0, 1), (n - 1, n - 1)):
        polynomial = interpolated([s[k] * V**power for s, V in zip(samples, speeds, strict=True)], speeds)
        for root, _ in polynomial.numer().complex_roots():
            if root.imag == 0 and not (root.real < flint.arb(low) or root.real > flint.arb(high)):
                return False
    return True


def first_stable_float(study_at, margin, low, high):
    """Two neighbouring floats (c, c+) such that the exact method says no at c and yes at c+."""
    assert not exactly_stable(study_at(low), margin)
    assert exactly_stable(study_at(high), margin)
    while math.nextafter(low, high) < high:
        middle = (low + high) / 2
        if exactly_stable(study_at(middle), margin):
            high = middle
        else:
            low = middle
    return low, high


def quadratic_gear(base, M, speed, load=1.0):
    """I_z = k_psi = c_psi = sigma = 1, e = a, kappa = 0: stable iff V^2 + (1 - M F_z) V + 1 > 0 and M F_z > -1.

    M is C_M + e C_F', the moment per slip angle and load; from the closed form of the theory page, section 2.
    """
    tyre = {
        "contact": "leading_point",
        "half_contact_length": 0.5,
        "relaxation_length": 1.0,
        "tread_width_moment": 0.0,
        "cornering_slope": 2.0,
        "aligning_coefficient": M - 1.0,
    }
    return rotational(
        base, order=3, yaw_inertia=1.0, caster_length=0.5, stiffness=1.0, damping=1.0, tyre=tyre, speed=speed, load=load
    )
