"""Requests and answers over a pipe: a line of JSON each."""

import json
from typing import IO, Any

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.formats.files import json_text, unique_fields
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.oracle.served import Scenes

PROTOCOL = "quasistatic-ref/serve"


def greeting(scenes: Scenes) -> str:
    """The first line that a client reads."""
    known = {name: one.record for name, one in scenes.by_name.items()}
    head = {"protocol": PROTOCOL, "version": 1, "implementation": f"quasistatic_ref {__version__}"}
    return json_text({**head, "scenes": known})


def line_answer(scenes: Scenes, line: bytes) -> str:
    """The line that answers a line: what was asked for, or why not, in a sentence."""
    head = {}
    try:
        request = _request(line)
        if "id" in request:
            head = {"id": _echoed(request)}
        return json.dumps({**head, **scenes.answer(request)})
    except QuasistaticError as error:
        status = 2 if isinstance(error, InputError) else 3
        return json.dumps({**head, "error": str(error), "status": status})


def _request(line: bytes) -> TableReader:
    try:
        text = line.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError("is not UTF-8 text", field="the line") from None
    try:
        return TableReader(json.loads(text, object_pairs_hook=unique_fields))
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError(f"is not JSON: {error}", field="the line") from None


def _echoed(request: TableReader) -> Any:
    """The id of a request, any JSON."""
    echo = request.take("id")
    try:
        json.dumps(echo, allow_nan=False)
    except ValueError:
        raise InputError("must be JSON, which has no such number", field="id", value=echo) from None
    return echo


def lines_served(scenes: Scenes, lines: IO[bytes], out: IO[str]) -> None:
    """Answer each line of `lines` with one on `out`, until there are no more."""
    print(greeting(scenes), file=out, flush=True)
    while line := lines.readline():
        if line.strip():
            print(line_answer(scenes, line), file=out, flush=True)
