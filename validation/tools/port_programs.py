"""Programs of the ports, with or without a mistake, and the committed cases that they are asked."""

import json
import os
import resource
import subprocess
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import takewhile
from pathlib import Path

from quasistatic_ref.lab.vectors.challenge.diagnosis import GIVEN_UP
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from validation.tools.ports import VECTORS

PROCESSOR = 10
"""After which a program is ended: it hangs [s]."""
MEMORY = 2**31
"""That it may ask for [B]."""
ENVIRONMENT = {**os.environ, "GOGC": "800", "GOMAXPROCS": "1"}


@dataclass(frozen=True)
class Question:
    """A case that is asked, and what is expected of it."""

    id: str
    layer: str
    case: Json
    record: Json


@dataclass(frozen=True)
class Program:
    """How a program is started."""

    path: Path
    environment: Mapping[str, str] = field(default_factory=lambda: ENVIRONMENT)


def _limit_process() -> None:
    """End a program that does not end."""
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR, PROCESSOR))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def started(program: Program) -> "subprocess.Popen[str]":
    """A program that reads cases and writes answers, a line each."""
    return subprocess.Popen(
        [program.path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        text=True, env=program.environment, preexec_fn=_limit_process,
    )  # fmt: skip


def replies(program: Program, questions: Sequence[Question]) -> dict[str, str]:
    """The line of each answer by id; an empty one where the program ended or hung.

    It is started again for the cases that follow, and a layer is asked no more after GIVEN_UP of
    those, as in a challenge.
    """
    found: dict[str, str] = {}
    troubles: Counter[str] = Counter()
    left = [*questions]
    while left:
        lines = _lines(program, left)
        found |= {q.id: line for q, line in zip(left, lines, strict=False)}
        if len(lines) < len(left):
            silent = left[len(lines)]
            found[silent.id] = ""
            troubles[silent.layer] += 1
        left = [q for q in left[len(lines) + 1 :] if troubles[q.layer] < GIVEN_UP]
    return found


def _lines(program: Program, questions: Sequence[Question]) -> list[str]:
    """The lines of the answers, in the order of the questions; fewer if the program ended early."""
    lines = (json.dumps({"id": q.id, "layer": q.layer, "input": q.case}) for q in questions)
    with started(program) as process:
        said, _ = process.communicate("".join(f"{line}\n" for line in lines))
    answers = said.splitlines()[1:]  # the first line says what the program is
    return list(takewhile(lambda line: line.endswith("}"), answers))


@cache
def committed_questions(layer: str) -> list[Question]:
    """The cases of a layer of the committed vectors."""
    records = expected_read(VECTORS, layer)
    inputs = inputs_read(VECTORS, layer)
    return [Question(one.id, layer, one.input, records[one.id]) for one in inputs]
