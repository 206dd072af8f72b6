"""The package as a program that is challenged: cases in, answers out, line by line."""

import json
from typing import IO

from quasistatic_ref import __version__
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS, layer

KINDS = ("exact", "own")
"""The expected answers, or those of the package in float64, as anybody else's."""


def served(lines: IO[str], out: IO[str], kind: str = "exact") -> None:
    """Answer each line of `lines` with one on `out`, until there are no more.

    Parameters
    ----------
    lines, out : text files
    kind : str
        One of KINDS.
    """
    name = f"quasistatic_ref {__version__} ({kind})"
    _say(
        out,
        {"protocol": 1, "implementation": name, "layers": list(LAYERS)},
    )
    for line in lines:
        try:
            case = json.loads(line)
            head = {"id": case["id"]}
        except (ValueError, TypeError, KeyError) as error:
            _say(out, {"id": None, "error": f"is not a case: {error}"})
            continue
        try:
            _say(out, {**head, "output": _output(case["layer"], case["input"], kind)})
        except (QuasistaticError, ArithmeticError, LookupError, TypeError, ValueError) as error:
            _say(out, {**head, "error": f"{type(error).__name__}: {error}"})


def _output(name: str, case: Json, kind: str) -> Json:
    """What is answered to a case."""
    if name not in LAYERS:
        raise ValueError(f"{name!r} is not a layer")
    if kind == "own":
        return layer(name).own(case)
    output = layer(name).expected(case).output
    return {key: value for key, value in output.items() if key != "certificate"}


def _say(out: IO[str], record: Json) -> None:
    print(json.dumps(record), file=out, flush=True)
