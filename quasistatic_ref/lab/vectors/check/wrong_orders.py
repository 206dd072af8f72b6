"""What mistakes about the order of numbers answer: parts exchanged, transposes, other counts."""

from collections.abc import Iterable

import numpy as np

from quasistatic_ref.lab.vectors.check.predictions import again
from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.lab.vectors.expected import Json


def _exchanged(mechanism: Json) -> list[int]:
    """Entries of delta_q with (w, v) of each floating base in the place of (v, w)."""
    order = list(range(sum(at.v.stop - at.v.start for at in places(mechanism))))
    for at in places(mechanism):
        if at.kind == "floating":
            order[at.v] = order[at.v][3:] + order[at.v][:3]
    return order


def angular_first(case: Json, output: Json) -> Iterable[Json]:
    """Columns of J."""
    order = _exchanged(case["mechanism"])
    return [{"J": [[[row[k] for k in order] for row in J] for J in output["J"]]}]


def angular_delta_q(case: Json, output: Json) -> Iterable[Json]:
    """delta_q read as (w, v)."""
    delta_q = [case["delta_q"][k] for k in _exchanged(case["mechanism"])]
    return [again("integrate", {**case, "delta_q": delta_q})]


def angular_step(case: Json, output: Json) -> Iterable[Json]:
    """The parts of a step that have to do with delta_q."""
    order = _exchanged(case["mechanism"])
    contacts = [{"J": [[row[k] for k in order] for row in c["J"]]} for c in output["contacts"]]
    parts = {"contacts": contacts, "H": [[output["H"][i][j] for j in order] for i in order]}
    parts["A"] = [[row[k] for k in order] for row in output["A"]]
    return [parts | {name: [output[name][k] for k in order] for name in ("g", "delta_q", "A_lam")}]


def torque_first(case: Json, output: Json) -> Iterable[Json]:
    """(torque, force) of each body."""
    return [{"net": {body: w[3:] + w[:3] for body, w in output["net"].items()}}]


def normal_first(case: Json, output: Json) -> Iterable[Json]:
    """(f_n, f_d1, f_d2, tau_n) of each contact."""
    return [{"wrench": [[w[2], w[0], w[1], w[3]] for w in output["wrench"]]}]


def one_based(case: Json, output: Json) -> Iterable[Json]:
    """Indices from 1."""
    return [{"indices": [[i + 1 for i in group] for group in output["indices"]]}]


def one_based_contacts(case: Json, output: Json) -> Iterable[Json]:
    """Candidates counted from 1."""
    return [{"contacts": [{"index": c["index"] + 1} for c in output["contacts"]]}]


def by_phi(case: Json, output: Json) -> Iterable[Json]:
    """Contacts of each pair by their phi."""
    names = [pair["name"] for pair in case["pairs"]]
    ranked = sorted(output["contacts"], key=lambda c: (names.index(c["pair"]), c["phi"]))
    return [{"contacts": ranked}]


def transposed_A(case: Json, output: Json) -> Iterable[Json]:
    """A' in the place of A, or its numbers in the order of A'."""
    A = np.array(output["A"])
    return [{"A": A.T.tolist()}, {"A": A.T.reshape(A.shape).tolist()}]
