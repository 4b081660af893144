"""Histories from files, and what a motion along one shows."""

import numpy as np
import pytest

import damperopt
from damperopt import ConfigError, History, read_history, simulate_along
from damperopt.motion.history import Frozen
from damperopt.motion.roll import roll_of
from damperopt.motion.trajectory import Trajectory

GOOD = """# a remark
time [ms], speed [kt], load [kN], stroke [mm]

0, 100, 50, 10
500, 90, 150, 30
"""


def test_units_and_remarks(tmp_path):
    file = tmp_path / "roll.csv"
    file.write_text("\ufeff" + GOOD.replace("\n", "\r\n"), encoding="utf-8", newline="")  # as spreadsheets write it
    found = read_history(file)
    assert found.column("time") == [0, 0.5]
    assert found.column("speed") == pytest.approx([100 * 1852 / 3600, 90 * 1852 / 3600])
    assert (found.column("load"), found.column("stroke"), found.column("yaw_torque")) == ([50e3, 150e3], [0.01, 0.03], None)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "time [ms], ",
            "",
            "roll.csv:2: time: missing column; allowed: the header time [s], speed [m/s], load [N], and if wanted",
        ),
        ("load [kN]", "load", "roll.csv:2: load: no unit; allowed: load [N], or another unit of that dimension"),
        ("load [kN]", "weight [kN]", "roll.csv:2: 'weight [kN]' is no column"),
        ("load [kN]", "load [kg]", "roll.csv:4: load: '50 kg' has the unit 'kg', which is"),
        ("500, 90", "500, ninety", "roll.csv:5: speed: 'ninety' is no number; allowed: a number, in kt as the header says"),
        ("500, 90", "500, 0", "roll.csv:5: speed: 0 kt (= 0 m/s) is out of range"),
        ("500, 90, 150", "500, 90, -150", "roll.csv:5: load: -150 kN (= -150000 N) is out of range"),
        ("500, 90, 150, 30", "500, 90", "roll.csv:5: 2 cells; allowed: 4, as the header has"),
        ("500,", "0,", "roll.csv:5: time: 0 s after 0 s; allowed: times that rise"),
        ("500, 90, 150, 30\n", "", "roll.csv:2: 1 rows; allowed: two below the header, or more"),
        ("500, 90", "500, nan", "roll.csv:5: speed: 'nan' is no number"),
    ],
)
def test_what_is_wrong_is_named_by_file_line_and_column(tmp_path, old, new, message):
    file = tmp_path / "roll.csv"
    file.write_text(GOOD.replace(old, new))
    with pytest.raises(ConfigError) as error:
        read_history(file)
    assert message in str(error.value)


STRUT = {"stroke": {"load": [20e3, 160e3], "value": [0.05, 0.3]}}


@pytest.mark.parametrize(
    ("changes", "rows", "message"),
    [
        ({}, [(0, 50e3, 0.1), (1, 60e3, 0.1)], "history: stroke: of a gear without gear.strut"),
        ({"gear__strut": STRUT}, [(0, 50e3, 0.1), (1, 60e3, 0.4)], "history: stroke at 1 s: 0.4 m; allowed: at most 0.3 m"),
        ({"gear__strut": STRUT}, [(0, 50e3, None), (1, 170e3, None)], "history: load at 1 s: 170 kN is beyond the table"),
    ],
)
def test_questions_without_an_answer_are_refused(configs, changes, rows, message):
    study = damperopt.load(configs / "main_gear.yaml").replace(**changes)
    given = [{"time": t, "speed": 40.0, "load": F} | ({} if x is None else {"stroke": x}) for t, F, x in rows]
    with pytest.raises(ConfigError, match=message):
        simulate_along(study, history=History(moments=given), disturbance={"release": {"yaw_angle": 0.01}})


def test_a_gear_that_nothing_disturbs_is_no_question(configs):
    rows = [{"time": t, "speed": 40.0, "load": 1.5e5, "yaw_torque": 0.0} for t in (0, 1)]
    with pytest.raises(ConfigError, match="nothing disturbs the gear"):
        simulate_along(damperopt.load(configs / "main_gear.yaml"), history=History(moments=rows))


def test_stretches_of_a_roll_and_places_of_peaks():
    t = np.linspace(0, 10, 101)
    frozen = Frozen(t, 50 - 4 * t, 1e5 + 0 * t, np.sin(t))
    assert np.ravel(frozen.beyond(0.0)) == pytest.approx([0, np.pi, 2 * np.pi, 3 * np.pi], abs=1e-2)
    yaw = np.where(t == 4.0, -0.2, 0.1)
    motion = Trajectory(50, 1e5, t, {"yaw_angle": yaw}, {"speed": 50 - 4 * t, "vertical_load": 1e5 + t}, "completed", "", "erk")
    found = roll_of(motion, frozen, 0.5)
    peak = found.peaks["yaw_angle"]
    assert (peak.value, peak.time, peak.speed, peak.load) == pytest.approx((0.2, 4, 34, 1e5 + 4))
    assert found.worst_at.time == pytest.approx(np.pi / 2, abs=0.05)
    assert found.below[0].time == pytest.approx((0, np.pi + np.pi / 6), abs=1e-2)
    assert found.unstable[1].speed == pytest.approx((50 - 8 * np.pi, 50 - 12 * np.pi), abs=1e-2)
