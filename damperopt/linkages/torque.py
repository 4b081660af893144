"""Torque of a damper on the gear: the linkage with everything that stands in series or in parallel with it.

From the gear to the damper: the angle of the attachment (yaw psi), torque links of stiffness k_t with the torsion of the strut
(at the apex, laterally; thesis (3-14)), apex freeplay, the linkage at its own angle psi_l with spring or arm, end stop and
damper, and in series with the damper the stiffness k_s of oil column, rod and what holds it. Torques by virtual work.

The nodes between are massless: a chain adds one state, whether its compliance stands before the linkage, behind it or both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, TypeAlias

from ..dampers.base import Context
from ..expressions.calculus import Expr, implicit_slopes, partial, symbol, value_at
from ..expressions.corners import Corners
from ..ports.linkage import Linkage, Path
from ..ports.motion import Attachment, Torque
from ..quantities.named import Output, State
from .joints import beyond_gap, stop_force

__all__ = ["CHAIN_STATES", "OUTPUTS", "ROTARY_OUTPUTS", "damper_torque"]

Changes: TypeAlias = Sequence[tuple[Expr, Expr]]
"""Symbols, and their rates."""

RATE_STEPS = 24
"""Of Newton's method for the rate of a damper without an inverse: the first-order guess lies far outside where the force grows
with a high power p of the rate, and each step then takes 1/p off."""

CHAIN_STATES = (
    State("dashpot_stroke", "m", "damper"),
    State("link_angle", "rad", "damper"),
    State("apex_deflection", "m", "damper"),
    State("dashpot_angle", "rad", "damper"),
)
"""States that compliances add: one of these; the last is that of a rotary damper."""

ROOT_STEPS = 5
"""Newton steps to where a held chain stands."""

OUTPUTS = (
    Output("damper_stroke", "m", "from rest"),
    Output("damper_speed", "m/s"),
    Output("damper_force", "N", "against the stroke"),
    Output("spring_deflection", "m", "of the spring, or of the tip of the bending arm"),
    Output("spring_force", "N"),
    Output("stop_force", "N", "of the end stop"),
)
"""What a linkage shows."""

ROTARY_OUTPUTS = (
    Output("damper_angle", "rad", "from rest"),
    Output("damper_rate", "rad/s"),
    Output("damper_torque", "N m", "against the motion"),
    Output("spring_angle", "rad"),
    Output("spring_torque", "N m"),
    Output("stop_torque", "N m", "of the end stop"),
)
"""The same where spring and damper act about the yaw axis itself."""


def damper_torque(
    damper: Any,
    link: Linkage,
    design: Mapping[str, Expr],
    corners: Corners,
    attachment: Attachment,
    context: Context,
    changes: Changes = (),
) -> Torque:
    """Torque of `link`, with the joints and compliances of `damper`, on a gear.

    Parameters
    ----------
    damper : Assembly
        Floats or symbols.
    link : Linkage
    design : mapping of str to Expr
        Design variables by name [SI].
    corners : Corners
        Version of the nonlinear elements.
    attachment : Attachment
        Angle [rad] and rate [rad/s] that the gear gives.
    context : Context
    changes : sequence of tuple
        Symbols in `link` that change in time by themselves, such as the stroke of the shock strut, each with its rate.

    Returns
    -------
    Torque
    """
    return _Chain(damper, link, {**design, **link.as_printed}, corners, attachment, context, changes).torque()


class _Chain:
    """One chain from the gear to the damper, as it is being written down."""

    states: ClassVar = {state.name: state for state in CHAIN_STATES}

    def __init__(
        self,
        damper: Any,
        link: Linkage,
        design: Mapping[str, Expr],
        corners: Corners,
        attachment: Attachment,
        context: Context,
        changes: Changes = (),
    ):
        self._changes = list(changes)
        self._damper, self._link, self._design = damper, link, design
        self._corners, self._attachment, self._context = corners, attachment, context
        self._own = {state.name: symbol(state.name) for state in damper.STATES}
        self._unknowns: list[tuple[Expr, Expr, Expr]] = []  # symbol, value at rest, residual
        self._newton_steps: int | None = None

    def torque(self) -> Torque:
        """With rigid links the linkage stands at the angle of the gear; behind elastic ones it moves by itself."""
        return self._behind_rigid_links() if self._link.links is None else self._behind_elastic_links()

    def _behind_rigid_links(self) -> Torque:
        """The damper moves with the gear, or its dashpot d by itself: k_s (s - d) = F(d')."""
        damper, link, k_s = self._damper, self._link, self._link.series
        driving, engaged = self._attachment.angle, 1
        if damper.play is not None:
            driving, engaged = beyond_gap(damper.play, link.reach, self._corners, driving)
        self._let_loop_follow(link.closure(driving))
        position = link.at(driving)
        s, lever = position.stroke, position.damper_lever
        F_spring, F_stop = link.stiffness * position.deflection, stop_force(damper.stop, self._corners, s)
        chain: dict[str, tuple[Expr, Expr, Expr]] = {}  # state: symbol, rate, value when at rest
        if k_s is None:
            dashpot, v = s, engaged * lever * self._attachment.rate + self._drift(s)
            F_d = self._force(s, v).force
        elif not damper.FEELS_RATE:  # where it stands follows from what holds it
            dashpot = symbol("dashpot_stroke")
            F_d = k_s * (s - dashpot)
            own = self._force(dashpot, 0)
            self._unknowns.append((dashpot, 0, (F_d - own.force) / k_s))
            moved = k_s * engaged * lever * self._attachment.rate - self._by_states(own.force, own.rates) + self._drift(F_d)
            v = moved / (k_s + partial(own.force, dashpot))
        else:
            name = "dashpot_angle" if damper.ROTARY else "dashpot_stroke"
            dashpot = symbol(name)
            F_d = k_s * (s - dashpot)
            v = self._speed(dashpot, F_d)
            chain[name] = dashpot, v, _explicit_stroke(link, driving)
        torque = -engaged * (F_spring * position.spring_lever + (F_stop + F_d) * lever)
        shown = (s, v, F_d, position.deflection, F_spring, F_stop)
        return self._answer(torque, chain, dashpot, v, shown, (link.unknowns, link.rest, link.closure(driving)))

    def _behind_elastic_links(self) -> Torque:
        """The linkage stands where the links hold it: at its own coordinate u, without inertia.

        Virtual work along u gives the force in the damper, F_d = (T psi_l' - F_spring eps' - F_stop s')/s' with ' = d/du, as a
        function of psi and u; of a damper in series with k_s, F_d = k_s (s - d) and d' = v(F_d), the rate of u follows.
        """
        damper, link, k_s = self._damper, self._link, self._link.series
        u = symbol(link.coordinate)
        path = link.along(u)
        s, s_u = path.stroke, path.stroke_slope
        T, T_psi = self._through_links(path.angle)
        F_spring, F_stop = link.stiffness * path.deflection, stop_force(damper.stop, self._corners, s)
        F_d = (T * path.angle_slope - F_spring * path.deflection_slope) / s_u - F_stop
        if not damper.FEELS_RATE:
            return self._at_balance(u, path, F_d, T_psi * path.angle_slope / s_u, (F_spring, F_stop), -T)
        if k_s is None:
            dashpot = s
            v = self._speed(dashpot, F_d)
            rate = (v - self._drift(s)) / s_u
        else:
            dashpot = s - F_d / k_s
            v = self._speed(dashpot, F_d)
            F_psi = T_psi * path.angle_slope / s_u
            rate = (k_s * (v - self._drift(dashpot)) + F_psi * self._attachment.rate) / (k_s * s_u - partial(F_d, u))
        rest = _root(F_d, u)  # held for long, the damper carries nothing
        shown = (s, v, F_d, path.deflection, F_spring, F_stop)
        return self._answer(-T, {link.coordinate: (u, rate, rest)}, dashpot, v, shown)

    def _at_balance(self, u: Expr, path: Path, F_d: Expr, F_psi: Expr, others: tuple[Expr, Expr], torque: Expr) -> Torque:
        """Behind elastic links with a damper that does not feel its rate: u follows from the balance of forces."""
        k_s = self._link.series
        dashpot, slope = (path.stroke, 0) if k_s is None else (path.stroke - F_d / k_s, -F_psi / k_s)
        own = self._force(dashpot, 0)
        residual = F_d - own.force
        along = symbol("stroke")
        stiffness = value_at(partial(self._force(along, 0).force, along), along, dashpot)
        # of the balance, kept as time goes on: residual_u u' + residual_psi psi' + residual_states states' = 0
        psi_t = self._attachment.rate
        moved = (F_psi - stiffness * slope) * psi_t - self._by_states(own.force, own.rates) + self._drift(residual)
        u_t = -moved / partial(residual, u)
        self._unknowns.append((u, 0, residual * path.stroke_slope / (self._link.links * self._link.reach)))
        v = partial(dashpot, u) * u_t + slope * psi_t + self._drift(dashpot)
        shown = (path.stroke, v, F_d, path.deflection, *others)
        return self._answer(torque, {}, dashpot, v, shown)

    def _drift(self, expression: Expr) -> Expr:
        """Rate of an expression by what changes of itself."""
        return sum(partial(expression, of) * rate for of, rate in self._changes)

    def _let_loop_follow(self, closure: Sequence[Expr]) -> None:
        """Unknowns of a closed loop change too, with the angle held."""
        if self._changes and closure:
            slopes = [implicit_slopes(closure, self._link.unknowns, of) for of, _ in self._changes]
            rates = [rate for _, rate in self._changes]
            for k, unknown in enumerate(self._link.unknowns):
                self._changes.append((unknown, sum(slope[k] * rate for slope, rate in zip(slopes, rates, strict=True))))

    def _by_states(self, force: Expr, rates: Mapping[str, Expr]) -> Expr:
        """Rate of a force by the damper's own states alone."""
        return sum(partial(force, self._own[name]) * rate for name, rate in rates.items())

    def _answer(
        self,
        torque: Expr,
        chain: Mapping[str, tuple[Expr, Expr, Expr]],
        dashpot: Expr,
        v: Expr,
        shown: Sequence[Expr],
        loop: tuple[Sequence[Expr], Sequence[Expr], Sequence[Expr]] = ((), (), ()),
    ) -> Torque:
        own, (loop_unknowns, loop_rest, closure), unknowns = self._force(dashpot, v), loop, self._unknowns
        names = ROTARY_OUTPUTS if self._damper.ROTARY else OUTPUTS
        return Torque(
            torque,
            {name: x for name, (x, _, _) in chain.items()} | self._own,
            {name: rate for name, (_, rate, _) in chain.items()} | dict(own.rates),
            (*loop_unknowns, *(unknown for unknown, _, _ in unknowns)),
            (*loop_rest, *(rest for _, rest, _ in unknowns)),
            (*closure, *(residual for _, _, residual in unknowns)),
            dict(zip((o.name for o in names), shown, strict=False)) | dict(own.outputs),
            self._newton_steps,
            {name: rest for name, (_, _, rest) in chain.items()},
        )

    def _through_links(self, angle: Expr) -> tuple[Expr, Expr]:
        """Torque through elastic links [N m] and its slope over psi; the play stands in series with them."""
        link, twist, engaged = self._link, self._attachment.angle - angle, 1
        if self._damper.play is not None:
            twist, engaged = beyond_gap(self._damper.play, link.reach, self._corners, twist)
        K = link.links * link.reach**2
        return K * twist, K * engaged

    def _force(self, stroke: Expr, rate: Expr) -> Any:
        return self._damper.force(self._design, self._own, stroke, rate, self._context, self._corners)

    def _speed(self, stroke: Expr, force: Expr) -> Expr:
        """Rate of the damper at a force: in closed form, or as an unknown whose equation is the force itself."""
        rate = self._damper.rate(self._design, self._own, stroke, force, self._context, self._corners)
        if rate is None:
            rate, self._newton_steps = symbol("damper_speed"), RATE_STEPS
            damping = self._damper.damping(self._design)  # a symbol has no truth
            scale = 1.0 if damping is None else damping
            self._unknowns.append((rate, 0, (self._force(stroke, rate).force - force) / scale))
        return rate


def _root(residual: Expr, u: Expr) -> Expr:
    """Root near 0 of an expression in u, by Newton's method."""
    found: Expr = 0.0
    for _ in range(ROOT_STEPS):
        found = found - value_at(residual / partial(residual, u), u, found)
    return found


def _explicit_stroke(link: Linkage, angle: Expr) -> Expr:
    """Stroke of the damper at an angle, without unknowns."""
    if link.path is None:
        return link.at(angle).stroke
    u = symbol("coordinate")
    return value_at(link.path(u).stroke, u, _root(link.path(u).angle - angle, u))
