"""Requests and answers over a pipe: a line of JSON each, or numbers in binary form."""

import json
from struct import Struct
from typing import IO

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.formats.files import json_text, unique_fields
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.oracle.served import Scenes

PROTOCOL = "quasistatic-ref/serve"
HEAD = Struct("<II")
"""Of a request in binary form: which scene, from 0, and whether forces are asked for (0 or 1).

Of an answer: its kind, and the bytes that follow."""
KINDS = ("exact", "enclosure", "residual", "none")
"""Kinds of certificates, by their number; behind them `ERROR`, of which a sentence follows."""
ERROR = len(KINDS)


def greeting(scenes: Scenes) -> str:
    """The first line that a client reads."""
    known = {name: one.record for name, one in scenes.by_name.items()}
    head = {"protocol": PROTOCOL, "version": 1, "implementation": f"quasistatic_ref {__version__}"}
    return json_text({**head, "scenes": known})


def line_answer(scenes: Scenes, line: str) -> str:
    """The line that answers a line: what was asked for, or why not, in a sentence."""
    head = {}
    try:
        request = _request(line)
        if "id" in request:
            head = {"id": request.take("id")}
        return json.dumps({**head, **scenes.answer(request)})
    except QuasistaticError as error:
        status = 2 if isinstance(error, InputError) else 3
        return json.dumps({**head, "error": str(error), "status": status})


def _request(line: str) -> TableReader:
    try:
        return TableReader(json.loads(line, object_pairs_hook=unique_fields))
    except (ValueError, RecursionError) as error:
        raise InputError(f"is not JSON: {error}", field="the line") from None


def lines_served(scenes: Scenes, lines: IO[str], out: IO[str]) -> None:
    """Answer each line of `lines` with one on `out`, until there are no more."""
    print(greeting(scenes), file=out, flush=True)
    while line := lines.readline():
        if line.strip():
            print(line_answer(scenes, line), file=out, flush=True)


def numbers_served(scenes: Scenes, given: IO[bytes], out: IO[bytes]) -> None:
    """Answer requests in binary form, until there are no more.

    A request is HEAD, then q, the target and the force, float64 numbers without gaps, all little
    endian; an answer is HEAD, then q+, and the forces where they are asked for.
    """
    out.write(f"{greeting(scenes)}\n".encode())
    out.flush()
    served = [*scenes.by_name.values()]
    while len(head := given.read(HEAD.size)) == HEAD.size:
        number, forces = HEAD.unpack(head)
        if number >= len(served):  # how long its numbers would be is not known: it ends
            text = f"scene: must be less than {len(served)} (got {number})".encode()
            out.write(HEAD.pack(ERROR, len(text)) + text)
            out.flush()
            return
        system = served[number].scenario.system
        sizes = np.cumsum([system.n_q, system.n_q_a, system.n_v])
        content = given.read(8 * int(sizes[-1]))
        if len(content) < 8 * sizes[-1]:
            return
        q, target, force = np.split(np.frombuffer(content, "<f8"), sizes[:2])
        try:
            result = served[number].simulator.step(q, target, force)
            kind = KINDS.index(result.solution.certificate.kind)
            parts = [result.q, result.forces.ravel()] if forces else [result.q]
            answer = np.concatenate(parts).astype("<f8").tobytes()
        except QuasistaticError as error:
            kind = ERROR
            answer = str(error).encode()
        out.write(HEAD.pack(kind, len(answer)) + answer)
        out.flush()
