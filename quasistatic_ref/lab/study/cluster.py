"""The same study on an existing Dask cluster: blocks of measurements travel with their problems."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.conduct import BLOCK, Answered, Block, block_rows, conduct
from quasistatic_ref.lab.study.keeper import Keeper
from quasistatic_ref.lab.study.plan import Measurement
from quasistatic_ref.lab.study.qp import Problem
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.lab.study.store import Row, Store

CONNECT = 30
"""Seconds in which a scheduler must answer."""


def conduct_on_cluster(
    store: Store,
    todo: Sequence[Measurement],
    problems: Mapping[str, Problem],
    address: str,
    folder: str,
    *,
    limit: float,
    budget: float,
    progress: bool = True,
) -> None:
    """Run what is left of a plan on the workers of a Dask scheduler.

    Every worker needs this package and the solvers; rows come back here, to one store.

    Parameters
    ----------
    store, todo, problems, limit, budget, progress
        As in :func:`~quasistatic_ref.lab.study.conduct.conduct`; limit and budget in [s].
    address : str
        Such as ``tcp://127.0.0.1:8786``.
    folder : str
        Where callables and executables are looked for, on the workers.

    Raises
    ------
    InputError
        If Dask is not installed, or nobody answers at that address.
    """

    def answered(solver: Solver) -> Answered:
        return _Elsewhere(solver, folder)

    with executor_of(address) as (executor, slots):
        conduct(store, todo, problems, executor, slots, answered, limit=limit, budget=budget,
                block=BLOCK, progress=progress)  # fmt: skip


@contextmanager
def executor_of(address: str) -> Iterator[tuple[Executor, int]]:
    """An executor on the workers of a Dask scheduler, and how many calls they take at once.

    Raises
    ------
    InputError
        If Dask is not installed, nobody answers at that address, or there are no workers.
    """
    client = _client(address)
    try:
        slots = sum(client.nthreads().values())
        if not slots:
            raise InputError("has no workers", field="--scheduler", value=address)
        with client.get_executor(pure=False, retries=0) as executor:
            yield executor, slots
    finally:
        client.close()


class _Elsewhere:
    """One block on a worker of the cluster, in a process of its own; it can be pickled."""

    def __init__(self, solver: Solver, folder: str) -> None:
        self.solver, self.folder = solver, folder

    def __call__(self, block: Block, limit: float, left: float) -> list[Row]:
        with Keeper(self.solver, self.folder) as keeper:
            return block_rows(keeper, block, limit, left)


def _client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "needs Dask, which is not installed; pip install 'quasistatic-ref[study]'",
            field="--scheduler",
            value=address,
        ) from None
    try:
        return Client(address, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"nobody answers there: {error}", field="--scheduler", value=address
        ) from None
