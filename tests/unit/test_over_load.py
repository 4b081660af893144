"""Lengths of a tyre as tables over the load: values, the law that sees them, powers, ends, and what is refused."""

import casadi as ca
import flint
import numpy as np
import pytest
from components_of import tyre_of

import damperopt
from damperopt.expressions.calculus import piecewise
from damperopt.tyres.over_load import LengthTable

TABLE = {"load": [50e3, 100e3, 200e3], "value": [0.10, 0.14, 0.18]}
LAW = {"law": "brush", "cornering_stiffness": 440e3, "friction": 0.8, "relaxation_length": 0.3}


def test_values_are_those_of_straight_lines():
    table = LengthTable.model_validate(TABLE)
    loads = np.array([50e3, 60e3, 100e3, 150e3, 200e3])
    expected = np.interp(loads, TABLE["load"], TABLE["value"])
    np.testing.assert_allclose([table.at(load) for load in loads], expected, rtol=1e-14)
    np.testing.assert_allclose(table.at(loads), expected, rtol=1e-14)
    F = ca.SX.sym("F")
    np.testing.assert_allclose(ca.Function("at", [F], [table.at(F)])(loads).full().ravel(), expected, rtol=1e-14)


def test_a_ball_over_a_corner_holds_both_lines():
    table = LengthTable.model_validate(TABLE)
    found = table.at(flint.arb(100e3, 20e3))
    for load in (80e3, 90e3, 100e3, 110e3, 120e3):
        assert found.contains(flint.arb(table.at(load)))
    assert float(found.rad()) < 0.05
    bent = [lambda x: x, lambda x: 2 - x]  # meet at 1
    assert piecewise(flint.arb(0.5, 0.1), [1.0], bent).contains(0.5)
    assert not piecewise(flint.arb(0.5, 0.1), [1.0], bent).contains(0.7)
    wide = piecewise(flint.arb(1, 0.25), [1.0], bent)
    assert all(wide.contains(value) for value in (0.75, 1.0))
    assert float(wide.rad()) < 0.4


def test_the_law_sees_the_length_at_its_load():
    tyre, plain = tyre_of(**LAW, half_contact_length=TABLE), tyre_of(**LAW, half_contact_length=0.14)
    assert tyre.linear(100e3, None) == plain.linear(100e3, None)
    assert tyre.force(0.05, 100e3, None) == plain.force(0.05, 100e3, None)
    assert tyre.moment(0.05, 100e3, None, None) == plain.moment(0.05, 100e3, None, None)
    assert tyre.peaks(100e3, None) == plain.peaks(100e3, None)
    assert tyre.linear(50e3, None).half_contact_length == pytest.approx(0.10)
    assert (tyre.LOAD_POWERS, plain.LOAD_POWERS) == (None, (0,))


def test_eigenvalues_and_certificate_at_a_load_are_those_of_its_length(configs):
    study = damperopt.load(configs / "main_gear.yaml")
    table = study.replace(tyre__half_contact_length=TABLE, tyre__relaxation_length={"load": [1e5, 2e5], "value": [0.3, 0.4]})
    plain = study.replace(tyre__half_contact_length=0.16, tyre__relaxation_length=0.35)
    speeds = np.linspace(5, 100, 7)
    found, expected = (np.linalg.eigvals(damperopt.linear_gear(s).matrices(speeds, 150e3)) for s in (table, plain))
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(expected), rtol=1e-9)
    certificates = [damperopt.certify(s, s.start, margin=0.0) for s in (table, plain)]
    assert certificates[0].proved == certificates[1].proved
    assert certificates[0].counterexample == pytest.approx(certificates[1].counterexample, rel=1e-9)
    again = damperopt.Study.model_validate_json(table.model_dump_json(exclude_none=True))
    assert again == table


def test_a_load_beyond_the_table_is_refused(configs):
    study = damperopt.load(configs / "main_gear.yaml").replace(tyre__half_contact_length=TABLE)
    with pytest.raises(damperopt.ConfigError, match=r"250 kN is beyond the table of tyre\.half_contact_length, 50 to 200 kN"):
        study.replace(envelope__vertical_load=250e3)
    with pytest.raises(damperopt.ConfigError, match="is beyond the table"):
        study.replace(envelope__vertical_load={"min": 40e3, "max": 100e3})


