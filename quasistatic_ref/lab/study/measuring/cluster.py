"""The same study on an existing Dask cluster: blocks of measurements travel with their problems."""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from functools import partial
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.schedule import (
    BLOCK,
    Answered,
    Block,
    Left,
    Work,
    block_rows,
    measure_all,
)
from quasistatic_ref.lab.study.store.rows import Row

CONNECT = 30
"""Seconds in which a scheduler must answer."""


def measure_on_cluster(work: Work, address: str) -> None:
    """Run what is left of a plan on the workers of a Dask scheduler.

    Every worker needs this package and the solvers; rows come back here, to one store.

    Parameters
    ----------
    work : Work
    address : str
        Such as ``tcp://127.0.0.1:8786``.

    Raises
    ------
    InputError
        If Dask is not installed, or nothing answers at that address.
    """

    def answered(solver: Solver) -> Answered:
        return partial(_rows_elsewhere, work.folder, solver)

    with executor_of(address) as (executor, slots):
        measure_all(work, executor, slots, answered, BLOCK)


@contextmanager
def executor_of(address: str) -> Iterator[tuple[Executor, int]]:
    """An executor on the workers of a Dask scheduler, and how many calls they take at once.

    Raises
    ------
    InputError
        If Dask is not installed, nothing answers at that address, or there are no workers.
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


def _rows_elsewhere(
    folder: str, solver: Solver, block: Block, limits: Limits, left: Left
) -> list[Row]:
    """The rows of one block, on a worker of the cluster, in a process of its own."""
    settings = tuple(dict.fromkeys(m.setting for m, _ in block))
    with Keeper(solver, folder, limits.memory, settings) as keeper:
        return block_rows(keeper, block, limits, left)


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
            f"nothing answers there: {error}", field="--scheduler", value=address
        ) from None
