"""Torque links with arm, support and hinge line as a 3-D frame of the finite-element solver PyNite.

Axes as in the theory page: z up the strut axis, x aft, y to the side, apex at (ell, 0, 0), hinges at z = -+h. Round bars.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

from Pynite import FEModel3D

STIFF = 1e3
"""Second moment [m^4] and area [m^2] of what the design takes as rigid: millions of times those of the parts."""

SLICES = 32
"""Prismatic pieces of a tapered bar, each with the second moment that gives its own compliance."""


class Frame:
    """A frame in metres and newtons."""

    def __init__(self, E: float):
        self.fe, self._E = FEModel3D(), E
        self.fe.add_material("steel", E, E / 2.6, 0.3, 7850.0)
        self._sections = 0

    def node(self, name: str, at: tuple[float, float, float], held: str = "") -> str:
        """A node; `held` names what is fixed, such as ``DX DY DZ RX RZ``."""
        self.fe.add_node(name, *map(float, at))
        if held:
            self.fe.def_support(name, *(way in held.split() for way in ("DX", "DY", "DZ", "RX", "RY", "RZ")))
        return name

    def bar(self, name: str, start: str, end: str, A: float, I: float, truss: bool = False) -> None:
        """A beam, or a bar that carries along itself alone."""
        self._sections += 1
        section = f"section {self._sections}"
        self.fe.add_section(section, A, I, I, 2 * I)
        self.fe.add_member(name, start, end, "steel", section)
        if truss:
            self.fe.def_releases(name, Ryi=True, Rzi=True, Rxj=True, Ryj=True, Rzj=True)

    def rigid(self, name: str, start: str, end: str) -> None:
        """A bar that does not give way."""
        self.bar(name, start, end, STIFF, STIFF)

    def spring(self, name: str, start: str, end: str, k: float) -> None:
        """Along the line of its ends."""
        self.fe.add_spring(name, start, end, k)

    def tapered(self, name: str, root: str, tip: str, A: float, I: float, joint: bool = False) -> None:
        """A cantilever of uniform stress in similar sections, I ~ x^(4/3) from its tip, free or jointed; root A and I."""
        (a, b) = (self.fe.nodes[end] for end in (root, tip))
        ends = [root, *(f"{name} {i}" for i in range(1, SLICES)), tip]
        for i, node in enumerate(ends[1:-1], 1):
            s = i / SLICES
            self.node(node, (a.X + s * (b.X - a.X), a.Y + s * (b.Y - a.Y), a.Z + s * (b.Z - a.Z)))
        for i, (start, end) in enumerate(pairwise(ends)):
            far, near = 1 - i / SLICES, 1 - (i + 1) / SLICES  # from the tip
            # the mean of x^2/I over the slice is that of the taper: int x^(2/3) over int x^2
            ratio = (3 / 5 * (far ** (5 / 3) - near ** (5 / 3))) / ((far**3 - near**3) / 3)
            self.bar(f"{name} bar {i}", start, end, A, I / ratio)
        if joint:
            self.fe.def_releases(f"{name} bar {SLICES - 1}", Rxj=True, Ryj=True, Rzj=True)

    def solved(self) -> None:
        """With all loads at once."""
        self.fe.analyze_linear(check_stability=False)

    def moved(self, node: str, way: str) -> float:
        """Displacement or rotation."""
        return float(getattr(self.fe.nodes[node], way)["Combo 1"])


def half_beam(frame: Frame, name: str, middle: str, y: float, h: float, I: float, strut: float) -> str:
    """Half of a hinge line out to y, a tube that is held where it leaves the strut; its end."""
    end = frame.node(f"{name} end", (0, y, h))
    if strut:
        side = frame.node(f"{name} side", (0, math.copysign(strut / 2, y), h))
        frame.rigid(f"{name} inside", middle, side)
        middle = side
    frame.bar(name, middle, end, tube_area(I), I)
    return end


def torque_link(
    frame: Frame,
    name: str,
    hinge: str,
    apex: str,
    h: float,
    form: str,
    w: float,
    L: float,
    link: tuple[float, ...],
    strut: float,
) -> None:
    """From a hinge at height h, on the node `hinge` on the axis, to the apex: two legs, or one tapered link that bends."""
    A, I, I_hinge = link
    if form == "a_frame":
        for side, y in (("left", -w / 2), ("right", w / 2)):
            foot = half_beam(frame, f"{name} beam {side}", hinge, y, h, I_hinge, strut)
            frame.bar(f"{name} leg {side}", foot, apex, A, 1e-9, truss=True)
        return
    frame.tapered(name, hinge, apex, A, I, joint=True)


def tube_area(I: Any, ratio: float = 0.1) -> Any:
    """Area of a tube with wall over outer diameter `ratio`: A = pi d^2 r (1 - r), I = A d^2 (1 + (1 - 2 r)^2)/16."""
    shape = math.pi * ratio * (1 - ratio)
    return (16 * I * shape / (1 + (1 - 2 * ratio) ** 2)) ** 0.5


def layout(
    topology: str, design: dict[str, float], E: float, k_d: float, links: str, support: str, root: str, strut: float
) -> Frame:
    """All that stands between the piston and the strut, hinges half as wide as the links are long, turned by 1 kN m.

    Parameters
    ----------
    k_d : float
        Along the damper [N/m].
    """
    L, b = design["L"], design.get("b", 0.0)
    ell, h, w, legs = L * math.sin(design["gamma"]), L * math.cos(design["gamma"]), L / 2, links == "a_frame"
    frame, link = Frame(E), (design.get("A_link", 1.0), design.get("I_link", 1.0))
    link = (link[0] if legs else tube_area(link[1]), link[1] if not legs else 1e-9, design.get("I_hinge", 1.0))
    hinge = "DX DY DZ RX" + " RY" * legs  # legs have no stiffness against turning about the hinge; they need none
    frame.node("piston", (0, 0, -h), hinge)
    frame.node("apex", (ell, 0, 0))
    torque_link(frame, "lower", "piston", "apex", -h, links, w, L, link, strut)
    arm = design.get("I_arm", 1.0)
    if topology == "boeing":
        frame.node("strut", (0, 0, h), hinge + " RZ")
        frame.node("D", (ell, 0.01, 0))
        torque_link(frame, "upper", "strut", "D", h, links, w, L, link, strut)
        frame.fe.def_support("apex", support_RX=True, support_RY=True, support_RZ=True)
        frame.rigid("slider", "apex", "D")  # spring and damper let the ends of the links part sideways alone
        frame.fe.def_releases("slider", Dxj=True)
        frame.spring("spring", "apex", "D", design["k_lambda"])
    elif topology == "utas":
        frame.node("strut", (0, 0, h), "DX DY DZ RX RZ")
        root = half_beam(frame, "near", "strut", b, h, arm, strut)
        held = half_beam(frame, "far", "strut", -b, h, arm, strut)
        frame.bar("arm", root, "apex", tube_area(arm), arm)
    else:
        frame.node("strut", (0, 0, h), "DX DY DZ RX RZ")
        frame.bar("arm", "strut", "apex", tube_area(arm), arm)
        _support(frame, design, ell, h, support, root, strut)
        held = "D"
    frame.spring("damper", "apex", held if topology == "utas" else "D", k_d)
    frame.fe.add_node_load("piston", "MZ", 1e3)
    frame.solved()
    return frame


def _support(frame: Frame, design: dict[str, float], ell: float, h: float, form: str, root: str, strut: float) -> None:
    """Of the damper's outer end at (ell, -b, 0)."""
    L, b, fixed = design["L"], design["b"], "DX DY DZ RX RY RZ"
    if form == "cantilever":
        frame.node("D", (ell, -b, 0))
        if root == "hinge_line":
            frame.node("support middle", (0, 0, h), fixed)
            half_beam(frame, "support root", "support middle", -b, h, design["I_support"], strut)
        else:
            frame.node("support root end", (0, 0, 0), fixed)
        frame.tapered("support", "support root end", "D", tube_area(design["I_support"]), design["I_support"])
        return
    frame.node("D", (ell, -b, 0), "RX RY RZ")
    frame.node("support middle", (0, 0, h), fixed)
    for side, y in (("left", -L / 4), ("right", L / 4)):
        foot = half_beam(frame, f"support foot {side}", "support middle", y, h, design["I_foot"], strut)
        frame.bar(f"support leg {side}", foot, "D", design["A_support"], 1e-9, truss=True)
    frame.node("prop", (ell + h / L, -b, ell / L), fixed)  # across the plane of the legs, where nothing pulls
    frame.bar("prop", "prop", "D", 10.0, 1e-9, truss=True)


