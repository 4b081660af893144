"""Every layout in every geometry: members against lengths and levers, and all that any component must keep."""

import math

import casadi as ca
import chains
import matplotlib.pyplot as plt
import numpy as np
import pytest
import standard
from scipy.optimize import root
from standard import least, once
from whole import goes_through_the_commands, is_optimised, is_reported

from damperopt.figures.linkage import linkage
from damperopt.linkages.assembly import assemblies
from damperopt.linkages.elastic import elastic_linkage
from damperopt.linkages.spatial import FORESHORTENING
from damperopt.study.components import rooms

KINDS = rooms()["linkages"]
GEOMETRIES = ("published", "planar", "spatial")
ANGLES = (-0.15, -0.02, 0.04, 0.2)
DEFLECTIONS = (-0.02, 0.01)
"""Of the coordinate of a linkage behind elastic links [rad] or [m]."""

CLOSES = 1e-12
"""[m]; links of 0.6 m, a loop solved to rounding."""


def layout_blocks():
    """Every layout rigid in every geometry, and elastic by its sections; in full with the other forms of its parts."""
    for tag, kind in KINDS.items():
        damper = next(made.KIND for made in assemblies().values() if made.LAYOUT is kind and _usual(made))
        more = standard.example(damper)
        found = standard.blocks(kind, lambda block, more=more: standard.takes(damper=more | block))
        for geometry in GEOMETRIES[1:2] if kind.ROTARY else GEOMETRIES:
            if kind.ROTARY:
                yield from (pytest.param(more | block, id=f"{tag}{' full' * i}") for i, block in enumerate(found))
                continue
            chain = more | {"geometry": geometry}
            yield pytest.param(chain | found[0] | {"compliance": "rigid"}, id=f"{tag} {geometry} rigid")
            for i, block in enumerate(found):
                yield pytest.param(chain | block | {"compliance": "sized"}, id=f"{tag} {geometry} sized{' full' * i}")


def designs():
    """Cases to go through the commands: the thesis' model and the default one."""
    models = {("planar", "rigid"), ("spatial", "sized"), (None, None)}
    found = [(case, case.values[0]) for case in layout_blocks()]
    return [case for case, block in found if (block.get("geometry"), block.get("compliance")) in models]


def _usual(made):
    (tag,) = [tag for tag, kind in rooms()["dampers"].items() if kind is made.KIND]
    return tag == made.LAYOUT.DAMPER


BLOCKS = once(list(layout_blocks()))


@pytest.fixture(scope="module", params=BLOCKS)
def study(request):
    return standard.study_of(damper=request.param)


class Moved:
    """The linkage of a study at an angle, its loop closed by SciPy."""

    def __init__(self, study, psi):
        self.link = link = study.damper.linkage_of(study, study.start)
        z, angle = ca.vertcat(ca.SX(0, 1), *link.unknowns), ca.SX.sym("psi")
        place = link.at(angle)
        rows = ca.vertcat(*(ca.SX(v) for v in (place.deflection, place.spring_lever, place.stroke, place.damper_lever)))
        closure = ca.Function("closure", [z, angle], [ca.vertcat(ca.SX(0, 1), *link.closure(angle))])
        self.unknowns = np.array([float(value) for value in link.rest])
        for step in np.linspace(0, psi, 5)[1:] if self.unknowns.size else ():
            found = root(lambda u, step=step: closure(u, step).full().ravel(), self.unknowns, tol=1e-15)
            self.unknowns = found.x
            assert np.abs(closure(self.unknowns, step).full()).max() < CLOSES, "the loop does not close"
        values = ca.Function("place", [z, angle], [rows])(self.unknowns, psi).full().ravel()
        self.deflection, self.spring_lever, self.stroke, self.damper_lever = values
        self.named = {unknown.name(): value for unknown, value in zip(link.unknowns, self.unknowns, strict=True)}


def test_equations(study):
    standard.rest_is_an_equilibrium(study)
    standard.mirrored_motions_are_motions(study)
    standard.smooth_goes_to_exact(study)
    standard.declared_powers_are_kept_exactly(study)
    chains.states_of_the_chain(study)
    chains.energy_is_kept(study)
    standard.record_survives(study)


def test_compliance_is_that_of_the_sections_that_are_sized(study):
    """Sizes are design variables where the chain is elastic, and its stiffness grows with each of them."""
    damper, link = study.damper, elastic_linkage(study, study.start)
    sizes = {variable.name for variable in study.variables} - {variable.name for variable in damper.VARIABLES}
    assert bool(sizes) == damper.has_sized_parts()
    if not sizes:
        assert (link.links, link.series) == (None, None)
        return
    rest = 1 / link.links + 1 / link.series
    softer = {name: elastic_linkage(study, study.start | {name: study.start[name] / 2}) for name in sizes - {"s_damper"}}
    for name, made in softer.items():
        assert 1 / made.links + 1 / made.series > rest, name
    shared = {member.variable for member in damper.members(study.start)} - {""}
    assert shared <= sizes, "a member hangs on what is no design variable"


