"""What is wrong most often where a layer is the first to fail.

Formulas of the plain program, ``lab/program``, by how many one-token changes of them spoil an
answer of this layer and none of an earlier one. Long formulas hold more tokens, so the order says
where to look first, not how often people err.
"""

from types import MappingProxyType
from typing import Final

USUAL: Final = MappingProxyType(
    {
        "distance": "the distance of a point to a solid, of two polyhedra, or of a curved shape",
        "selection": "which k points are the nearest, and in which order",
        "jacobian": "the pose of a joint, the velocity of a body, or the order of coordinates",
        "rows": "the table of the cone, or how its entries combine J along n, d1 and d2",
        "qp": "H or g of the quadratic program, the second-order cone, or the infeasible case",
        "wrench": "a contact's combination of multipliers, or the point its torque is about",
        "integrate": "q (+) delta_q: a twist along the body's own axes, one screw",
        "step": "crossings of edges, candidates of two solids, q_bar (-) q, loads or springs in g",
        "derivative": "the derivative of a layer that is right by itself",
    }
)
"""Where to look first, by layer."""


def usual_sentence(layer: str) -> str:
    """One sentence for the first layer with a wrong answer."""
    return f"{layer} is the first layer that is wrong; look first at: {USUAL[layer]}"
