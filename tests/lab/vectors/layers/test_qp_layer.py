"""Layer `qp`: cones, what the plain program takes for an optimum, and tolerances by hand."""

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.vectors.layers import qp


def test_a_cone_that_is_no_contacts_is_refused():
    block = {"F": np.zeros((4, 1)).tolist(), "f": [0.0, 1.0, 0.0, 0.0]}
    with pytest.raises(InputError, match="only its first entry"):
        qp.expected({"H": [[1.0]], "g": [1.0], "second_order": [block]})