def test_linkage_in_floats_is_its_graph(study):
    names, E = list(study.start), study.material.youngs_modulus
    if not names:
        return
    rest = study.damper.linkage(study.start, E).rest

    def numbers(*values):
        design = dict(zip(names, values, strict=True))
        link = study.damper.linkage(design, E)
        lengths = [value for value in (link.arm_length, link.damper_length) if value is not None]
        printed = dict(link.as_printed)
        more = [] if rest else [link.at(psi) for psi in ANGLES]
        positions = [(p.deflection, p.spring_lever, p.stroke, p.damper_lever) for p in more]
        levers = link.stiffness, link.spring_lever, link.damper_lever, link.reach, link.torsional_stiffness
        members = [
            (m.start, m.end, m.share, *(v for v in (m.length, m.inertia, m.area) if v is not None))
            for m in study.damper.members(design)
        ]
        elastic = elastic_linkage(study, design)
        chain = [value for value in (elastic.links, elastic.series) if value is not None]
        along = [link.along(eps) for eps in DEFLECTIONS]
        path = [(p.angle, p.angle_slope, p.stroke, p.stroke_slope) for p in along]
        return levers, lengths, printed, positions, members, list(link.rest), chain, path

    start = np.array(list(study.start.values()))
    standard.agrees_with_its_graph(numbers, start, 1.1 * start)


def test_levers_are_slopes_of_lengths(study):
    h = 1e-5
    rest = Moved(study, 0.0)
    assert (rest.deflection, rest.stroke) == pytest.approx((0, 0), abs=CLOSES)
    assert (rest.spring_lever, rest.damper_lever) == pytest.approx(
        (float(rest.link.spring_lever), float(rest.link.damper_lever)), rel=1e-9
    )
    for psi in (0.0, *ANGLES):
        here, before, after = (Moved(study, psi + k * h) for k in (0, -1, 1))
        # central differences at 1e-5 rad: 1e-10 of curvature, 1e-10 of rounding
        assert (after.deflection - before.deflection) / (2 * h) == pytest.approx(here.spring_lever, rel=1e-7, abs=1e-8)
        assert (after.stroke - before.stroke) / (2 * h) == pytest.approx(here.damper_lever, rel=1e-7, abs=1e-8)


def distance(a, b):
    return math.dist([float(v) for v in a], [float(v) for v in b])


def test_members_meet_at_the_apex(study):
    damper, link = study.damper, study.damper.linkage_of(study, study.start)
    members = damper.members(study.start)
    if damper.ROTARY:
        assert not members, "nothing to draw about the yaw axis"
        return
    apex = (float(link.reach), 0.0, 0.0)
    for member in members:
        if member.kind in ("link", "arm"):
            assert distance(member.end, apex) < CLOSES, f"{member.name} does not end at the apex"
        elif member.kind == "damper":
            middle = [(float(a) + float(b)) / 2 for a, b in zip(member.start, member.end, strict=True)]
            assert min(distance(member.end, apex), distance(middle, apex)) < CLOSES, "the damper is not at the apex"
    assert len({member.name for member in members}) == len(members)
    assert sum(member.kind == "damper" for member in members) == 1
    for member in members:
        if member.kind in ("link", "arm") and member.length is not None:
            assert distance(member.start, member.end) == pytest.approx(float(member.length), abs=CLOSES)
        if member.kind == "damper" and link.damper_length is not None and damper.geometry == "spatial":
            assert distance(member.start, member.end) == pytest.approx(float(link.damper_length), abs=CLOSES)
        if member.kind == "arm" and damper.geometry == "spatial":
            assert float(link.arm_length) == pytest.approx(distance(member.start, member.end), abs=CLOSES)


def one(members, kind):
    return next((member for member in members if member.kind == kind), None)


def seen_from_the_top(member):
    """Direction of a member from its start to its end, without height."""
    x, y = (float(b) - float(a) for a, b in zip(member.start[:2], member.end[:2], strict=True))
    return x / math.hypot(x, y), y / math.hypot(x, y)