@pytest.mark.parametrize(
    ("block", "says"),
    [
        ("{load: [50 kN, 100 kN], value: [0.1 m]}", "half_contact_length: 2 loads and 1 values; allowed: as many"),
        ("{load: [100 kN, 50 kN], value: [0.1 m, 0.2 m]}", "half_contact_length.load: loads that do not ascend"),
        ("{load: [50 kN, 100 kN], value: [0.1 kg, 0.2 m]}", "half_contact_length.value.0: '0.1 kg' has the unit 'kg'"),
        ("{load: [50 kN, 100 kN]}", "half_contact_length.value: missing key"),
        ("0.1 kg", "half_contact_length: '0.1 kg' has the unit 'kg'"),
    ],
)
def test_what_is_no_table_is_refused(block, says, configs):
    text = (configs / "main_gear.yaml").read_text().replace("half_contact_length: 0.1 m ", f"half_contact_length: {block}  ")
    with pytest.raises(damperopt.ConfigError) as error:
        damperopt.loads(text)
    assert len(error.value.problems) == 1
    assert says in str(error.value)


def test_a_slope_may_be_a_table_as_well():
    """The brush law at a load is that of the slope there, sliding included."""
    slopes = {"load": ["50 kN", "150 kN"], "value": ["300 kN/rad", "500 kN/rad"]}
    tyre = tyre_of(**LAW | {"cornering_stiffness": slopes}, half_contact_length=TABLE)
    plain = tyre_of(**LAW | {"cornering_stiffness": 400e3}, half_contact_length=0.14)
    assert tyre.LOAD_POWERS is None
    assert tyre.linear(100e3, None) == plain.linear(100e3, None)
    for alpha in (-0.6, 0.05, 0.3):
        assert tyre.force(alpha, 100e3, None) == pytest.approx(plain.force(alpha, 100e3, None), rel=1e-14)
    assert "table of tyre.cornering_stiffness, 50 to 150 kN" in tyre.beyond(160e3, None)
    assert tyre.loads() == (50e3, 150e3)


WIDER = [
    {"law": "tr_r64", "size": "49x17", "type": "VII", "rated_pressure": "170 psi"},
    {"law": "tr_r64", "size": "49x17", "type": "VII", "rated_pressure": "170 psi", "relaxation": "stiffness_ratio"},
    {**LAW, "half_contact_length": TABLE},
    {
        "law": "magic_formula",
        "contact": "leading_point",
        "half_contact_length": TABLE,
        "coefficients": {
            **{"FNOMIN": 1e5, "UNLOADED_RADIUS": 0.6, "PCY1": 1.4, "PDY1": 0.8, "PDY2": -0.1, "PKY1": -12.0, "PKY2": 1.2},
            **{"PTY1": 1.3, "PTY2": 1.1, "QDZ1": 0.1, "QDZ2": -0.02},
        },
    },
]


@pytest.mark.parametrize("block", WIDER)
def test_small_slip_data_of_a_ball_of_loads_hold_those_of_every_load(block):
    """For proofs over slices of the load: enclosures, and not much wider than what they enclose."""
    tyre = tyre_of(**block)
    for low, high in ((60e3, 66e3), (95e3, 105e3), (120e3, 130e3), (180e3, 190e3)):
        ball = flint.arb((low + high) / 2, (high - low) / 2)
        found = tuple(tyre.linear(ball, None))
        samples = np.array([tuple(tyre.linear(float(load), None)) for load in np.linspace(low, high, 41)])
        for value, column in zip(found, samples.T, strict=True):
            held = value if isinstance(value, flint.arb) else flint.arb(value)
            assert all(held.contains(flint.arb(float(number))) or held == float(number) for number in column)
            # a product of two data of which one falls while the other grows is as wide as both: 12 % at most
            assert 2 * float(held.rad()) <= 4 * np.ptp(column) + 0.12 * column.mean()
