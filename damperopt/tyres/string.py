"""A string on a contact line of finite length: what the ground has laid down under it, and the force that follows.

The foremost contact point lies at q1 = y + eta + a theta (y deflection of the string there, eta lateral position of the contact
centre, theta swivel, a half the contact length). The ground keeps it, so that a moment later it lies further back in the
footprint: q(x, t) = q1(t - (a - x)/V). Outside the footprint the string decays with the relaxation length sigma; the
deflections at the ends are v1 = y and v2, that inside is v(x) = q - eta - x theta.

Force and moment are those of the whole string, with the scales c_F = C_Fa/(2 (a + sigma)^2) and
c_M = C_Ma/(2 a (sigma (a + sigma) + a^2/3)); with a carcass stiffness both are that number.

Wheel frame, nonlinear: points of the ground move backwards at V cos(theta) along the wheel plane and at V sin(theta) across it,
v_t = V (sin(theta) + cos(theta) v_x) - eta' - x cos(theta) theta'. With the slope v_x = -y/sigma of the string before the
footprint this is the equation of the leading point, thesis (2-14). As the load changes, front and rear move against the wheel
at a' and -a': at a fixed x/a the slope is met at V cos(theta) + x a'/a. Source of the linear line: von Schlippe &
Dietrich (1941); Takacs, Orosz & Stepan (2009).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ..expressions.calculus import Expr, absolute, atan, cos, exp, sin, where
from ..ports.wheel import Wheel
from ..quantities.named import State
from .base import ContactLine, Linear, Slips

__all__ = ["Footprint", "StringLine", "Weights", "transit"]

SMALL = 0.3
"""Magnitude of z below which closed forms of `transit` lose digits, and series are summed."""

TERMS = 14
"""Of these series: the next one is below 1e-19 at `SMALL`."""


@dataclass(frozen=True)
class Weights:
    """What force and moment take from the deflection of the line; expressions.

    F_y = c_F (front v1 + rear v2 + inside int v dx),  M_z = -c_M (ends (v1 - v2) + twist int x v dx).

    Attributes
    ----------
    front, rear, ends : Expr
        [m], [m], [m^2]
    inside, twist : Expr
        [1]
    """

    front: Expr
    rear: Expr
    inside: Expr
    ends: Expr
    twist: Expr


@dataclass(frozen=True)
class Footprint:
    """A linear tyre whose line is held by its foremost point q1; expressions.

    F_y = (force[0] + force[1] E + force[2] phi1) q1 - side eta - swivel theta,
    M_z = turn theta - (moment[0] + moment[1] E + moment[2] chi) q1, with E, phi1, chi of `transit`.

    Attributes
    ----------
    force, moment : tuple of Expr
        (3,) [N/m], [N].
    side, swivel, turn : Expr
        [N/m], [N/rad], [N m/rad].
    softness : Expr
        1/sigma [1/m].
    reach : Expr
        1 + a/sigma [1].
    length : Expr
        2 a [m].
    """

    force: tuple[Expr, Expr, Expr]
    moment: tuple[Expr, Expr, Expr]
    side: Expr
    swivel: Expr
    turn: Expr
    softness: Expr
    reach: Expr
    length: Expr


def transit(z: Expr) -> tuple[Expr, Expr, Expr]:
    """E, phi1, chi: where a path exp(s x) has got to at the rear end of the line, and its mean and first moment along it.

    Parameters
    ----------
    z : Expr
        2 a s, complex numbers or arrays of them [1].

    Returns
    -------
    tuple of Expr
        E = e^-z, phi1 = (1 - E)/z, chi = (1 + E)/z - 2 (1 - E)/z^2.

    Examples
    --------
    >>> import math
    >>> E, phi1, chi = transit(2.0)
    >>> round(phi1, 12) == round((1 - math.exp(-2)) / 2, 12)
    True
    """
    E, near = exp(-z), absolute(z) < SMALL
    away = where(near, 1.0 + 0 * z, z)
    phi1, chi, term = 0 * z, 0 * z, 1 + 0 * z
    for k in range(TERMS):  # sum of (-z)^k/k! times 1/(k + 1), and times 1/(k + 1) - 2/(k + 2)
        phi1, chi = phi1 + term / (k + 1), chi - term * k / ((k + 1) * (k + 2))
        term = -term * z / (k + 1)
    return E, where(near, phi1, (1 - E) / away), where(near, chi, (1 + E) / away - 2 * (1 - E) / away**2)


class StringLine(ContactLine):
    """A contact line that a string is laid on: kinds say by `weights` what force and moment take from it.

    In transients the line is a field: u = v - y is a sum of `order` Legendre polynomials in x/a that keeps u(a) = 0, and the
    transport equation holds but for the polynomial of the order itself (Lanczos' tau method). Its delay is then exactly the
    diagonal Pade approximation of `order`, with an error of (n!)^2/((2 n)! (2 n + 1)!) (2 a w/V)^(2 n + 1) at the frequency w.
    """

    SPEED_POWERS: ClassVar = (0, 1)
    RATIONAL: ClassVar = False

    order: int

    def weights(self, sigma: Expr, a: Expr) -> Weights:
        """Of a string with relaxation length sigma [m] and half contact length a [m]."""
        raise NotImplementedError  # every line says it

    def footprint(self, linear: Linear) -> Footprint:
        """Of a linear tyre, for exact analysis with the delay.

        Parameters
        ----------
        linear : Linear

        Returns
        -------
        Footprint
        """
        C_Fa, C_Ma, sigma, a = linear
        per_F, per_M = _per_slip(sigma, a)
        c_F, c_M, p = C_Fa / per_F, C_Ma / per_M, self.weights(sigma, a)
        return Footprint(
            force=(c_F * p.front, c_F * p.rear, c_F * p.inside * 2 * a),
            moment=(c_M * p.ends, -c_M * p.ends, c_M * p.twist * 2 * a**2),
            side=c_F * (p.front + p.rear + 2 * a * p.inside),
            swivel=c_F * a * (p.front - p.rear),
            turn=c_M * (2 * a * p.ends + 2 * a**3 / 3 * p.twist),
            softness=1 / sigma,
            reach=1 + a / sigma,
            length=2 * a,
        )

    def response(self, s: Expr, linear: Linear, speed: Expr = 1.0) -> tuple[Expr, Expr, Expr, Expr]:
        """With the delay: rank one in the foremost point, q1 = (eta + (a + sigma) theta)/(1 + sigma s)."""
        part = self.footprint(linear)
        E, phi1, chi = self.delay(s * part.length)
        by_theta, by_eta = part.reach / (part.softness + s), part.softness / (part.softness + s)
        f = part.force[0] + part.force[1] * E + part.force[2] * phi1
        m = part.moment[0] + part.moment[1] * E + part.moment[2] * chi
        found = f * by_theta - part.swivel, f * by_eta - part.side, part.turn - m * by_theta, -m * by_eta
        if self.side_damping() is None:
            return found
        damped = self._damped(linear, s, (1, 0), E * by_theta), self._damped(linear, s, (0, 1), E * by_eta)
        more = speed * damped[0][0], speed * damped[1][0], speed * damped[0][1], speed * damped[1][1]
        return found[0] + more[0], found[1] + more[1], found[2] + more[2], found[3] + more[3]

    def _damped(self, linear: Linear, s: Expr, motion: tuple[int, int], rear: Expr) -> tuple[Expr, Expr]:
        """Force and moment of the damping per speed, at a motion (theta, eta) that takes the rear end of the line to `rear`."""
        C_Fa, C_Ma, sigma, a = linear
        theta, eta = motion
        slide, v2 = theta - s * eta, rear - eta + a * theta
        tan_F, tan_M = self._from_sliding(sigma, a, slide, s * theta, (s - 1 / sigma) * v2)
        return C_Fa * tan_F, C_Ma * tan_M

    def side_damping(self) -> Expr | None:
        """b/c of a string with the damping b and the stiffness c per length [s]; None: it has none."""
        return None

    def _from_sliding(self, sigma: Expr, a: Expr, slide: Expr, turn: Expr, rear: Expr) -> tuple[Expr, Expr]:
        """tan(alpha_F) and tan(alpha_M) of the damping: b times the rate at which the string is sheared, point by point.

        A point x that the ground holds has the rate slide - x turn, and so has the string before it; behind the line v2 decays:
        its rate there is `rear`, v2' - V v2/sigma. Source: Takacs, Orosz & Stepan (2009).
        """
        per_F, per_M, p, beta = *_per_slip(sigma, a), self.weights(sigma, a), self.side_damping()
        assert beta is not None
        front = slide - a * turn
        tan_F = beta * (p.front * front + p.rear * rear + p.inside * 2 * a * slide) / per_F
        tan_M = -beta * (p.ends * (front - rear) - p.twist * 2 * a**3 / 3 * turn) / per_M
        return tan_F, tan_M

    def delay(self, z: Expr) -> tuple[Expr, Expr, Expr]:
        """E, phi1, chi at z = 2 a s; those of the exact line."""
        return transit(z)

    def states(self) -> tuple[State, ...]:
        """y, and the Legendre coefficients of the deflection relative to it, of one wheel."""
        inside = (State(f"contact_line_{k}", "m", "contact line", hidden=True) for k in range(self.order))
        return (State("string_deflection", "m", "string"), *inside)

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Slips:
        """The wheel-frame equation of the line; tan(alpha_F) = F/C_Fa and tan(alpha_M) = M/C_Ma of the linear string."""
        # V speed, theta swivel, eta lateral position, a half contact length, sigma relaxation length, P_k Legendre polynomials
        y, *c = x
        _, _, sigma, a = linear
        V, theta, theta_t, eta_t = wheel.speed, wheel.swivel, wheel.swivel_rate, wheel.lateral_rate
        U, a_t = V * cos(theta), linear.half_contact_length_rate
        front = (U + a_t) / sigma * y
        y_t = V * sin(theta) - eta_t - a * cos(theta) * theta_t - front
        c = [*c, -sum(c)]  # u(a) = 0
        rates = []
        for j in range(self.order):
            slope = (2 * j + 1) * sum(c[j + 1 :: 2])  # of u over x/a, its part in P_j
            stretch = j * c[j] + (2 * j + 1) * sum(c[j + 2 :: 2])  # of x/a times this slope
            rates.append(U / a * slope + a_t / a * stretch)
        rates[0] = rates[0] + front + a * cos(theta) * theta_t
        if self.order > 1:
            rates[1] = rates[1] - a * cos(theta) * theta_t

        v2 = y + sum(c[0::2]) - sum(c[1::2])
        per_F, per_M, p = *_per_slip(sigma, a), self.weights(sigma, a)
        tan_F = (p.front * y + p.rear * v2 + p.inside * 2 * a * (y + c[0])) / per_F
        tan_M = -(p.ends * (y - v2) + p.twist * 2 * a**2 / 3 * c[1]) / per_M
        if self.side_damping() is not None:
            c_t = [*rates, -sum(rates)]
            v2_t = y_t + sum(c_t[0::2]) - sum(c_t[1::2])
            slide, turn = V * sin(theta) - eta_t, cos(theta) * theta_t
            more_F, more_M = self._from_sliding(sigma, a, slide, turn, v2_t - U / sigma * v2)
            tan_F, tan_M = tan_F + more_F, tan_M + more_M
        return Slips((y_t, *rates), atan(tan_F), atan(tan_M))


def _per_slip(sigma: Expr, a: Expr) -> tuple[Expr, Expr]:
    """C_Fa/c_F [m^2] and C_Ma/c_M [m^3]: of a string of stiffness c_F per length, and of c_M."""
    return 2 * (a + sigma) ** 2, 2 * a * (sigma * (a + sigma) + a**2 / 3)
