"""Files of answers in the ellipsoid with one fault, and the line of `verify` that has to find it.

The checker for sceptics refuses the ellipsoid. Forged files mostly have several faults: a number
that is moved is no longer what the others give. Here the others go with it, or it comes first.
"""

import json
import math

import numpy as np

from quasistatic_ref import Extra
from quasistatic_ref.certify.solution_files import infeasible_text
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import point_step
from quasistatic_ref.step.files import step_sha256, step_text
from tests.oracles.forged_scenes import scenes
from tests.oracles.forgeries import good_file, with_its_wrenches
from tests.oracles.records import with_value

PROVED = "every field is proved"
H, DOWN = 0.5, 2.0
"""Time step [s] and push on the floor [N]: all numbers here are dyadic."""


def ellipsoid_faults():
    """Texts of a step and of a solution, and the beginning of the reason for the verdict."""
    yield from of_exact_answers()
    yield from beyond_a_limit()


def fault(step, record, reason):
    """A fault of a solution file."""
    return step_text(step), json.dumps(record), reason


def on_floor(across, mu_v=0.5, copies=(0.0,)):
    """A point mass in the ellipsoid, pushed down and across, over planes at some distances."""
    step = point_step(H, (across, 0.0, -DOWN), mu_v, 0.0, H)
    n = len(copies)
    planes = contacts_of(
        copies, np.tile(np.eye(3), (n, 1, 1)), np.tile(np.eye(4, 3), (n, 1, 1)), mu_v
    )
    return step.replace(cone="ellipsoid", contacts=planes)


def stuck_file(step, lam, active, gap):
    """The file of a body that stays where it is."""
    certificate = {"kind": "exact", "active": active, "error_bound": 0.0, "gap": gap}
    record = good_file(on_floor(0.0), "exact") | {
        "step_sha256": step_sha256(step),
        "delta_q": [0.0] * 3,
    }
    return with_its_wrenches(step, record | {"lam": lam, "certificate": certificate})


def of_exact_answers():
    """Exact answers whose multipliers, slacks or products alone are wrong, by less than the gap."""
    rows = [[0, 0], [0, 1], [0, 2]]
    push = H * DOWN
    edge, over = 0.5 * DOWN, 0.5 * DOWN * (1 + 2.0**-40)  # of the friction that the floor can give
    at_the_edge = stuck_file(on_floor(edge), [[push, -H * edge, 0.0, 0.0]], rows, 0.0)
    yield fault(on_floor(edge), at_the_edge, PROVED)
    beyond = with_value(at_the_edge, ("lam", 0, 1), math.nextafter(-H * edge, -1.0))
    step = on_floor(edge)
    yield fault(step, with_its_wrenches(step, beyond), "lam is not in the dual cones")
    slides, gap = on_floor(over), 1e-20  # more than what is left of the push costs
    record = stuck_file(slides, [[push, -H * edge, 0.0, 0.0]], rows, gap)
    yield fault(slides, record, "lam with its entries on active changed is not in the dual cones")
    smooth = on_floor(0.0, mu_v=0.0)
    record = stuck_file(smooth, [[push, 2.0**-40, 0.0, 0.0]], [[0, 0]], gap)
    yield fault(smooth, record, "lam has a force whose coefficient is 0")
    two = on_floor(0.0, copies=(0.0, 2.0**-50))
    half = [push / 2, 0.0, 0.0, 0.0]
    yield fault(
        two, stuck_file(two, [half, half], rows, gap), "the multipliers are not complementary"
    )
    violated = "the minimiser on the rows of active violates a row"
    near = on_floor(0.0, copies=(0.0, -1e-3))
    none = [0.0] * 4
    yield fault(near, stuck_file(near, [[push, 0.0, 0.0, 0.0], none], rows, 0.0), violated)
    own = on_floor(0.0).replace(extra=Extra(("lifted",), np.eye(3)[2:], [1e-3]))
    record = stuck_file(own, [[push, 0.0, 0.0, 0.0]], rows, 0.0) | {"lam_extra": [0.0]}
    yield fault(own, record, violated)
    record = stuck_file(own, [[push, 0.0, 0.0, 0.0]], rows, 0.0) | {"lam_extra": [-1e-12]}
    yield fault(own, record, "lam has a negative multiplier of the user's own rows")


def beyond_a_limit():
    """Bounds, gaps and signs that no other field depends on."""
    of = {kind: step for (kind, _), step in scenes().items()}
    slides = of["enclosure"]
    good = good_file(slides, "enclosure")
    for name, value, reason in (
        ("error_bound", 5e-13, "error_bound is not between 0 and 1e-13"),
        ("error_bound", -1e-20, "error_bound is not between 0 and 1e-13"),
        ("gap", -1e-20, "gap is above its limit"),
        ("gap", 1.0, "gap is above its limit"),
    ):
        yield fault(slides, with_value(good, ("certificate", name), value), reason)
    record = with_value(good, ("lam", 0, 1), 2 * good["lam"][0][0])
    yield fault(slides, with_its_wrenches(slides, record), "lam is not in the dual cones")
    sticks = of["exact in the ellipsoid"]
    record = with_value(good_file(sticks, "exact in the ellipsoid"), ("certificate", "gap"), 1.0)
    yield fault(sticks, record, "gap is below the gap, or above its limit")
    step = of["infeasible"].replace(cone="ellipsoid")
    proof = infeasible_text(step, ["1"] * 8)
    yield step_text(step), proof, "a proof of infeasibility is not written in the ellipsoid"
