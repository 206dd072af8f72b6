"""The bounds in float64 are those of their formulas, term by term, with roundings made large.

Their own roundings are of 1e-16 and hidden by those of the tests. Here each operation is taken to
be off by a millionth or so, so that no term of a formula is too small to be seen.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csc_matrix

from quasistatic_ref.optional.large import float_bound
from quasistatic_ref.optional.large.float_bound import ENOUGH, FloatBound
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.optional.large.sizes import TermSizes
from quasistatic_ref.step.standard_form import StandardForm
from tests.helpers import random_stiffness
from tests.tolerances import ROUNDING

U = 2.0**-20


def loose(terms, sizes):
    """In place of the rounding of sums."""
    return U * (terms + 1) * np.asarray(sizes)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", [np.array, csc_matrix])
def test_bound_is_that_of_its_formula(monkeypatch, seed, kind):
    rng = np.random.default_rng(seed)
    H = random_stiffness(rng, 4, 2.0)
    g = rng.standard_normal(4)
    A = rng.random((5, 4))
    x = rng.standard_normal(4)
    y = rng.random(5)
    b = A @ x - [-0.3, *rng.standard_normal(4)]
    bound = FloatBound(kind(H))
    least = bound.least
    monkeypatch.setattr(float_bound, "rounding", loose)
    slack = A @ x - b
    off = loose(3, np.abs(A) @ np.abs(x) + np.abs(b))
    d = opening(csc_matrix(A), slack)
    opens = A @ d
    off_d = loose(3, np.abs(A) @ np.abs(d))
    short = slack - off < 0
    t = ENOUGH * ((off - slack) / (opens - off_d))[short].max()
    sums = np.abs(H).sum(axis=1)
    way = t * np.sqrt(d * d @ (sums + loose(4, sums)))
    work = y @ (slack + off) + t * y @ (opens + off_d)
    terms = np.abs(H) @ np.abs(x) + 2 * np.abs(g) + np.abs(A).T @ y
    rest = np.abs(H @ x - g - A.T @ y) + loose(7, terms)
    length = way + np.sqrt((np.sqrt((rest**2 / least).sum()) + way) ** 2 + 2 * work)
    z = np.linalg.solve(H, g)
    along = g @ z - loose(7, 2 * np.abs(g)) @ np.abs(z)
    free = along / np.sqrt(z @ H @ z + loose(4, np.abs(H) @ np.abs(z)) @ np.abs(z))
    assert short.any()
    assert work > 0
    form = StandardForm(kind(H), g, kind(A), b)
    sizes = TermSizes(kind(A), 2 * np.abs(g), row_terms=3, column_terms=7, usable=True)
    assert bound.error(form, sizes, x, y) == pytest.approx(length / free, rel=ROUNDING)
    assert bound.error(form, replace(sizes, usable=False), x, y) == np.inf
