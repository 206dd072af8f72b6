"""The committed vectors, what the checker says of an answer, and the plain program's answers."""

import functools
import json

import numpy as np

from quasistatic_ref.lab.program.layers import LAYERS as PROGRAM
from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.vectors import layers
from quasistatic_ref.lab.vectors.challenge.fresh import record_of
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.files import Case, expected_read, inputs_read
from quasistatic_ref.lab.vectors.trees import mapped
from tests.made import text_written
from tests.pages import ROOT

__all__ = ["record_of"]

VECTORS = ROOT / "validation" / "vectors"
LAYERS = layers.LAYERS
NUMPY = LAYERS[:8]
"""Layers that the plain program answers."""


@functools.cache
def cases(layer):
    """The inputs of a layer; not to be changed."""
    return tuple(inputs_read(VECTORS, layer))


@functools.cache
def expected_of(layer):
    """What is expected of a layer, by id; not to be changed."""
    return expected_read(VECTORS, layer)


def right_answers(layer):
    """The expected outputs of a layer as answers, by id."""
    return {
        name: {field: v for field, v in record["output"].items() if field != "certificate"}
        for name, record in expected_of(layer).items()
    }


@functools.cache
def by_size(layer):
    """The inputs of a layer, the shortest first."""
    return tuple(sorted(cases(layer), key=lambda case: len(str(case.input))))


@functools.cache
def small_cases(layer):
    """Every third case of a layer, and of the steps the 24 with the least input."""
    if layer in ("step", "derivative"):
        return by_size(layer)[:24]
    return cases(layer)[:: 1 if len(cases(layer)) < 60 else 3]


def inputs_of(name):
    """The input of a case, by its id; not to be changed."""
    return next(case.input for case in cases(name.partition("/")[0]) if case.id == name)


def plain_answer(layer, inputs):
    """The answer of the plain program."""
    return plain(PROGRAM[layer](inputs))


def own_answer(layer, inputs):
    """The package's own answer."""
    return layers.layer(layer).own(inputs)


def verdict_on(name, output, digits=None):
    """The verdict on an output of a committed case."""
    layer = name.partition("/")[0]
    return verdict_of(layer, inputs_of(name), expected_of(layer)[name], output, digits)


def verdict_of(layer, inputs, record, output, digits=None):
    """The verdict on an output of any case, of which a record is expected."""
    case, answers = Case("one", "", inputs), Answers({"one": output}, "test")
    (verdict,) = layer_report(layer, [case], {"one": record}, answers, digits).verdicts
    return verdict


def report_on(layer, outputs, **declared):
    """The report on answers that are given by id, of these cases alone."""
    given = [case for case in cases(layer) if case.id in outputs]
    known = {case.id: expected_of(layer)[case.id] for case in given}
    return layer_report(layer, given, known, Answers(outputs, "test", **declared))


def inputs_file(folder, layer, chosen):
    """Write a file of inputs, with shapes where they are."""
    head = {"format": "quasistatic-ref/vectors-inputs", "version": 1, "layer": layer}
    text = json.dumps(head | {"cases": [vars(case) for case in chosen]})
    text_written(folder / "inputs" / f"{layer}.json", text)


def few_written(folder, count, names=LAYERS):
    """Write the shortest inputs of each layer, and what is expected of some layers."""
    for layer in LAYERS:
        # The first quadratic programs have a solution.
        every = cases("qp") if layer == "qp" else by_size(layer)
        inputs_file(folder, layer, every[:count])
    for name in names:
        path = f"expected/{name}.json"
        text_written(folder / path, (VECTORS / path).read_text("utf-8"))


def answer_file(folder, layer, outputs, **head):
    """Write a file of answers, by id; `head` replaces fields of its head."""
    top = {
        "format": "quasistatic-ref/vectors-answers",
        "version": 1,
        "layer": layer,
        "implementation": "test 0.1",
        "answers": [{"id": name, "output": output} for name, output in outputs.items()],
        **head,
    }
    path = folder / f"{layer}.json"
    path.write_text(json.dumps(top))
    return path


def in_float32(output):
    """Every float of an answer rounded to 24 bits."""
    return mapped(output, lambda x: float(np.float32(x)) if isinstance(x, float) else x)


LIGHT = ("selection", "rows", "wrench")
"""Layers that are checked in no time."""


def by_layer(report):
    """What a report says of each layer."""
    return {layer.layer: layer for layer in report.layers}
