"""Stability over an interval of dampings: gears at random against scans, narrow windows in the damping, both ends stable."""

from __future__ import annotations

import numpy as np
import pytest
from random_gears import random_gear

from damperopt import ConfigError, certify, load
from damperopt.stability.linear import LinearModel

CHAINS = {
    "rigid": {"compliance": "rigid"},
    "series": {"compliance": {"link": "rigid", "arm": "rigid", "support": "rigid", "damper": 3e7}},
    "links": {"compliance": {"link": 4e7, "arm": "rigid", "support": "rigid", "damper": "rigid"}},
    "both": {"compliance": {"link": 4e7, "arm": "rigid", "support": "rigid", "damper": 3e7}},
}
"""The damping enters the first with c, the others with 1/c."""


@pytest.fixture(scope="module")
def base(configs):
    return load(configs / "thesis_gear.yaml").replace(requirements__decay=None)


def on_a_linkage(rng, base, chain, contact="leading_point"):
    """A legal gear at random on an arreaza linkage, with a design and an interval of dampings."""
    study = random_gear(rng, base, order=5)
    names = ("gear", "tyre", "envelope")
    changes = {name: getattr(study, name).model_dump(exclude_none=True) for name in names}
    changes["requirements"] = base.required.model_dump(exclude_none=True) | {"limit_torque": 1e4}
    changes["damper"] = {"topology": "arreaza", "geometry": "planar", **CHAINS[chain]}
    changes["envelope"] |= {"vertical_load": float(rng.uniform(5e4, 2e5))}
    low, high = float(rng.uniform(0.2, 1)), float(rng.uniform(1, 4))
    study = base.replace(**changes, tyre__contact=contact).replace(damper__damping_range=[low, high])
    design = {"c_lambda": 10 ** rng.uniform(3.5, 5.5), "I_arm": 10 ** rng.uniform(-7, -5.5), "L": 0.5, "gamma": 0.55, "b": 0.15}
    return study, {name: float(value) for name, value in design.items()}


def scanned(study, design, speeds=60, factors=25):
    """Abscissae on a grid of speeds and factors, (factors, speeds)."""
    model, (low, high) = LinearModel(study), study.damper.damping_factors()
    V = np.geomspace(study.envelope.speed.min, study.envelope.speed.max, speeds)
    (load,) = study.envelope.loads
    row = np.geomspace(low, high, factors)
    return np.array([model.at(design | {"c_lambda": c * design["c_lambda"]}).abscissa(V, load) for c in row])


def holds_true(study, design, margin):
    """Proof against grid, and witness against the eigenvalues of the gear with its damping."""
    certificate, height = certify(study, design, margin), scanned(study, design).max()
    scale = 1e-9 * (1 + abs(height))
    if certificate.verdict == "proved":
        assert height < -margin + scale, certificate.reason
    if certificate.verdict == "refuted":
        speed, load, factor = certificate.place
        low, high = certificate.damping
        assert low <= factor <= high
        there = LinearModel(study).at(design | {"c_lambda": factor * design["c_lambda"]}).abscissa(speed, load)[0]
        assert there > -margin - 1e-6 * (1 + abs(there)), certificate.reason
    if height > -margin + scale:
        assert certificate.verdict == "refuted", certificate.reason
    return certificate.verdict


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("count", [5, pytest.param(75, marks=pytest.mark.verify)])
def test_random_gears(base, chain, count):
    """The margin is set beside what the grid shows, so that both verdicts occur."""
    rng = np.random.default_rng(list(CHAINS).index(chain) + 10 * count)
    verdicts = []
    for i in range(count):
        study, design = on_a_linkage(rng, base, chain)
        top = scanned(study, design, 30, 9).max()
        verdicts.append(holds_true(study, design, -top - (1 if i % 2 else -1) * 0.05 * (0.1 + abs(top))))
    assert {"proved", "refuted"} <= set(verdicts)


@pytest.mark.parametrize("chain", ["rigid", "both"])
@pytest.mark.parametrize("count", [2, pytest.param(20, marks=pytest.mark.verify)])
def test_random_gears_with_memory(base, chain, count):
    rng = np.random.default_rng(7 + count)
    for i in range(count):
        study, design = on_a_linkage(rng, base, chain, "memory")
        study = study.replace(envelope__speed={"min": 20.0, "max": 60.0})
        top = scanned(study, design, 12, 7).max()
        holds_true(study, design, -top - (1 if i % 2 else -1) * 0.2 * (0.5 + abs(top)))


@pytest.fixture(scope="module")
def window(base):
    """A damper in series with a stiffness, and the least factor on its damping that keeps 0.1 1/s, by bisection."""
    study = base.replace(damper__compliance=CHAINS["series"]["compliance"], envelope__speed={"min": 20.0, "max": 60.0})
    design = {"c_lambda": 2e4, "I_arm": 5.6663e-7, "L": 0.4781, "gamma": 0.5321, "b": 0.15244}
    model, V = LinearModel(study), np.geomspace(20, 60, 4001)

    def height(factor):
        return model.at(design | {"c_lambda": factor * design["c_lambda"]}).abscissa(V, 1.5e5).max()

    low, high = 0.05, 1.0
    assert height(low) > -0.1 > height(high)
    for _ in range(36):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if height(middle) > -0.1 else (low, middle)
    return study, design, high, height


