"""Damping ratio of the yaw mode as a requirement."""

import pytest

import damperopt


@pytest.mark.slow
def test_a_gear_with_two_dips_beside_each_other_has_an_optimum(configs):
    """At 26.76 and 28.16 m/s, 5 % apart: each is held, and the exchange stands still."""
    study = damperopt.load(configs / "main_gear.yaml").replace(
        mass__lower_lug_height=0.25, requirements__decay=None, tyre__contact="leading_point", solver__starts=1
    )
    result = damperopt.optimise(study)
    assert result.status == "solved"
    assert "damping_ratio" in [c.name for c in result.constraints if c.active]
    assert result.mass.total == pytest.approx(13.1761, abs=1e-3)
