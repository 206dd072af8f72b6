"""The same study on an existing Dask cluster: blocks of measurements travel with their problems."""

from functools import partial

from quasistatic_ref.lab.cluster import executor_of
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


def _rows_elsewhere(
    folder: str, solver: Solver, block: Block, limits: Limits, left: Left
) -> list[Row]:
    """The rows of one block, on a worker of the cluster, in a process of its own."""
    settings = tuple(dict.fromkeys(m.setting for m, _ in block))
    with Keeper(solver, folder, limits.memory, settings) as keeper:
        return block_rows(keeper, block, limits, left)
