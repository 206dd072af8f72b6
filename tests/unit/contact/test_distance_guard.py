"""What coal answers is checked before it is used, mended or refused."""

import coal
import numpy as np
import pytest

from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.shapes import (
    Cone,
)
from tests.tolerances import CURVED_PAIR, EXACT
from tests.unit.contact.still import found_for, placed, standing


def consistent(found, atol):
    """Every result says beta - alpha = phi n with |n| = 1."""
    gap = found.beta - found.alpha
    np.testing.assert_allclose(gap, found.phi[:, None] * found.n, rtol=EXACT, atol=atol)
    np.testing.assert_allclose(np.linalg.norm(found.n, axis=1), 1.0, rtol=EXACT, atol=atol)


PLANTED = {
    "normal turned round": lambda r: setattr(r, "normal", -np.array(r.normal)),
    "normal of another direction": lambda r: setattr(r, "normal", np.roll(np.array(r.normal), 1)),
    "always the same normal": lambda r: setattr(r, "normal", np.array([1.0, 0.0, 0.0])),
    "normal too long": lambda r: setattr(r, "normal", 1.1 * np.array(r.normal)),
    "no normal": lambda r: setattr(r, "normal", np.zeros(3)),
    "normal NaN": lambda r: setattr(r, "normal", np.full(3, np.nan)),
    "distance": lambda r: None,
}


REFUSED = ("normal of another direction", "no normal", "normal NaN")


@pytest.mark.parametrize("spoil", PLANTED)
@pytest.mark.parametrize("gap", [0.1, 0.0, -0.01])
def test_a_bad_answer_of_coal_is_mended_or_refused(monkeypatch, spoil, gap):
    honest = coal.distance

    def spoilt(*arguments):
        phi = honest(*arguments)
        PLANTED[spoil](arguments[-1])
        return phi + 1e-3 * (spoil == "distance")

    monkeypatch.setattr(coal, "distance", spoilt)
    cone = Cone(0.15, 0.2)  # boxes have a closed form, and so have cylinders that are apart
    kinematics = standing((np.eye(3), np.array([0.0, 0.0, 0.4 + gap])))
    try:
        found = found_for(placed(cone), placed(cone, 1), kinematics)
    except ContactError as error:
        assert str(error).startswith("p: no trustworthy contact normal")  # noqa: PT017 - either outcome is right
        assert spoil != "distance"
        return
    assert spoil not in REFUSED
    # The lower cone's tip is at z = 0.2, the upper one's base at 0.2 + gap.
    np.testing.assert_allclose(found.phi, [gap], rtol=EXACT, atol=CURVED_PAIR)
    np.testing.assert_allclose(found.n, [[0, 0, 1]], rtol=EXACT, atol=CURVED_PAIR)
