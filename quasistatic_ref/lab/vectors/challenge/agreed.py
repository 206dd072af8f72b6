"""New cases of the layers `distance` and `step`: what package and plain program agree on.

Neither is exact. Their answers are expected where they are the same to SHARE of the size of what is
answered; points, normals and multipliers are judged by what they do.
"""

from collections.abc import Callable

from quasistatic_ref.lab.program.layers import LAYERS, plain
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.compare import leaves, parts
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import layer

PROGRAM: dict[str, Callable[[Json], Json]] = LAYERS
SHARE = 2.5e-10
"""Tolerance over the largest number of a field [-]; a challenge allows four times as much, 1e-9."""
FORCES = 1.25e-6
"""The same of forces, which are lengths over a compliance [-]; they count as 1 N at least."""
LEAST = 1e-3
"""A field whose numbers are smaller is as large as that [its unit]."""
POINTS = ("alpha", "beta")
LENGTHS = (*POINTS, "phi", "b")
"""As large as the largest coordinate of a point: a gap is a difference of such."""
FLAGS = {"unique": False, "unique_multipliers": False}


def agreed_record(name: str, case: Json) -> Json | None:
    """What is expected of a case; None if the plain program answers something else.

    Parameters
    ----------
    name : str
        ``"distance"`` or ``"step"``.
    case : dict

    Raises
    ------
    QuasistaticError
        If the package refuses the case.
    """
    output = layer(name).own(case)
    record = {"output": output, "flags": FLAGS, "tolerance": _tolerances(output)}
    answer = plain(PROGRAM[name](case))
    return None if case_verdict(name, case, record, answer).verdict == FAILED else record


def _tolerances(output: Json) -> Json:
    """How far each field may be off."""
    sizes = {}
    for field, value in parts(output).items():
        numbers = [abs(x) for _, x in leaves(value) if isinstance(x, float)]
        sizes[field] = max(numbers, default=0.0)
    last = {field: field.rpartition(".")[2] for field in sizes}
    longest = max((sizes[field] for field in sizes if last[field] in POINTS), default=0.0)
    sizes |= {field: longest for field in sizes if last[field] in LENGTHS}
    tolerances = {name: {"absolute": SHARE * max(size, LEAST)} for name, size in sizes.items()}
    if "forces" in sizes:
        tolerances["forces"] = {"absolute": FORCES * max(sizes["forces"], 1.0)}
    return tolerances
