"""Critical speeds of the nose gear of Somieski (1997), Aerospace Science and Technology 8, in the linear range of its tyre.

Third order; parameters and speeds are those of section 6 of the theory page.
"""

import pytest
from basic_twin import parameters, spectral_abscissa, state_matrix
from tolerances import half_last_digit, printed

import damperopt

CRITICAL_SPEEDS = [(0.0, "15.259"), (10.0, "20.511"), (20.0, "27.600"), (30.0, "37.263"), (40.0, "51.881")]
LOAD, TOP_SPEED = 9000.0, 200.0


@pytest.fixture
def nose_gear(main_gear):
    """The gear with a torsional damping c_psi [N m s/rad]; the wheel radius has no part in it without rake."""

    def gear(c_psi):
        study = main_gear.replace(
            gear={"order": 3, "yaw_inertia": 1.0, "caster_length": 0.1, "wheel_radius": 0.2},
            tyre={
                "law": "linear",
                "contact": "leading_point",
                "half_contact_length": 0.1,
                "relaxation_length": 0.3,
                "cornering_slope": 20.0,
                "aligning_coefficient": 2.0,
                "tread_width_moment": 270.0,
            },
            damper={"topology": "rotational", "torsional_stiffness": 1e5, "torsional_damping": c_psi},
        )
        return damperopt.linear_gear(study)

    return gear


def twin(c_psi):
    return parameters(law="linear", k_psi=1e5, c_psi=c_psi, C_F=20.0, C_M=2.0, kappa=270.0, sigma=0.3, a=0.1, e=0.1, I_z=1.0)


@pytest.mark.parametrize(("c_psi", "speed"), CRITICAL_SPEEDS)
def test_critical_speed(nose_gear, c_psi, speed):
    (crossing,) = damperopt.critical_speeds(nose_gear(c_psi), LOAD, 1.0, TOP_SPEED)
    assert crossing.speed == printed(speed)
    assert (crossing.kind, crossing.destabilising, crossing.boundary) == ("hopf", True, True)


@pytest.mark.parametrize(("c_psi", "speed"), CRITICAL_SPEEDS)
def test_critical_speed_of_the_twin(c_psi, speed):
    ends = float(speed) - half_last_digit(speed), float(speed) + half_last_digit(speed)
    below, above = (spectral_abscissa(state_matrix(V, LOAD, twin(c_psi), order=3)) for V in ends)
    assert below < 0 < above


def test_no_critical_speed_below_200_with_enough_damping(nose_gear):
    gear = nose_gear(50.0)
    assert damperopt.critical_speeds(gear, LOAD, 1.0, TOP_SPEED) == []
    assert gear.abscissa([1.0, 50.0, TOP_SPEED], LOAD).max() < 0
