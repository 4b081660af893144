"""Sweeps whose workers, cluster or scheduler die, or run another program."""

import os
import signal
import threading
import time
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial

import pytest
from sweep_tools import ANALYSIS, inline

import damperopt
from damperopt.errors import ConfigError
from damperopt.provenance import program_parts
from damperopt.sweep import run_sweep, sweep_of
from damperopt.sweep.points import run_point
from damperopt.workers import SchedulerLost, check_cluster, cluster, process_pool


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


def test_a_scheduler_that_is_lost_ends_the_wait_with_what_is_kept(nose, tmp_path):
    @contextmanager
    def short_lived():
        with inline() as executor:
            asked = []

            def check():
                asked.append(1)
                if len(asked) > 2:
                    raise SchedulerLost("scheduler lost (tcp://here)")

            executor.check = check
            yield executor

    with pytest.raises(SchedulerLost, match=r"scheduler lost \(tcp://here\); 2 of 6 points are kept") as lost:
        run_sweep(sweep_of(nose, **ANALYSIS), tmp_path, short_lived, 1)
    assert lost.value.exit_code == 4
    assert len(list((tmp_path / "points").glob("*.json"))) == 2


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
    check_cluster(scheduler.scheduler_address, program_parts)
    with pytest.raises(ConfigError, match="allowed: the same version"):
        check_cluster(scheduler.scheduler_address, partial(parts_by_process, os.getpid()))


def parts_by_process(client):
    """Program of a worker that differs from the client's."""
    return {"damperopt": "0.1.0+client" if os.getpid() == client else "0.1.0+worker"}


def test_a_pool_that_is_left_by_an_exception_leaves_no_thread_behind():
    """One that still closes the pipe of its pool while the interpreter ends would print a traceback after Ctrl-C."""

    def left_at_work():
        with process_pool(2) as pool:
            for _ in range(2):
                pool.submit(time.sleep, 60.0)
            raise KeyboardInterrupt

    before = set(threading.enumerate())
    with pytest.raises(KeyboardInterrupt):
        left_at_work()
    assert not [thread for thread in set(threading.enumerate()) - before if "ExecutorManager" in type(thread).__name__]
