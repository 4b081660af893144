"""Worker processes, here or on a cluster."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING

from .errors import ConfigError

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["cluster", "cluster_size", "cores", "executor", "process_pool"]


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


@contextmanager
def process_pool(workers: int) -> Iterator[Executor]:
    """Pool of worker processes; an interrupt ends them at once."""
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if "forkserver" in methods:
        context.set_forkserver_preload(["damperopt.design"])  # casadi is imported once, not once per worker
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_ignore_interrupt)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """Executor of a running Dask cluster, which runs the tasks of a worker that dies on another."""
    with _client(address) as client:
        yield client.get_executor(pure=False)


def cluster_size(address: str) -> int:
    """Threads of all its workers, at least 1."""
    with _client(address) as client:
        return max(sum(client.nthreads().values()), 1)


def _client(address: str) -> Client:
    try:
        from distributed import Client
    except ImportError:
        raise ConfigError("--scheduler: needs Dask, which is not installed; pip install 'damperopt[cluster]'") from None
    try:
        return Client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise ConfigError(
            f"--scheduler: {address}: no scheduler answers ({error}); allowed: tcp://HOST:PORT of a running one"
        ) from None


def _ignore_interrupt() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
