"""The command `damperopt simulate`: files, engines, answers, refused questions; in this process but where processes count."""

import json
import os
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest
from basic_twin import parameters, planar_coefficients, planar_torque, right_hand_side
from scipy.integrate import solve_ivp
from tolerances import COMMANDED_MOTION, COMMANDED_PEAK, PRINTED_ROW

import damperopt

FILES = {"trajectory.csv", "motion.json", "trajectory.png", "trajectory.svg"}
QUESTION = ("--speed", "40", "--release", "yaw=1deg", "--duration", "1")
RELEASE = np.deg2rad(1.0)
PROCESS = [sys.executable, "-W", "error", "-c", "from damperopt.cli import main; main()"]


def read(folder):
    """Columns of the CSV by name without unit, and the record of the motion."""
    with open(folder / "trajectory.csv", encoding="utf-8") as file:
        header = file.readline().strip().split(",")
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    columns = {name.split(" ")[0]: column for name, column in zip(header, rows.T, strict=True)}
    motion = json.loads((folder / "motion.json").read_text(encoding="utf-8"))
    return SimpleNamespace(header=header, columns=columns, motion=motion)


@pytest.fixture
def study_file(configs, tmp_path):
    """Writes the main gear to study.yaml with text replaced."""

    def write(*changes):
        text = (configs / "thesis_gear.yaml").read_text()
        for old, new in changes:
            assert old in text, "the test looks for text that is no longer in the config"
            text = text.replace(old, new, 1)
        (tmp_path / "study.yaml").write_text(text)
        return tmp_path / "study.yaml"

    return write


def damping(start):
    return "c_lambda: {start: 1000 N s/m", f"c_lambda: {{start: {start}"


def twin_motion(study, found, times=None, events=None):
    """SciPy on the basic twin with the numbers of the study and the design that motion.json names."""
    design, youngs_modulus = found.motion["design"], study.material.youngs_modulus
    k_psi, c_psi = planar_coefficients("arreaza", youngs_modulus, **design)
    p = parameters(k_psi=k_psi, c_psi=c_psi, torque=planar_torque("arreaza", youngs_modulus, **design))
    speed, load = found.motion["speed"], found.motion["load"]
    return solve_ivp(
        lambda t, x: right_hand_side(x, speed, load, p),
        (0, found.motion["duration"]),
        [RELEASE, 0, 0, 0, 0],
        method="DOP853",
        rtol=1e-11,
        atol=1e-14,
        t_eval=times,
        events=events,
    )


@pytest.fixture(scope="module")
def release(configs, tmp_path_factory):
    """The command as documented, in a process of its own with the default engine."""
    place = tmp_path_factory.mktemp("release")
    command = [*PROCESS, "simulate", str(configs / "thesis_gear.yaml"), *QUESTION, "-o", "out"]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    found = read(place / "out")
    found.done, found.folder = done, place / "out"
    return found


