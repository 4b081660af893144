"""The command `sweep`: its files, interruption, its folder; in this process but where processes count."""

import json
import signal
import subprocess
import time
from importlib.metadata import version as damperopt_version

import pytest
from sweep_tools import COMMAND

from damperopt.output.staging import lock, unlock


@pytest.mark.slow
def test_command_writes_dataset_table_and_figure_and_goes_on(file, tmp_path, call):
    done = subprocess.run([*COMMAND, file, "-o", tmp_path / "out"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert {"sweep.nc", "sweep.csv", "sweep.png", "sweep.svg", "points"} <= {f.name for f in (tmp_path / "out").iterdir()}
    lines = (tmp_path / "out" / "sweep.csv").read_text().splitlines()
    assert len(lines) == 11
    assert lines[0].startswith("gear_caster_length [m],damper_torsional_damping [N m s/rad],abscissa [1/s]")
    import xarray

    with xarray.open_dataset(tmp_path / "out" / "sweep.nc", engine="scipy") as found:
        assert found.attrs["damperopt"] == damperopt_version("damperopt")
        assert {"config_sha256", "python", "started", "wall_time", "seed"} <= set(found.attrs)
    again = call("sweep", file, "-o", tmp_path / "out")
    assert "10 of 10 points" in again.out
    assert not [f for f in (tmp_path / "out").iterdir() if f.name.startswith(".")]


@pytest.mark.slow
@pytest.mark.parametrize(("signal_sent", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupt_keeps_what_was_finished_and_the_same_command_goes_on(configs, tmp_path, call, signal_sent, code):
    path, out = tmp_path / "long.yaml", tmp_path / "out"
    text = f"base: {configs / 'nose_gear_thota.yaml'}\nrun: analyse\n"
    path.write_text(text + "vary: {gear.caster_length: {from: 80 mm, to: 160 mm, points: 60}}\n")
    running = subprocess.Popen([*COMMAND, path, "-o", out, "--workers", "1"], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while not list((out / "points").glob("*.json")) and time.monotonic() < deadline:
        time.sleep(0.01)
    running.send_signal(signal_sent)
    _, message = running.communicate(timeout=120)
    assert running.returncode == code
    assert "the same command goes on" in message
    assert "Traceback" not in message
    kept = {f.name: f.stat().st_mtime_ns for f in (out / "points").glob("*.json")}
    assert 1 <= len(kept) < 60
    done = call("sweep", path, "-o", out)
    assert done.code == 0, done.err
    assert {name: (out / "points" / name).stat().st_mtime_ns for name in kept} == kept
    assert len(list((out / "points").glob("*.json"))) == 60


def test_two_sweeps_in_one_folder_are_refused_and_leavings_of_a_dead_one_are_swept_up(file, tmp_path, call):
    out = tmp_path / "out"
    (out / ".damperopt-dead").mkdir(parents=True)
    (out / "points").mkdir()
    (out / "points" / "000001.part").touch()
    held = lock(out)
    done = call("sweep", file, "-o", out)
    assert done.code == 2
    assert "another sweep is at work there" in done.err
    unlock(held)
    done = call("sweep", file, "-o", out)
    assert done.code == 0, done.err
    assert not list(out.rglob(".damperopt-*")) + list(out.rglob("*.part"))


def test_no_scheduler_is_said_in_one_line(file, tmp_path, call, monkeypatch):
    monkeypatch.setattr("damperopt.workers.PATIENCE", 1.0)
    done = call("sweep", file, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:9")
    assert done.code == 2
    assert "no scheduler answers" in done.err
    assert not (tmp_path / "out").exists()
    assert "Traceback" not in done.err


def test_points_that_make_no_study_are_said_before_the_work(configs, tmp_path, call):
    path = tmp_path / "partly.yaml"
    path.write_text(f"base: {configs / 'nose_gear_thota.yaml'}\nrun: analyse\nvary: {{gear.yaw_inertia: [-1.0, 90.0]}}\n")
    done = call("sweep", path, "-o", tmp_path / "out")
    assert done.code == 4
    assert "1 of 2 points make no study" in done.err.splitlines()[0]
    assert "unstable: 1" in done.out
    assert "invalid: 1" in done.out


def test_folder_of_another_sweep_is_left_alone(file, tmp_path, call):
    out = tmp_path / "out"
    out.mkdir()
    (out / "sweep.json").write_text(json.dumps({"file": "other.yaml"}))
    done = call("sweep", file, "-o", out)
    assert done.code == 2
    assert "other.yaml" in done.err


@pytest.mark.parametrize("text", ["{", "[]"])
def test_a_marker_that_cannot_be_read_is_made_anew(file, tmp_path, call, text):
    out = tmp_path / "out"
    out.mkdir()
    (out / "sweep.json").write_text(text)
    done = call("sweep", file, "-o", out)
    assert done.code == 0, done.err
    assert json.loads((out / "sweep.json").read_text())["file"] == str(file)
