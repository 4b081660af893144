"""Proof over loads under which a shock strut comes in, against scans of eigenvalues of matrices written by hand."""

import memory_twin
import numpy as np
import pytest
import yaml
from basic_twin import parameters, spectral_abscissa, state_matrix
from scipy.optimize import brentq

import damperopt

GAS = {"pressure": 1.2e6, "area": 0.03, "volume": 0.015, "exponent": 1.1}
BENDING, TORSION, DIPS = [5.0e6, 6.5e6, 7.0e6], [9e5, 1.4e6, 1.5e6], [1.7e6, 0.8e6, 1.7e6]
TABLE = [40e3, 100e3, 160e3]
MASS = 40.0


def at_load(F_z, p, torsion=TORSION):
    """Numbers of the twin under a load: root of the gas law, straight lines through the tables."""
    p_a, (p_0, A, V_0, n) = 101_325.0, GAS.values()
    x = brentq(lambda x: A * ((p_0 + p_a) * (1 - x * A / V_0) ** -n - p_a) - F_z, 0, 0.45)
    l_g = p.l_g - x
    changed = {
        "l_g": l_g,
        "I_x": p.I_x - MASS * (p.l_g**2 - l_g**2),
        "k_delta": np.interp(F_z, TABLE, BENDING),
        "k_psi": np.interp(F_z, TABLE, torsion),
    }
    return parameters(**{**vars(p), **changed})


def study_of(p, contact, load, torsion=TORSION):
    data = yaml.safe_load(memory_twin.study_text(p, 8.0, 90.0, contact=contact))
    strut = {"gas": GAS, "travel": 0.42, "moving_mass": MASS}
    strut |= {"bending_stiffness": {"load": TABLE, "value": BENDING}, "torsional_stiffness": {"load": TABLE, "value": torsion}}
    data["gear"]["strut"] = strut
    data["envelope"]["vertical_load"] = load
    return damperopt.loads(yaml.safe_dump(data))


def abscissa(V, F_z, p, contact, torsion=TORSION):
    at = at_load(F_z, p, torsion)
    return (
        memory_twin.rightmost(V, F_z, at, nodes=24)[0].real
        if contact == "memory"
        else spectral_abscissa(state_matrix(V, F_z, at))
    )


@pytest.mark.parametrize(("contact", "part"), [("memory", 0.3), ("leading_point", 0.6)])
def test_a_range_of_loads_in_slices(contact, part):
    """The worst of a scan decides: a margin below it is proved, one a little above refuted, where it is missed."""
    p = memory_twin.gear(c_psi=4000.0)
    speeds, loads = np.geomspace(8, 90, 30), np.linspace(85e3, 115e3, 7)
    found = np.array([[abscissa(V, F, p, contact) for V in speeds] for F in loads])
    worst = found.max()
    assert np.ptp(found.max(axis=1)) > 0.05 * abs(worst), "the load matters, or nothing is tested"
    study = study_of(p, contact, {"min": 85e3, "max": 115e3})
    kept, missed = (damperopt.certify(study, {}, share * -worst) for share in (part, 1.02))
    assert (kept.verdict, missed.verdict) == ("proved", "refuted"), (kept.reason, missed.reason)
    assert abscissa(*missed.counterexample, p, contact) > 1.02 * worst
    listed = study_of(p, contact, loads[[0, 3, 6]].tolist())
    top = found[[0, 3, 6]].max()
    kept, missed = (damperopt.certify(listed, {}, share * -top) for share in (0.98, 1.02))
    assert (kept.verdict, missed.verdict) == ("proved", "refuted")


def test_a_band_between_loads_of_a_list_is_found_over_the_range():
    """Torsion that dips between its ends: a list of the ends is proved, and the range between them refuted."""
    p = memory_twin.gear(c_psi=800.0, c_delta=600.0)
    lists, ranged = (study_of(p, "memory", load, DIPS) for load in ([50e3, 150e3], {"min": 50e3, "max": 150e3}))
    proved, refuted = (damperopt.certify(study, {}, 0.02) for study in (lists, ranged))
    assert (proved.verdict, refuted.verdict) == ("proved", "refuted"), (proved.reason, refuted.reason)
    V, F_z = refuted.counterexample
    assert 60e3 < F_z < 140e3
    assert abscissa(V, F_z, p, "memory", DIPS) > -0.02
