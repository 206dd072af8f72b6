"""New cases: their expected answers are the package's, where the plain program agrees with it.

Neither is exact. They agree where they are the same to SHARE of the size of what is answered;
points, normals and multipliers are judged by what they do.
"""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.lab.program.layers import LAYERS, plain
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.compare import leaves, parts
from quasistatic_ref.lab.vectors.check.loosened import AGREED as SHARE
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.trees import Json

PROGRAM: dict[str, Callable[[Json], Json]] = LAYERS
CONIC = 2.0**-26
"""The same of an optimum in second-order cones: a duality gap of 2^-53, which float64 leaves, is an
error of 2^-26 in the H norm."""
FORCES = 1.25e-6
"""The same of forces, which are lengths over a compliance [-]; they count as 1 N at least."""
LEAST = 1e-3
"""A field whose numbers are smaller is as large as that [its unit]."""
POINTS = ("alpha", "beta")
LENGTHS = (*POINTS, "phi", "b")
"""As large as the largest coordinate of a point: a gap is a difference of such."""
FLAGS = {"agreed": True, "unique": False, "unique_multipliers": False, "tie": True}
REASON = "to that the package and the plain program agree"


def agreed_record(name: str, case: Json) -> Json | None:
    """What is expected of a case; None if the plain program answers something else.

    Parameters
    ----------
    name : str
        A layer that the plain program answers.
    case : dict

    Raises
    ------
    QuasistaticError
        If the package refuses the case.
    """
    output = layer(name).own(case)
    share = CONIC if "second_order" in case else SHARE
    sizes = _sizes(output)
    if name == "qp" and "delta_q" in output:
        sizes = {field: max(sizes[field], size) for field, size in _free_sizes(case).items()}
    absolute = {field: share * max(size, LEAST) for field, size in sizes.items()}
    if "forces" in sizes:
        absolute["forces"] = FORCES * max(sizes["forces"], 1.0)
    if "farkas" in sizes:
        absolute["farkas"] = 4 * SHARE
    record = {
        "flags": FLAGS | {"infeasible": "farkas" in output},
        "output": output,
        "digits": {},
        "tolerance": {k: {"absolute": v, "reason": REASON} for k, v in absolute.items()},
    }
    answer = plain(PROGRAM[name](case))
    return None if case_verdict(name, case, record, answer).verdict == FAILED else record


def _sizes(output: Json) -> dict[str, float]:
    """The largest number of each field [its unit]."""
    sizes = {}
    for field, value in parts(output).items():
        numbers = [abs(x) for _, x in leaves(value) if isinstance(x, float)]
        sizes[field] = max(numbers, default=0.0)
    last = {field: field.rpartition(".")[2] for field in sizes}
    longest = max((sizes[field] for field in sizes if last[field] in POINTS), default=0.0)
    return sizes | {field: longest for field in sizes if last[field] in LENGTHS}


def _free_sizes(case: Json) -> dict[str, float]:
    """The largest numbers that a change of an optimum by the unconstrained step's length makes.

    A change of length L in the H norm moves an entry of x by at most L sqrt((H^-1)_vv), one of H x
    by L sqrt(H_vv) and one of A x by L sqrt((A H^-1 A')_ii).
    """
    H = np.array(case["H"])
    g = np.array(case["g"])
    blocks = [row for block in case.get("second_order", []) for row in block["F"]]
    A = np.array(case.get("A", blocks)).reshape(-1, len(g))
    H_inverse = np.linalg.inv(H)
    squares = {
        "delta_q": np.diag(H_inverse),
        "A_lam": np.diag(H),
        "slack": np.sum((A @ H_inverse) * A, axis=1),
        "lam": np.zeros(0),
    }
    length = np.sqrt(g @ H_inverse @ g)
    return {name: float(length * np.sqrt(np.max(v, initial=0))) for name, v in squares.items()}