def test_planar_levers_are_those_of_the_members_from_the_top(study):
    """The apex moves sideways by reach psi: along the damper that is its stroke, across the arm its deflection."""
    damper, link = study.damper, study.damper.linkage_of(study, study.start)
    if damper.ROTARY or damper.geometry == "spatial":
        return
    members = damper.members(study.start)
    _, sideways = seen_from_the_top(one(members, "damper"))
    assert float(link.damper_lever) == pytest.approx(float(link.reach) * sideways, rel=1e-12)
    arm = one(members, "arm")
    along, _ = (1.0, 0.0) if arm is None else seen_from_the_top(arm)
    assert float(link.spring_lever) == pytest.approx(float(link.reach) * along, rel=1e-12)
    if arm is not None and link.damper_length is not None and damper.geometry == "planar":
        x, y = (float(b) - float(a) for a, b in zip(one(members, "damper").start[:2], link_apex(link)[:2], strict=True))
        assert float(link.damper_length) == pytest.approx(math.hypot(x, y), rel=1e-12)


def test_members_are_drawn_from_end_to_end(study):
    """In every view, and each part once in the legend."""
    members = study.damper.members(study.start)
    if not members:
        return
    drawn = linkage(study.damper, study.start)
    for axis, (i, j) in zip(drawn.axes, ((0, 2), (0, 1), (1, 2)), strict=True):
        lines = [np.round(line.get_xydata(), 9).tolist() for line in axis.lines]
        for member in members:
            ends = [[1e3 * float(point[i]), 1e3 * float(point[j])] for point in (member.start, member.end)]
            assert np.round(ends, 9).tolist() in lines, f"{member.name} is not drawn"
    (legend,) = drawn.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert len(set(words)) == len(words)
    assert all(any(member.name.startswith(word) for word in words) for member in members)
    plt.close(drawn)


def link_apex(link):
    return float(link.reach), 0.0, 0.0


@pytest.mark.parametrize("psi", ANGLES)
def test_moved_members_have_the_lengths_of_the_loop(study, psi):
    """In space: rigid links keep their length, a bent arm that of its chord, and the damper's stroke is what it grew by."""
    if study.damper.geometry != "spatial" or study.damper.ROTARY:
        return
    moved, members = Moved(study, psi), study.damper.members(study.start)
    if not {"apex_reach", "apex_height"} <= moved.named.keys():
        return  # a loop with unknowns of its own, which only its literature test knows
    q, z = moved.named["apex_reach"], moved.named["apex_height"]
    apex = q * math.cos(psi), q * math.sin(psi), z
    for lower in (member for member in members if member.kind == "link" and float(member.start[2]) < 0):
        x, y, height = map(float, lower.start)  # of a leg: beside the axis, with which it turns
        turned = x * math.cos(psi) - y * math.sin(psi), x * math.sin(psi) + y * math.cos(psi), height
        assert distance(turned, apex) == pytest.approx(float(lower.length), abs=CLOSES)
    uppers = [member for member in members if member.kind in ("link", "arm") and float(member.start[2]) > 0]
    hinge = np.mean([[float(value) for value in member.start] for member in uppers], axis=0)  # between legs
    length, eps = distance(hinge, uppers[0].end), moved.deflection
    along = length - FORESHORTENING * eps**2 / length if uppers[0].kind == "arm" else length
    beam = one(members, "beam")
    if beam is not None:  # whose end the arm's root moves back with, by M a^2/(2 E I); it and the arm give way along themselves
        side, I, strut = abs(hinge[1]), float(beam.inertia), study.damper.links.strut_width
        over = side if strut is None else (side - strut / 2 + math.hypot(side - strut / 2, 0.006)) / 2
        L, bent = math.sqrt(length**2 - side**2), 1 + 3 * over / length
        pushed = 3 * I / (math.sqrt(16 * I * math.pi * 0.09 / 1.64) * L * length**2 * bent)  # a tube, its wall a tenth
        back = 3 * over**2 / (2 * length**2 * bent) + pushed * (side * length + over * side) / L
        ahead = np.array([apex[0], 0.0, apex[2] - hinge[2]])
        hinge = hinge - back * eps * ahead / np.linalg.norm(ahead)
    assert distance(hinge, apex) == pytest.approx(math.hypot(along, eps), abs=CLOSES)
    strut = one(members, "damper")
    if distance(strut.end, link_apex(moved.link)) < CLOSES:
        assert distance(strut.start, apex) - distance(strut.start, strut.end) == pytest.approx(moved.stroke, abs=CLOSES)
    else:  # in the gap at the apex
        assert moved.stroke == pytest.approx(eps, abs=CLOSES)


@pytest.mark.parametrize("study", once(designs()), indirect=True)
def test_goes_through_the_commands(study, tmp_path):
    goes_through_the_commands(study, tmp_path)


@pytest.mark.parametrize("study", once(designs()), indirect=True)
def test_is_optimised(study, tmp_path):
    is_optimised(study, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("study", least(BLOCKS), indirect=True)
def test_is_reported(study, tmp_path):
    is_reported(study, tmp_path)
