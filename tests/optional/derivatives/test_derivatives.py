"""The derivatives of steps: of the reference vectors, and what else they promise.

The vectors' derivatives, and kinks, are those of differences of steps without rounding, and share
nothing with the package's formulas.
"""

import numpy as np
import pytest

from quasistatic_ref import Extension, InputError, derivatives
from quasistatic_ref.lab.vectors.layers import layer
from tests.lab.vectors.committed_cases import cases, report_on
from tests.optional.derivatives.free_bodies import vector_scene
from tests.tolerances import DIFFERENCE_OF_STEPS


def assert_meets(some):
    """The package's own answers to some cases pass."""
    own = {case.id: layer("derivative").own(case.input) for case in some}
    report = report_on("derivative", own)
    assert report.count("passed") == len(some), report.trouble


@pytest.mark.parametrize("part", range(8))
def test_the_package_meets_half_of_the_vectors(part):
    # Every pair of shapes, cone, joint and kind of kink, by every parameter.
    assert_meets([case for case in cases("derivative") if "/random/" not in case.id][part::16])


def test_r35_random_steps_change_as_steps_without_rounding_do(rng):
    random = [case for case in cases("derivative") if "/random/" in case.id]
    assert_meets([random[i] for i in rng.permutation(len(random))[:6]])


def test_an_uncertified_simulator_has_the_same_derivatives():
    exact, q, q_bar_a = vector_scene("floating/push")
    rough, _, _ = vector_scene("floating/push", certify="residual", backend="daqp")
    one = derivatives(exact, q, q_bar_a)
    two = derivatives(rough, q, q_bar_a)
    assert np.abs(one.dq_dq - two.dq_dq).max() <= DIFFERENCE_OF_STEPS


def test_the_ellipsoid_and_extensions_are_refused():
    simulator, q, q_bar_a = vector_scene("floating/push", cone="ellipsoid")
    with pytest.raises(InputError, match="polyhedron"):
        derivatives(simulator, q, q_bar_a)
    simulator, q, q_bar_a = vector_scene("floating/push", extension=lambda q: Extension((), 0.0))
    with pytest.raises(InputError, match="any function of q"):
        derivatives(simulator, q, q_bar_a)