def test_writes_four_files_and_says_where(release):
    """CSV, JSON and both figures are there, the figures are what their names say, and nothing is left beside them."""
    assert {file.name for file in release.folder.iterdir()} == FILES
    assert {file.name for file in release.folder.parent.iterdir()} == {"out"}
    assert (release.folder / "trajectory.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (release.folder / "trajectory.svg").read_text(encoding="utf-8")
    assert release.done.stdout.rstrip().endswith("Results in out")
    assert not release.done.stderr


def test_every_column_has_a_unit(release):
    """The header names yaw, lateral displacement, string, force, stroke and stress, each with its SI unit."""
    assert release.header[0] == "time [s]"
    expected = {
        "yaw_angle [rad]",
        "yaw_rate [rad/s]",
        "lateral_displacement [m]",
        "string_deflection [m]",
        "damper_force [N]",
        "damper_stroke [m]",
        "arm_stress [Pa]",
    }
    assert expected <= set(release.header)
    assert all(" [" in name and name.endswith("]") for name in release.header)


def test_first_row_is_the_release(release):
    """At time zero the gear is at rest at the released yaw angle with the string straight."""
    first = {name: column[0] for name, column in release.columns.items()}
    assert first["yaw_angle"] == pytest.approx(RELEASE, rel=PRINTED_ROW)
    for name in ("time", "yaw_rate", "bending_angle", "bending_rate", "string_deflection", "damper_force"):
        assert first[name] == 0, name


def test_rows_are_those_of_scipy_on_the_twin(release, main_gear):
    """All five states at all times of the CSV agree with an integration that shares nothing with the package."""
    names = ("yaw_angle", "yaw_rate", "bending_angle", "bending_rate", "string_deflection")
    expected = twin_motion(main_gear, release, release.columns["time"]).y
    for name, column in zip(names, expected, strict=True):
        found = release.columns[name]
        assert np.abs(found - column).max() < COMMANDED_MOTION * np.abs(column).max(), name


def test_outputs_follow_from_the_states(release, main_gear):
    """Stroke, force, lateral displacement and arm stress by hand from the states of the same row."""
    c, d = release.columns, release.motion["design"]
    ell = d["L"] * np.sin(d["gamma"])
    speed = ell * np.cos(c["yaw_angle"]) * c["yaw_rate"]
    # tube of a wall of a tenth of its diameter D: I = pi/64 D^4 (1 - 0.8^4); arm of length ell, tip force 3 E I eps/ell^3
    diameter = (64 * d["I_arm"] / np.pi / (1 - 0.8**4)) ** 0.25
    tip_force = 3 * main_gear.material.youngs_modulus * d["I_arm"] / ell**3 * ell * np.abs(np.sin(c["yaw_angle"]))
    by_hand = {
        "damper_stroke": ell * np.sin(c["yaw_angle"]),
        "damper_force": d["c_lambda"] * speed,
        "lateral_displacement": main_gear.gear.lateral.height * np.sin(c["bending_angle"]),
        "arm_stress": tip_force * ell * diameter / 2 / d["I_arm"],
    }
    for name, column in by_hand.items():
        off = np.abs(np.abs(c[name]) - np.abs(column)).max()
        assert off < PRINTED_ROW * np.abs(column).max(), name


def test_decay_ratio_cycles_and_frequency_are_those_of_the_twin(release, main_gear):
    """Zeros and extrema as events of SciPy's integration: the JSON tells the same story."""

    def zero(t, x):
        return x[0]

    def turn(t, x):
        return x[1]

    expected = twin_motion(main_gear, release, events=[zero, turn])
    zeros, turns = expected.t_events
    heights = expected.y_events[1][:, 0]
    turns, heights = turns[turns > 1e-6], heights[turns > 1e-6]
    after = np.abs(heights[turns > zeros[5]]).max() / RELEASE  # 3 cycles are 6 zeros
    motion = release.motion
    assert motion["decay_ratio"] == pytest.approx(after, rel=COMMANDED_PEAK)
    assert motion["cycles"] == (zeros.size - 1) / 2
    assert motion["amplitude"] == pytest.approx(abs(heights[-1] - heights[-2]) / 2, rel=COMMANDED_PEAK)
    assert motion["frequency"] == pytest.approx(10 / (turns[-1] - turns[-21]), rel=COMMANDED_PEAK)


def test_json_holds_question_answer_and_peaks(release, main_gear):
    """What was asked, how it was answered, and the largest magnitude of every column."""
    motion = release.motion
    assert motion["speed"] == 40
    assert motion["load"] == 150e3
    assert motion["disturbance"]["release"]["yaw_angle"] == pytest.approx(RELEASE)
    assert motion["design"] == main_gear.start
    assert motion["status"] == "completed"
    assert motion["message"] == ""
    assert motion["duration"] == pytest.approx(1.0)
    assert motion["kind"] == "growing"
    assert set(motion["peaks"]) == set(release.columns) - {"time"}
    for name, peak in motion["peaks"].items():
        assert peak == pytest.approx(np.abs(release.columns[name]).max(), rel=PRINTED_ROW), name


@pytest.mark.parametrize("engine", ["cvodes", "idas", "exact"])
def test_engines_agree(engine, call, configs, tmp_path, release):
    """Every engine is named in the JSON and gives the peaks, the decay and the kind of the default one."""
    done = call("simulate", configs / "thesis_gear.yaml", *QUESTION, "--engine", engine, "-o", "out")
    assert done.code == 0, done.err
    found = read(tmp_path / "out").motion
    assert found["engine"] == engine
    assert release.motion["engine"] in ("erk", "cvodes")
    assert found["kind"] == release.motion["kind"]
    assert found["cycles"] == release.motion["cycles"]
    for key in ("decay_ratio", "amplitude", "frequency"):
        assert found[key] == pytest.approx(release.motion[key], rel=COMMANDED_PEAK), key


@pytest.mark.parametrize(
    ("options", "block", "first"),
    [
        (("--kick", "yaw_rate=0.5"), {"kick": {"yaw_rate": 0.5, "bending_rate": 0.0}}, {"yaw_rate": 0.5}),
        (("--kick", "yaw=0.5 rad/s"), {"kick": {"yaw_rate": 0.5, "bending_rate": 0.0}}, {"yaw_rate": 0.5}),
        (("--step", "torque=2 kN m"), {"step": {"yaw_torque": 2e3}}, {"yaw_acceleration": 2e3 / 100}),
        (("--unbalance", "moment=0.1"), {"unbalance": {"moment": 0.1}}, {"yaw_acceleration": 0.0}),
        (
            ("--release", "yaw=0.01,string=5mm", "--kick", "yaw=0.5"),
            {
                "release": {"yaw_angle": 0.01, "bending_angle": 0.0, "string_deflection": 0.005},
                "kick": {"yaw_rate": 0.5, "bending_rate": 0.0},
            },
            {"yaw_angle": 0.01, "yaw_rate": 0.5, "string_deflection": 0.005},
        ),
    ],
)
def test_disturbances_start_the_motion_they_name(options, block, first, call, configs, tmp_path):
    """Kick, step of torque, unbalance, two at once: the JSON repeats them, row one has them, and the gear moves."""
    done = call("simulate", configs / "thesis_gear.yaml", "--speed", "40", "--duration", "0.2", *options, "-o", "out")
    assert done.code == 0, done.err
    found = read(tmp_path / "out")
    assert found.motion["disturbance"] == block
    for name in ("yaw_angle", "yaw_rate", "string_deflection"):
        assert found.columns[name][0] == pytest.approx(first.get(name, 0.0)), name
    if "yaw_acceleration" in first:  # I_z = 100 kg m^2
        assert found.columns["yaw_acceleration"][0] == pytest.approx(first["yaw_acceleration"])
    assert found.motion["peaks"]["yaw_angle"] > 1e-5


def test_load_speed_and_duration_take_units(call, configs, tmp_path):
    """120 kN, 100 kt and 200 ms are what they say, in the JSON and on the screen."""
    units = ("--load", "120kN", "--speed", "100 kt", "--duration", "200 ms")
    done = call("simulate", configs / "thesis_gear.yaml", *units, "-o", "out")
    assert done.code == 0, done.err
    motion = read(tmp_path / "out").motion
    assert motion["load"] == 120e3
    assert motion["speed"] == pytest.approx(100 * 1852 / 3600)
    assert motion["duration"] == pytest.approx(0.2)
    assert "120 kN, 0.2 s" in done.out


def test_without_a_disturbance_that_of_the_decay_requirement_is_taken(call, configs, tmp_path):
    """The main gear requires decay from 0.25 deg; minimal.yaml requires none and is released from 1 deg."""
    for name, angle in (("main_gear", 0.25), ("minimal", 1.0)):
        assert call("simulate", configs / f"{name}.yaml", "--speed", "40", "--duration", "0.1", "-o", name).code == 0
        assert read(tmp_path / name).columns["yaw_angle"][0] == pytest.approx(np.deg2rad(angle))


@pytest.fixture(scope="module")
def optimum(configs, tmp_path_factory):
    """Folder with the result.json of a small optimisation of minimal.yaml."""
    study = damperopt.load(configs / "minimal.yaml").replace(solver__starts=2)
    result = damperopt.optimise(study, workers=1)
    assert result.status == "solved"
    place = tmp_path_factory.mktemp("optimum")
    (place / "result.json").write_text(result.to_json(), encoding="utf-8")
    return SimpleNamespace(folder=place, result=result)


@pytest.mark.parametrize("name", ["", "result.json"])
def test_design_of_a_result_is_simulated(name, call, configs, tmp_path, optimum):
    """The file or its folder: motion.json has its design, and the optimum, which is stable with a margin, decays."""
    done = call("simulate", configs / "minimal.yaml", *QUESTION, "--design", optimum.folder / name, "-o", "out")
    assert done.code == 0, done.err
    motion = read(tmp_path / "out").motion
    assert motion["design"] == optimum.result.design
    assert motion["kind"] in ("decaying", "settled")
    assert motion["decay_ratio"] < 1


def test_design_brings_its_layout(call, configs, tmp_path, optimum):
    """A Boeing design on a study of another layout is simulated as Boeing: k_lambda, not I_arm."""
    done = call("simulate", configs / "main_gear.yaml", *QUESTION, "--design", optimum.folder, "-o", "out")
    assert done.code == 0, done.err
    found = read(tmp_path / "out")
    assert found.motion["design"] == optimum.result.design
    assert np.abs(found.columns["spring_force"] / found.columns["spring_deflection"])[0] == pytest.approx(
        optimum.result.design["k_lambda"], rel=PRINTED_ROW
    )


ANSWERS = {
    # what to change, speed, release, duration, kind, status, part of the message
    "well damped": ([damping("20000 N s/m")], "40", "1deg", "1", "settled", "completed", ""),
    "below critical damping": ([damping("500 N s/m")], "80", "14deg", "1.5", "limit cycle", "completed", ""),
    "stop met": (
        [("  geometry: planar ", "  end_stop: {stroke: 6 mm}\n  geometry: planar ")],
        "80",
        "1deg",
        "2",
        "diverging",
        "stopped",
        "the damper meets its stop at 6 mm after 0.1978 s",
    ),
    "slip beyond the law": (
        [("tyre:\n", "tyre:\n  slip_range: 0.5 deg\n")],
        "80",
        "1deg",
        "2",
        "diverging",
        "stopped",
        "the slip exceeds tyre.slip_range, 0.5 deg",
    ),
}


@pytest.mark.parametrize("case", ANSWERS)
def test_kind_and_status_of_the_answer(case, call, study_file, tmp_path):
    """Settled, limit cycle or stopped: always exit code 0, and JSON and screen say which and why."""
    changes, speed, yaw, duration, kind, status, message = ANSWERS[case]
    file = study_file(*changes)
    done = call("simulate", file, "--speed", speed, "--release", f"yaw={yaw}", "--duration", duration, "-o", "out")
    assert done.code == 0, done.err
    motion = read(tmp_path / "out").motion
    assert (motion["kind"], motion["status"]) == (kind, status)
    assert message in motion["message"]
    assert bool(motion["message"]) == (status == "stopped")
    assert f"{kind}: {speed} m/s" in done.out
    assert motion["message"] in done.out
    assert (motion["duration"] < float(duration) - 0.1) == (status == "stopped")


REFUSED = {
    "no such state": (("--release", "roll=1deg"), "--release: 'roll' is unknown; allowed: yaw_angle, bending_angle"),
    "release of a rate": (("--release", "yaw_rate=1"), "--release: 'yaw_rate' is unknown"),
    "kick of an angle": (("--kick", "yaw_angle=1deg"), "--kick: 'yaw_angle' is unknown; allowed: yaw_rate"),
    "unit of another dimension": (("--release", "yaw=1m"), "'1m' has the unit 'm'"),
    "no unit at all": (("--release", "yaw=1furl"), "'1furl' has the unit 'furl'"),
    "no value": (("--release", "yaw"), "--release: found 'yaw'; allowed: name=value"),
    "nothing moves": (("--release", "yaw=0"), "nothing is disturbed"),
    "too large": (("--release", "yaw=60deg"), "out of range"),
    "nan": (("--release", "yaw=nan"), "'nan' is not a number"),
    "infinite": (("--kick", "yaw=inf"), "'inf' is not a number"),
    "step without a value": (("--step", "torque=nan"), "'nan' is not a number"),
    "no duration": (("--duration", "0"), "--duration: 0.0 is out of range"),
    "too long": (("--duration", "1e6"), "allowed: at most"),
    "negative speed": (("--speed", "-5"), "--speed: -5.0 is out of range"),
    "speed of nothing": (("--speed", "fast"), "--speed: 'fast' is not a number"),
    "no load": (("--load", "0"), "--load: 0.0 is out of range"),
    "load in kg": (("--load", "120kg"), "--load: '120kg' has the unit 'kg'"),
    "engine": (("--engine", "rk4"), "engine: found 'rk4'; allowed: auto, exact, erk, cvodes, idas"),
    "output exists": (("-o", "full"), "full: exists already"),
    "output is a file": (("-o", "broken.json"), "broken.json: exists already"),
    "output cannot be written": (("-o", "/proc/none/out"), "cannot be written"),
    "no design": (("--design", "absent.json"), "absent.json: cannot be read"),
    "folder without a design": (("--design", "full"), "result.json: cannot be read"),
    "design is no JSON": (("--design", "text.json"), "text.json:1: (file): Invalid JSON"),
    "design is no result": (("--design", "broken.json"), "broken.json:1: status"),
    "design of another layout": (("--design", "other.json"), "allowed: a result with positive c_lambda, I_arm, L, gamma, b"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_questions_end_with_code_2_and_one_message(case, call, configs, tmp_path, optimum):
    """One line that says what is wrong, no traceback, and nothing written."""
    options, says = REFUSED[case]
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    (tmp_path / "broken.json").write_text("{}")
    (tmp_path / "text.json").write_text("no result")
    # a layout whose design variables are not those of the design
    other = json.loads(optimum.result.to_json()) | {"topology": "arreaza"}
    (tmp_path / "other.json").write_text(json.dumps(other))
    before = {path.name for path in tmp_path.rglob("*")}
    done = call("simulate", configs / "thesis_gear.yaml", "--speed", "40", "-o", "out", *options)
    assert done.code == 2, done.out
    assert says in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert not done.out
    assert {path.name for path in tmp_path.rglob("*")} == before


def test_a_gear_without_bending_cannot_be_released_in_bending(call, configs, tmp_path):
    """The third-order gear has no such state; the message names those it has."""
    done = call("simulate", configs / "minimal.yaml", "--speed", "40", "--release", "bending=1deg", "-o", "out")
    assert done.code == 2
    assert "gear of order 3 does not have; allowed: yaw_angle, yaw_rate, string_deflection" in done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_interrupt_leaves_nothing_half_written(configs, tmp_path):
    """Ctrl-C in a run of minutes: exit code 130, no traceback, no file."""
    question = ("--speed", "40", "--duration", "800", "--engine", "exact", "-o", "runs/out")
    command = [*PROCESS, "simulate", str(configs / "thesis_gear.yaml"), *question]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while not (tmp_path / "runs").exists():  # the run has begun
        assert process.poll() is None
        time.sleep(0.05)
    time.sleep(1)
    os.killpg(process.pid, signal.SIGINT)
    _, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in error
    assert not list(tmp_path.iterdir())


def test_a_motion_that_stops_at_once_is_an_answer(main_gear):
    """A rigid stop a micrometre away: nothing to count, no traceback."""
    study = main_gear.replace(damper__end_stop={"stroke": 1e-6})
    motion = damperopt.simulate(study, speed=40, disturbance={"kick": {"yaw_rate": 1.0}}, duration=1)
    found = damperopt.motion_of(motion)
    assert motion.status == "stopped"
    assert (found.kind, found.cycles, found.decay_ratio) == ("diverging", 0.0, None)


@pytest.mark.slow
def test_exact_engine_shows_every_cycle_of_a_long_motion(main_gear):
    """20 s at 50 Hz: as many cycles as the smooth engine counts, not 2000 points' worth."""
    study, release = main_gear.replace(gear__order=3), {"release": {"yaw_angle": 1e-3}}
    smooth = damperopt.motion_of(damperopt.simulate(study, speed=40, disturbance=release, duration=20, engine="cvodes"))
    exact = damperopt.motion_of(damperopt.simulate_exactly(study, speed=40, disturbance=release, duration=20, tolerance=1e-8))
    assert smooth.cycles > 900
    assert exact.cycles == smooth.cycles
    assert exact.decay_ratio == pytest.approx(smooth.decay_ratio, rel=COMMANDED_PEAK)


HISTORY = """time [s], speed [m/s], load [kN], yaw_torque [N m]
0.0, 40, 100, 0
0.1, 38, 160, 300
0.3, 30, 150, 0
"""


def test_along_a_history(call, configs, tmp_path):
    """Files, peaks with their places, speed and load in the table; the torque of the history is all that disturbs."""
    (tmp_path / "roll.csv").write_text(HISTORY)
    study = configs / "thesis_gear.yaml"
    done = call("simulate", study, "--history", "roll.csv", "--engine", "exact", "-o", "out")
    assert done.code == 0, done.err
    assert "Along the history: 40 to 30 m/s, 100 to 150 kN, at most 160 kN, 0.3 s" in done.out
    assert "After the yaw torque of the history" in done.out
    assert "release" not in done.out
    assert "It leaves the envelope of the study" in done.out
    assert {file.name for file in (tmp_path / "out").iterdir()} == FILES
    found = read(tmp_path / "out")
    t, V = found.columns["time"], found.columns["speed"]
    np.testing.assert_allclose(V, np.interp(t, [0, 0.1, 0.3], [40, 38, 30]), rtol=1e-9)
    peak = found.motion["peaks"]["yaw_angle"]
    assert peak["value"] == pytest.approx(np.abs(found.columns["yaw_angle"]).max(), rel=1e-9)
    assert peak["speed"] == pytest.approx(np.interp(peak["time"], t, V))
    assert found.motion["disturbance"] is None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), "--speed: missing; allowed: a speed such as 40 or '120 kt', or --history with a CSV file"),
        (("--history", "roll.csv", "--speed", "40"), "--speed: found 40 beside --history, which says it"),
        (("--history", "roll.csv", "--duration", "1"), "--duration: found 1 beside --history"),
        (("--history", "nowhere.csv"), "nowhere.csv: cannot be read"),
        (("--history", "stroke.csv"), "stroke.csv: stroke: of a gear without gear.strut"),
    ],
)
def test_questions_about_histories_that_are_refused(call, configs, tmp_path, options, message):
    (tmp_path / "roll.csv").write_text(HISTORY)
    (tmp_path / "stroke.csv").write_text("time [s], speed [m/s], load [kN], stroke [mm]\n0, 40, 150, 0\n1, 30, 150, 9\n")
    done = call("simulate", configs / "thesis_gear.yaml", *options, "-o", "out")
    assert done.code == 2
    assert message in " ".join(done.err.split())
    assert not (tmp_path / "out").exists()
