"""Limits far from any design change nothing; a study without a design says so whatever sizes its parts."""

import pytest

from damperopt import optimise


@pytest.mark.parametrize("topology", ["boeing", "arreaza"])
def test_a_limit_that_nothing_comes_near_is_as_good_as_none(main_gear, topology):
    """The multiplier of such a row is rounding; times a slack of 10 km it must not be taken for a missed condition."""
    study = main_gear.replace(damper__topology=topology, solver__starts=2)
    near = optimise(study.replace(requirements__lug_distance={"min": 0.0, "max": 5.0}))
    far = optimise(study.replace(requirements__lug_distance={"min": 0.0, "max": 1e4}))
    assert near.status == far.status == "solved"
    assert far.mass.total == pytest.approx(near.mass.total, rel=1e-6)


@pytest.mark.slow
def test_no_design_with_a_simulated_limit_event_is_infeasible_and_says_why(main_gear_with_decay):
    """The event takes its peaks from the motions of the decay requirement, which the diagnosis takes away first."""
    study = main_gear_with_decay.replace(
        requirements__limit_event="simulated", requirements__lug_distance={"min": 0.1, "max": 0.11}, solver__starts=2
    )
    result = optimise(study)
    assert result.status == "infeasible"
    assert result.exit_code == 3
    names = {r.name for r in result.infeasibility.alone_enough}
    assert "lug_distance_max" in names
