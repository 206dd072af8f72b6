"""Many calls, some at once."""

import pytest

from quasistatic_ref.lab.parallel import results, workers


def test_one_job_is_done_in_this_process_and_its_error_is_raised():
    with workers(1) as executor:
        assert list(results(executor, divmod, [(7, 2), (9, 4)])) == [(3, 1), (2, 1)]
        with pytest.raises(ZeroDivisionError):
            list(results(executor, divmod, [(1, 0)]))
