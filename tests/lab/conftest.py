"""What tests of sweeps and of studies share."""

import pytest


@pytest.fixture
def two_of_dask(tmp_path):
    """An executor of two workers of dask, which are processes."""
    import dask
    import distributed

    with (
        dask.config.set(temporary_directory=str(tmp_path)),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=":0"
        ) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor(pure=False, retries=0) as executor,
    ):
        yield executor
