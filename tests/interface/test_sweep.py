"""Sweeps: points, samples, resumption, the dataset."""

import json
import os
import time
from contextlib import contextmanager

import numpy as np
import pytest
from sweep_tools import ANALYSIS, inline

import damperopt
from damperopt.errors import OutputError
from damperopt.sweep import dataset, load_sweep, run_sweep, stored_records, sweep_of


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
    monkeypatch.setattr("damperopt.sweep.points.worst_over_damping", lambda *given: 1 / 0)
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


@pytest.mark.slow
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


def test_a_load_is_a_number_of_its_axis(main_gear):
    sweep = sweep_of(main_gear, vary={"envelope.vertical_load": ["100 kN", 125e3], "envelope.speed.max": [80.0, 90.0]})
    assert sweep.axes == {"envelope.vertical_load": (100e3, 125e3), "envelope.speed.max": (80.0, 90.0)}
    assert sweep.points[3].study.envelope.loads == (125e3,)


@pytest.mark.parametrize("text", ["", "null", "[]", "5", "{}", "{", '{"index": 0}'])
def test_a_record_that_cannot_be_read_is_as_one_that_is_missing(nose, tmp_path, text):
    sweep = sweep_of(nose, run="analyse", vary={"gear.caster_length": [0.1, 0.2]})
    run_sweep(sweep, tmp_path, inline, 1)
    (tmp_path / "points" / "000000.json").write_text(text)
    assert set(stored_records(sweep, tmp_path)) == {1}


@pytest.mark.parametrize(
    "change", [{"index": 1}, {"status": "fine"}, {"numbers": [1]}, {"modes": {}}, {"seconds": "1"}, {"more": 1}, {"key": "0"}]
)
def test_a_record_that_no_sweep_has_written_is_not_believed(nose, tmp_path, change):
    sweep = sweep_of(nose, run="analyse", vary={"gear.caster_length": [0.1, 0.2]})
    run_sweep(sweep, tmp_path, inline, 1)
    path = tmp_path / "points" / "000000.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    assert set(stored_records(sweep, tmp_path)) == {1}


def test_an_answer_of_another_program_is_not_believed_and_asked_again(nose, tmp_path, monkeypatch):
    sweep = sweep_of(nose, run="analyse", vary={"gear.caster_length": [0.1, 0.2]})
    monkeypatch.setattr("damperopt.sweep.points.program", lambda: "0.1.0+other")
    records = run_sweep(sweep, tmp_path, inline, 1)
    assert {record.status for record in records.values()} == {"error"}
    assert "0.1.0+other" in records[0].message
    assert not records[0].numbers
    assert not stored_records(sweep, tmp_path)


def test_stable_points_that_miss_the_margin_are_called_so(configs, tmp_path):
    stable = load_sweep(configs / "sweeps" / "scatter.yaml").points.base.replace(requirements__decay=None)
    margins = {"requirements.stability_margin": [0.01, 50.0]}
    kept, missed = run_sweep(sweep_of(stable, run="analyse", vary=margins), tmp_path, inline, 1).values()
    assert kept.numbers["abscissa"] == missed.numbers["abscissa"] < -0.01
    assert (kept.status, missed.status) == ("stable", "margin missed")
    assert missed.good


def test_a_folder_that_is_removed_while_the_sweep_runs_is_said(nose, tmp_path):
    import shutil

    sweep = sweep_of(nose, **ANALYSIS)
    with pytest.raises(OutputError, match="was removed while the sweep ran"):
        run_sweep(sweep, tmp_path / "out", inline, 1, lambda record: shutil.rmtree(tmp_path / "out", ignore_errors=True))
    assert not (tmp_path / "out").exists()


def test_a_million_samples_start_at_once(nose):
    clock = time.perf_counter()
    over = {"gear.caster_length": {"normal": [0.1, 0.01]}, "tyre.relaxation_length": {"uniform": [0.2, 0.4]}}
    sweep = sweep_of(nose, run="analyse", samples={"count": 1_000_000, "over": over})
    grid = sweep_of(
        nose,
        run="analyse",
        vary={key: {"from": 0.1, "to": 0.2, "points": 316} for key in ("gear.caster_length", "tyre.relaxation_length")},
    )
    assert (len(sweep.points), len(grid.points)) == (1_000_000, 99_856)
    assert sweep.points[999_999].study is not None
    assert grid.points[-1].values == {"gear.caster_length": 0.2, "tyre.relaxation_length": 0.2}
    assert time.perf_counter() - clock < 20  # 10 minutes when every study is made first