def compliance(
    topology: str,
    design: dict[str, float],
    E: float,
    links: str = "a_frame",
    support: str = "a_frame",
    root: str = "",
    strut: float = 0.0,
) -> tuple[float, float, float]:
    """(c11, c12, c22) of yaw angle psi and damper stroke e under torque T and damper force F, of two frames.

    psi = c11 T - c12 F, e = c12 T - c22 F, without the damper's own stiffness.
    """
    L, b = design["L"], design.get("b", 0.0)
    ell, h = L * math.sin(design["gamma"]), L * math.cos(design["gamma"])
    end = {"utas": (0.0, -b, h), "arreaza": (ell, -b, 0.0), "boeing": (ell, -1.0, 0.0)}[topology]
    away = [a - e for a, e in zip((ell, 0.0, 0.0), end, strict=True)]
    along = [x / math.hypot(*away) for x in away]

    def moved(k_d: float) -> tuple[float, float]:
        frame = layout(topology, design, E, k_d, links, support, root or "hinge_line", strut)
        held = "far end" if topology == "utas" else "D"
        stroke = sum(
            n * (frame.moved("apex", way) - frame.moved(held, way)) for n, way in zip(along, ("DX", "DY", "DZ"), strict=True)
        )
        return frame.moved("piston", "RZ") / 1e3, stroke / 1e3

    loose, held = 1e-3, 2e7
    c11, c12 = moved(loose)
    _, e = moved(held)
    return c11, c12, (c12 - e) / (held * e)
