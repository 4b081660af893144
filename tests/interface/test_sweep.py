"""Sweeps: points, resumption, crashes, a cluster on loopback, the dataset, and what is refused."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib.metadata import version as damperopt_version

import numpy as np
import pytest

import damperopt
from damperopt.errors import ConfigError
from damperopt.sweep import dataset, load_sweep, run_sweep, stored_records, sweep_of
from damperopt.sweep.points import run_point
from damperopt.workers import cluster, process_pool

COMMAND = [sys.executable, "-W", "error::RuntimeWarning", "-c", "from damperopt.cli import main; main()", "sweep"]

ANALYSIS = {"run": "analyse", "vary": {"gear.caster_length": [0.1, "120 mm", 0.2], "damper.torsional_damping": [300.0, 900.0]}}


@pytest.fixture(scope="module")
def nose(request):
    return damperopt.load(request.config.rootpath / "configs" / "nose_gear_thota.yaml")


@contextmanager
def inline():
    """An executor that works at once, in this process."""

    class Inline(Executor):
        def submit(self, work, /, *given, **named):
            future = Future()
            try:
                future.set_result(work(*given, **named))
            except BaseException as error:
                future.set_exception(error)
            return future

    yield Inline()


def test_points_of_a_grid_hold_values_in_si_and_the_last_axis_is_fastest(nose):
    sweep = sweep_of(nose, **ANALYSIS)
    assert sweep.axes == {"gear.caster_length": (0.1, 0.12, 0.2), "damper.torsional_damping": (300.0, 900.0)}
    assert [tuple(p.values.values()) for p in sweep.points[:3]] == [(0.1, 300.0), (0.1, 900.0), (0.12, 300.0)]
    assert sweep.points[2].study == nose.replace(damper__torsional_damping=300.0)


def test_dataset_has_what_eigenvalues_say(nose, tmp_path):
    sweep = sweep_of(nose, **ANALYSIS, eigenvalue_speeds=7)
    found = dataset(sweep, run_sweep(sweep, tmp_path, inline, 1))
    assert dict(found.sizes) == {"gear_caster_length": 3, "damper_torsional_damping": 2, "speed_index": 7, "mode": 5}
    for e in (0.1, 0.2):
        for c in (300.0, 900.0):
            here = found.sel(gear_caster_length=e, damper_torsional_damping=c)
            study = nose.replace(gear__caster_length=e, damper__torsional_damping=c)
            values = here.eigenvalue_real.values + 1j * here.eigenvalue_imag.values
            for speed, row in zip(here.eigenvalue_speed.values, values, strict=True):
                expected = np.linalg.eigvals(damperopt.linear_gear(study).matrices(speed, 350e3)[0])
                assert np.sort_complex(row) == pytest.approx(np.sort_complex(expected), abs=1e-9)
            grid = [damperopt.linear_gear(study).abscissa(np.linspace(2, 200, 400), F).max() for F in (150e3, 350e3)]
            assert here.abscissa >= max(grid) - 1e-9
    file = tmp_path / "sweep.nc"
    found.to_netcdf(file, engine="scipy")
    import xarray

    with xarray.open_dataset(file, engine="scipy") as again:
        assert again.abscissa.values == pytest.approx(found.abscissa.values)
        assert again.status.values.tolist() == found.status.values.tolist()
        assert again.abscissa.attrs["units"] == "1/s"
        assert again.gear_caster_length.attrs == {"units": "m", "key": "gear.caster_length"}


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube", "random"])
def test_samples_follow_their_distributions(nose, method):
    over = {
        "gear.caster_length": {"uniform": ["80 mm", "160 mm"]},
        "tyre.relaxation_length": {"normal": ["0.3 m", "30 mm"]},
        "gear.lateral.damping": {"log_uniform": [100.0, 1000.0]},
        "damper.torsional_damping": {"triangular": [100.0, 300.0, 800.0]},
    }
    settings = {"run": "analyse", "samples": {"method": method, "count": 1024, "seed": 7, "over": over}}
    sweep = sweep_of(nose, **settings)
    drawn = {key: np.array([p.values[key] for p in sweep.points]) for key in over}
    close = 0.02 if method == "sobol" else 0.1
    assert drawn["gear.caster_length"].mean() == pytest.approx(0.12, rel=close)
    assert drawn["tyre.relaxation_length"].std() == pytest.approx(0.03, rel=close)
    assert np.log(drawn["gear.lateral.damping"]).mean() == pytest.approx(np.log(10**2.5), rel=close)
    assert drawn["damper.torsional_damping"].mean() == pytest.approx(400.0, rel=close)
    assert sweep_of(nose, **settings).points[77].values == sweep.points[77].values


def test_a_draw_that_makes_no_study_is_a_recorded_failure(nose, tmp_path):
    over = {"gear.lateral.damping": {"normal": [0.0, 100.0]}}
    sweep = sweep_of(nose, run="analyse", samples={"count": 8, "over": over})
    records = run_sweep(sweep, tmp_path, inline, 1)
    bad = {i for i, p in enumerate(sweep.points) if p.values["gear.lateral.damping"] < 0}
    assert 0 < len(bad) < 8
    assert {i for i, r in records.items() if r.status == "invalid"} == bad
    assert "gear.lateral.damping" in records[min(bad)].message
    assert np.isnan(dataset(sweep, records).abscissa.values[sorted(bad)]).all()


def test_what_raises_at_a_point_is_its_record_and_is_tried_again_next_time(nose, tmp_path, monkeypatch):
    sweep = sweep_of(nose, **ANALYSIS)
    monkeypatch.setattr("damperopt.sweep.points.worst_points", lambda *given: 1 / 0)
    records = run_sweep(sweep, tmp_path, inline, 1)
    assert {r.status for r in records.values()} == {"error"}
    assert "ZeroDivisionError" in records[0].message
    assert not stored_records(sweep, tmp_path)
    monkeypatch.undo()
    assert {r.status for r in run_sweep(sweep, tmp_path, inline, 1).values()} == {"unstable"}


def test_finished_points_are_taken_as_they_are_and_others_are_not(nose, tmp_path):
    sweep, seen = sweep_of(nose, **ANALYSIS), []
    run_sweep(sweep, tmp_path, inline, 1)
    os.remove(tmp_path / "points" / "000002.json")
    (tmp_path / "points" / "000004.json").write_text("{")  # cut off
    run_sweep(sweep, tmp_path, inline, 1, lambda record: seen.append(record.index))
    assert sorted(seen) == [2, 4]
    other = sweep_of(nose.replace(gear__yaw_inertia=120.0), **ANALYSIS)
    assert not stored_records(other, tmp_path)
    assert not stored_records(sweep_of(nose, **ANALYSIS, eigenvalue_speeds=9), tmp_path)


def test_optimised_points_are_those_of_optimise_and_start_from_their_neighbours(main_gear, tmp_path):
    base = main_gear.replace(damper__topology="boeing", solver__starts=4)
    sweep = sweep_of(base, vary={"requirements.stability_margin": [0.1, 0.15]})
    starts = []

    @contextmanager
    def watched():
        with inline() as executor:
            submit = executor.submit

            def spy(work, study, run, speeds, start):
                starts.append(start)
                return submit(work, study, run, speeds, start)

            executor.submit = spy
            yield executor

    records = run_sweep(sweep, tmp_path, watched, 1)
    alone = damperopt.optimise(base)
    assert records[0].numbers["mass"] == pytest.approx(alone.mass.total, rel=1e-6)
    assert records[0].result["config"]["design"] == base.model_dump(mode="json")["design"]
    assert starts[0] is None
    assert starts[1] == records[0].result["design"]
    assert records[1].numbers["mass"] > records[0].numbers["mass"]


def dies_at_the_first(folder, study_json, run, speeds, start):
    """Work that kills its process, once or always, at caster lengths of 0.1 and 0.2 m."""
    study = damperopt.Study.model_validate_json(study_json)
    mark = folder / str(study.gear.caster_length)
    always = study.gear.caster_length == 0.2 and study.damper.torsional_damping == 900.0
    if always or (study.gear.caster_length == 0.1 and not mark.exists()):
        mark.touch()
        os._exit(1)
    return run_point(study_json, run, speeds, start)


def test_a_worker_that_dies_costs_no_point_but_the_one_that_kills_it_again(nose, tmp_path, monkeypatch):
    from functools import partial

    monkeypatch.setattr("damperopt.sweep.run.run_point", partial(dies_at_the_first, tmp_path))
    sweep = sweep_of(nose, **ANALYSIS)
    records = run_sweep(sweep, tmp_path, partial(process_pool, 2), 2)
    assert [records[i].status for i in range(6)] == ["unstable"] * 5 + ["crashed"]


def test_a_pool_that_is_broken_from_the_start_ends(nose, tmp_path):
    @contextmanager
    def broken():
        class Broken(Executor):
            def submit(self, work, /, *given, **named):
                future = Future()
                future.set_exception(BrokenProcessPool("no workers"))
                return future

        yield Broken()

    records = run_sweep(sweep_of(nose, **ANALYSIS), tmp_path, broken, 2)
    assert {record.status for record in records.values()} == {"crashed"}


SWEEP = """\
name: nose gear
base: {base}
run: analyse
vary:
  gear.caster_length: {{from: 80 mm, to: 160 mm, points: 5}}
  damper.torsional_damping: [300 N m s/rad, 900 N m s/rad]
