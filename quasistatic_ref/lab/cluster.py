"""An existing Dask cluster, where one machine is not enough."""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any

from quasistatic_ref.errors import InputError

CONNECT = 30
"""Seconds in which a scheduler must answer."""


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
