"""Every optional element goes through every command: none stops at a state, an output or a part that it does not expect."""

import numpy as np
import pytest

import damperopt
from damperopt.output import write_report
from damperopt.output.gallery import write_design

ELEMENTS = {
    "link_stiffness": {"damper__link_stiffness": 5e7},
    "series_stiffness": {"damper__series_stiffness": 5e7},
    "both": {"damper__link_stiffness": 5e7, "damper__series_stiffness": 5e7},
    "orifice": {"damper__orifice": {"coefficient": 1e5}},
    "freeplay": {"damper__freeplay": {"gap": 1e-4}},
    "end_stop": {"damper__end_stop": {"stroke": 0.02, "stiffness": 1e8}},
    "friction": {"gear__friction": {"torque": 5.0}},
    "pressure": {"tyre__pressure": 1e6},
    "spin": {
        "gear__lateral": {"inertia": 300.0, "stiffness": 3e6, "damping": 3e3, "height": 2.0},
        "gear__wheel_polar_inertia": 2.0,
        "gear__order": 5,
    },
}


@pytest.fixture(params=ELEMENTS)
def study(request, configs):
    study = damperopt.load(configs / "minimal.yaml").replace(solver__starts=1, solver__verification_speeds=50)
    order = {"gear__order": ELEMENTS[request.param].get("gear__order", 3)}
    return study.replace(**(ELEMENTS[request.param] | order))


def test_optimised_and_written(study, tmp_path):
    result = damperopt.optimise(study)
    assert result.status == "solved", result.message
    write_design(tmp_path, study, result, figures=False)
    assert (tmp_path / "modes.csv").read_text().count("\n") > 100
    if study.gear.order == 5 or (study.damper.series_stiffness and study.damper.link_stiffness):  # its figures take seconds
        assert write_report(tmp_path).is_file()


def test_analysed_charted_and_simulated(study):
    low, high, load = study.envelope.speed.min, study.envelope.speed.max, study.envelope.loads[0]
    gear = damperopt.linear_gear(study)
    modes = damperopt.track_modes(gear, np.linspace(low, high, 20), load)
    assert len(modes.names) == len(gear.principal)
    assert damperopt.certify(study, study.start, margin=0.0).reason
    worst = damperopt.worst_points(gear, study.envelope)[0]
    np.testing.assert_allclose(worst.abscissa, gear.abscissa(worst.speed, worst.load)[0], rtol=1e-9)
    record = damperopt.chart(study, ("c_lambda", 100.0, 1e5), ("L", 0.3, 0.8), speed=high)
    assert record.families
    question = {"speed": high / 2, "disturbance": {"release": {"yaw_angle": 2e-3}}, "duration": 0.05}
    smooth, exact = damperopt.simulate(study, **question, engine="cvodes"), damperopt.simulate_exactly(study, **question)
    assert smooth.status == exact.status == "completed"
    assert set(smooth.states) == set(exact.states)