"""


@pytest.fixture
def file(configs, tmp_path):
    path = tmp_path / "nose.yaml"
    path.write_text(SWEEP.format(base=configs / "nose_gear_thota.yaml"))
    return path


def test_command_writes_dataset_table_and_figure_and_goes_on(file, tmp_path):
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
    again = subprocess.run([*COMMAND, file, "-o", tmp_path / "out"], capture_output=True, text=True)
    assert "10 of 10 points" in again.stdout
    assert not [f for f in (tmp_path / "out").iterdir() if f.name.startswith(".")]


@pytest.mark.slow
def test_interrupt_keeps_what_was_finished_and_the_same_command_goes_on(configs, tmp_path):
    path, out = tmp_path / "long.yaml", tmp_path / "out"
    text = f"base: {configs / 'minimal.yaml'}\nvary: {{requirements.stability_margin: {{from: 0.5, to: 2, points: 8}}}}\n"
    path.write_text(text)
    running = subprocess.Popen([*COMMAND, path, "-o", out, "--workers", "1"], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while not list((out / "points").glob("*.json")) and time.monotonic() < deadline:
        time.sleep(0.2)
    running.send_signal(signal.SIGINT)
    _, message = running.communicate(timeout=120)
    assert running.returncode == 130
    assert "the same command goes on" in message
    assert "Traceback" not in message
    kept = {f.name: f.stat().st_mtime_ns for f in (out / "points").glob("*.json")}
    assert 1 <= len(kept) < 8
    done = subprocess.run([*COMMAND, path, "-o", out], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert {name: (out / "points" / name).stat().st_mtime_ns for name in kept} == kept
    assert len(list((out / "points").glob("*.json"))) == 8


@pytest.fixture
def scheduler():
    """A Dask scheduler and two worker processes on loopback."""
    distributed = pytest.importorskip("distributed", reason="the cluster extra is part of the development install")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None
    ) as local:
        yield local


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning:distributed", "ignore::DeprecationWarning:tornado")
def test_a_cluster_gives_the_same_and_survives_the_loss_of_a_worker(nose, tmp_path, scheduler):
    from functools import partial

    sweep = sweep_of(nose, run="analyse", vary={"gear.caster_length": {"from": 0.05, "to": 0.3, "points": 24}})
    here = run_sweep(sweep, tmp_path / "here", inline, 1)
    killed = []

    def kill_one(record):
        if not killed:
            killed.append(next(iter(scheduler.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    there = run_sweep(sweep, tmp_path / "there", partial(cluster, scheduler.scheduler_address), 2, kill_one)
    assert killed
    assert {i: r.numbers for i, r in there.items()} == {i: r.numbers for i, r in here.items()}


def test_no_scheduler_is_said_in_one_line(file, tmp_path):
    done = subprocess.run(
        [*COMMAND, file, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:9"], capture_output=True, text=True
    )
    assert done.returncode == 2
    assert "no scheduler answers" in done.stderr
    assert not (tmp_path / "out").exists()
    assert "Traceback" not in done.stderr


BAD = {
    "unknown key": ("vary: {gear.caster: [1, 2]}", "gear.caster"),
    "unit": ("vary: {gear.caster_length: [1 kg, 2 kg]}", "kg"),
    "nothing": ("run: analyse", "nothing is varied"),
    "empty list": ("vary: {gear.caster_length: []}", "empty list"),
    "twice": ("vary: {gear.caster_length: [0.1, 100 mm]}", "twice"),
    "inverted": ("vary: {gear.caster_length: {from: 2, to: 1, points: 3}}", "from < to"),
    "log of zero": ("vary: {gear.caster_length: {from: 0, to: 1, points: 3, spacing: log}}", "0 < from"),
    "one point": ("vary: {gear.caster_length: {from: 0, to: 1, points: 1}}", "points"),
    "names and numbers": ("vary: {material: [AISI 4340, 3]}", "material"),
    "range of names": ("vary: {damper.topology: {from: 1, to: 2, points: 3}}", "range of names"),
    "law": ("samples: {count: 4, over: {gear.caster_length: {uniform: [2, 1]}}}", "low, high"),
    "two laws": ("samples: {count: 4, over: {gear.caster_length: {uniform: [1, 2], normal: [1, 2]}}}", "none or several"),
    "deviation": ("samples: {count: 4, over: {gear.caster_length: {normal: [1, -2]}}}", "deviation > 0"),
    "both": (
        "vary: {gear.caster_length: [1]}\nsamples: {count: 4, over: {gear.caster_length: {normal: [1, 2]}}}",
        "allowed: one of them",
    ),
    "set": ("set: {gear.mass: 3}\nvary: {gear.caster_length: [0.1]}", "gear.mass"),
    "all invalid": ("vary: {gear.yaw_inertia: [-1.0, -2.0]}", "no point is a valid study"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_sweeps_are_refused_with_file_line_and_key(configs, tmp_path, case):
    text, words = BAD[case]
    path = tmp_path / "bad.yaml"
    path.write_text(f"base: {configs / 'main_gear.yaml'}\n{text}\n")
    with pytest.raises(ConfigError) as refused:
        load_sweep(path)
    assert words in str(refused.value)
    assert f"{path}:" in str(refused.value)


def test_points_that_make_no_study_are_said_before_the_work(configs, tmp_path):
    path = tmp_path / "partly.yaml"
    path.write_text(f"base: {configs / 'nose_gear_thota.yaml'}\nrun: analyse\nvary: {{gear.yaw_inertia: [-1.0, 90.0]}}\n")
    done = subprocess.run([*COMMAND, path, "-o", tmp_path / "out"], capture_output=True, text=True)
    assert done.returncode == 4
    assert "1 of 2 points make no study" in done.stderr.splitlines()[0]
    assert "unstable: 1" in done.stdout
    assert "invalid: 1" in done.stdout


def test_missing_base_is_said_with_both_files(tmp_path):
    path = tmp_path / "lost.yaml"
    path.write_text("base: nowhere.yaml\nvary: {gear.caster_length: [0.1]}\n")
    with pytest.raises(ConfigError, match=r"lost.yaml:1: base: .*nowhere.yaml: cannot be read"):
        load_sweep(path)


def test_folder_of_another_sweep_is_left_alone(file, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "sweep.json").write_text(json.dumps({"file": "other.yaml"}))
    done = subprocess.run([*COMMAND, file, "-o", out], capture_output=True, text=True)
    assert done.returncode == 2
    assert "other.yaml" in done.stderr


def test_a_load_is_a_number_of_its_axis(main_gear):
    sweep = sweep_of(main_gear, vary={"envelope.vertical_load": ["100 kN", 125e3], "envelope.speed.max": [80.0, 90.0]})
    assert sweep.axes == {"envelope.vertical_load": (100e3, 125e3), "envelope.speed.max": (80.0, 90.0)}
    assert sweep.points[3].study.envelope.loads == (125e3,)


@pytest.mark.parametrize("text", ["{", "[]"])
def test_a_marker_that_cannot_be_read_is_made_anew(file, tmp_path, text):
    out = tmp_path / "out"
    out.mkdir()
    (out / "sweep.json").write_text(text)
    done = subprocess.run([*COMMAND, file, "-o", out], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads((out / "sweep.json").read_text())["file"] == str(file)


def test_shipped_sweeps_are_valid(configs):
    counts = {f.stem: len(load_sweep(f).points) for f in (configs / "sweeps").glob("*.yaml")}
    assert counts == {"margin": 15, "decay": 14, "ranking": 18, "envelope": 16, "scatter": 128}