@pytest.mark.parametrize("share", [1e-2, 1e-4, 1e-6])
def test_narrow_windows_beyond_an_end(window, share):
    """The interval ends just before or just beyond the damping at which the margin is lost: proved, refuted at that end."""
    study, design, critical, height = window
    beyond = study.replace(damper__damping_range=[critical * (1 + share), 1.5])
    assert certify(beyond, design, 0.1).verdict == "proved"
    before = certify(study.replace(damper__damping_range=[critical * (1 - share), 1.5]), design, 0.1)
    assert before.verdict == "refuted"
    assert height(before.damping_factor) > -0.1 - 1e-6


BETWEEN = {"c_lambda": 60499.07, "I_arm": 5.666277827e-7, "L": 0.4868774594, "gamma": 0.5619666434, "b": 0.1743259055}
"""At half and at twice its damping the margin is 0.14 1/s or more, at 1.036 times 0.100001."""


@pytest.mark.parametrize(
    ("margin", "verdict"),
    [
        (0.0999, "proved"),
        (0.1, "proved"),
        (0.1000009, "proved"),
        (0.1000012, "refuted"),
        (0.10001, "refuted"),
        (0.13, "refuted"),
    ],
)
def test_both_ends_stable_and_lost_between(base, margin, verdict):
    """The abscissa is not monotone in the damping: twelve samples keep a margin that is lost between them."""
    found = certify(base.replace(damper__damping_range=[0.5, 2.0]), BETWEEN, margin)
    assert found.verdict == verdict, found.reason
    model = LinearModel(base)

    def height(factor):
        return model.at(BETWEEN | {"c_lambda": factor * BETWEEN["c_lambda"]}).abscissa(np.geomspace(5, 100, 200), 1.5e5).max()

    assert max(height(0.5), height(2.0)) < -0.14
    assert height(1.0359) == pytest.approx(-0.100001, abs=2e-7)
    if verdict == "refuted":
        assert height(found.damping_factor) > -margin - 1e-9


def test_every_load_of_a_list(base):
    """Each load is a proof of its own; the witness names the load that fails."""
    both = base.replace(damper__damping_range=[0.5, 2.0], envelope__vertical_load=[5e4, 1.5e5])
    assert certify(both, BETWEEN, 0.05).verdict == "proved"
    found = certify(both, BETWEEN, 0.11)
    assert found.verdict == "refuted"
    model = LinearModel(base)
    speed, load, factor = found.place
    assert model.at(BETWEEN | {"c_lambda": factor * BETWEEN["c_lambda"]}).abscissa(speed, load)[0] > -0.11 - 1e-9


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"envelope__vertical_load": {"min": 1e5, "max": 1.5e5}}, "a range of loads beside damper.damping_range"),
        ({"damper__damping_range": [2.0, 0.5]}, "the first below the second"),
        ({"damper__damping_range": [1.1, 2.0]}, "with 1 among them"),
        ({"damper__damping_range": [0.5]}, "two factors"),
        (
            {"requirements__limit_event": "simulated", "requirements__decay": {"release": {"yaw_angle": 0.01}}},
            "simulated, beside",
        ),
    ],
)
def test_what_is_refused(base, changes, words):
    with pytest.raises(ConfigError, match=words):
        base.replace(**{"damper__damping_range": [0.5, 2.0], **changes})


def test_memory_with_a_vane(base):
    """A rotary damper enters with c: of 1.5 times the critical damping a half is refuted, three quarters are proved."""
    vane = {"topology": "rotational", "torsional_stiffness": 3.8e5, "kind": "vane", "mean_radius": 0.1, "vane_width": 0.03}
    bounds = {"start": 1e3, "min": 10.0, "max": 1e5}
    study = base.replace(damper=vane, design={"c_vane": bounds}, tyre__contact="memory", requirements__limit_torque=1e4)
    V, model = np.geomspace(5, 100, 120), LinearModel(study)
    low, high = 10.0, 1e4  # bisection for the critical damping
    assert model.at({"c_vane": low}).abscissa(V, 1.5e5).max() > 0 > model.at({"c_vane": high}).abscissa(V, 1.5e5).max()
    for _ in range(20):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if model.at({"c_vane": middle}).abscissa(V, 1.5e5).max() > 0 else (low, middle)
    half = certify(study.replace(damper__damping_range=[0.5, 1.0]), {"c_vane": 1.5 * high}, 0.0)
    assert half.verdict == "refuted"
    assert 1.5 * high * half.damping_factor < high * 1.01
    assert certify(study, {"c_vane": 1.5 * high}, 0.0).verdict == "proved"
    assert certify(study.replace(damper__damping_range=[0.75, 1.2]), {"c_vane": 1.5 * high}, 0.0).verdict == "proved"
