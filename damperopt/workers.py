"""Worker processes, here or on a cluster."""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from . import interrupts
from .errors import ConfigError, DamperoptError

if TYPE_CHECKING:
    from distributed import Client

__all__ = [
    "SchedulerLost",
    "WorkersLost",
    "check_cluster",
    "cluster",
    "cluster_size",
    "cores",
    "executor",
    "process_pool",
]

SILENCE = 60.0
"""Seconds of silence after which a scheduler counts as lost, though its connection stands."""

A_MOMENT = 10.0
"""Seconds that a killed pool is given to clear up."""

PATIENCE = float(os.environ.get("DAMPEROPT_SCHEDULER_PATIENCE", "10"))
"""Seconds for which a scheduler is looked for."""


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def executor(workers: int) -> Iterator[Executor | None]:
    """Pool of worker processes, or None for a single worker; an interrupt ends them at once.

    Parameters
    ----------
    workers : int
    """
    if workers <= 1:
        yield None
    else:
        with process_pool(workers) as pool:
            yield pool


class WorkersLost(DamperoptError, BrokenExecutor):
    """Worker processes died, or no new ones can be started."""


class _Pool(ProcessPoolExecutor):
    """Says in one way that there are no workers, whatever part of their machinery was killed."""

    def submit(self, fn: Callable[..., Any], /, *given: Any, **named: Any) -> Future:
        try:
            return super().submit(fn, *given, **named)
        except (EOFError, OSError) as error:  # of the fork server's socket
            raise BrokenProcessPool(f"no worker process can be started ({error})") from error


@contextmanager
def process_pool(workers: int) -> Iterator[Executor]:
    """Pool of worker processes, which end with this one; an interrupt ends them at once.

    Parameters
    ----------
    workers : int

    Yields
    ------
    Executor

    Raises
    ------
    WorkersLost
        If a worker died.
    """
    interrupts.begin()
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if "forkserver" in methods:
        context.set_forkserver_preload(["damperopt.design"])  # casadi is imported once, not once per worker
        _start_fork_server()
    pool = _Pool(workers, mp_context=context, initializer=_start_worker)
    try:
        yield pool
    except BaseException as error:
        _kill(pool)
        if isinstance(error, BrokenExecutor) and not isinstance(error, WorkersLost):
            raise WorkersLost("the worker processes died (out of memory, or killed); fewer of them: --workers") from error
        raise
    pool.shutdown()


def _start_fork_server() -> None:
    """Start it deaf to Ctrl-C, which a terminal sends to all: it would die of one while it imports."""
    from multiprocessing import forkserver

    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _kill(pool: ProcessPoolExecutor) -> None:
    """End the workers in the middle of their work; without it the interpreter waits for them at its end."""
    processes = list((getattr(pool, "_processes", None) or {}).values())  # public from Python 3.14 on: kill_workers
    manager = getattr(pool, "_executor_manager_thread", None)
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    if manager is not None:
        manager.join(A_MOMENT)  # else the interpreter's end may write to the pipe that it closes


class SchedulerLost(DamperoptError):
    """The scheduler of a cluster no longer answers."""


class _Cluster(Executor):
    """Executor of a Dask cluster that can say whether its scheduler is still there."""

    def __init__(self, client: Client):
        self._client, self._inner = client, client.get_executor(pure=False)
        self._answered = time.monotonic()
        self._question: Future | None = None

    def submit(self, fn: Callable[..., Any], /, *given: Any, **named: Any) -> Future:
        self.check()
        return self._inner.submit(fn, *given, **named)

    def check(self) -> None:
        """Raise `SchedulerLost` where the connection is lost, or nothing has been heard for `SILENCE`."""
        now = time.monotonic()
        if self._question is None and now - self._answered > SILENCE / 10:
            loop: Any = self._client.loop
            self._question = asyncio.run_coroutine_threadsafe(self._client.scheduler.identity(), loop.asyncio_loop)
        elif self._question is not None and self._question.done():
            if self._question.exception() is None:
                self._answered = now
            self._question = None
        if self._client.status != "running" or now - self._answered > SILENCE:
            raise SchedulerLost(f"scheduler lost ({self._client.scheduler.address})")


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """Executor of a running Dask cluster, which runs the tasks of a worker that dies on another.

    Parameters
    ----------
    address : str
        ``tcp://HOST:PORT``, or ``tls://HOST:PORT`` with keys from Dask's own configuration.

    Yields
    ------
    Executor
        Raises `SchedulerLost` from ``submit`` and ``check`` where the scheduler is gone.
    """
    with _client(address) as client:
        yield _Cluster(client)


def cluster_size(address: str) -> int:
    """Threads of all its workers, at least 1."""
    with _client(address) as client:
        return max(sum(client.nthreads().values()), 1)


def check_cluster(address: str, parts: Callable[[], dict[str, str]]) -> None:
    """See that scheduler and workers run what this process runs.

    Parameters
    ----------
    address : str
    parts : callable
        Name and version of what must be equal, here and on each worker; it is called on both.

    Raises
    ------
    ConfigError
        One message for each that differs.
    """
    here = parts()
    with _client(address) as client:
        known: Any = client.get_versions(check=False)
        problems = [
            f"--scheduler: {address} runs {name} {theirs}, this process {ours}; allowed: the same version"
            for name in ("distributed", "python")
            if (theirs := _release(known["scheduler"], name)) != (ours := _release(known["client"], name))
        ]
        for worker, theirs in client.run(parts, on_error="return").items():
            if not isinstance(theirs, dict):
                problems.append(f"--scheduler: worker {worker} cannot run damperopt ({theirs}); allowed: one with this version")
                continue
            for name in sorted(set(here) | set(theirs)):
                if here.get(name) != theirs.get(name):
                    problems.append(
                        f"--scheduler: worker {worker} runs {name} {theirs.get(name)}, this process {here.get(name)}; "
                        "allowed: the same version"
                    )
    if problems:
        raise ConfigError(problems)


def _release(found: dict[str, Any], name: str) -> str:
    if name == "python":
        return ".".join(found["host"]["python"].split(".")[:2])
    return str(found["packages"][name])


@contextmanager
def _client(address: str) -> Iterator[Client]:
    try:
        from distributed import Client
    except ImportError:
        raise ConfigError("--scheduler: needs Dask, which is not installed; pip install 'damperopt[cluster]'") from None
    log = logging.getLogger("distributed.client")
    level = log.level
    log.setLevel(logging.CRITICAL + 1)  # what it says of a lost scheduler, with a traceback, is said once and by us
    try:
        client = Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise ConfigError(
            f"--scheduler: {address}: no scheduler answers ({error}); allowed: tcp://HOST:PORT of a running one"
        ) from None
    try:
        yield client
    finally:
        with suppress(TimeoutError, OSError):
            client.close(timeout=2)
        log.setLevel(level)


def _start_worker() -> None:
    """Ctrl-C is the parent's to handle; without a parent there is nothing to work for."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    if hasattr(os, "O_ASYNC"):  # the pipe from the parent kills when it is closed, whatever library is at work
        import fcntl

        signal.signal(signal.SIGIO, signal.SIG_DFL)
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, fcntl.fcntl(parent.sentinel, fcntl.F_GETFL) | os.O_ASYNC)
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: Any) -> None:
    parent.join()
    os._exit(1)
