"""The page's classic mistakes: the plain program with each of them is found, by field.

The plain program itself passes: ``test_plain_program``.
"""

import functools
import importlib
import re
import shutil
import sys
import tempfile
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

from quasistatic_ref.lab.program import candidates, forces, integration
from quasistatic_ref.lab.program import derivative as derivatives
from quasistatic_ref.lab.program import step as steps
from quasistatic_ref.lab.program.layers import LAYERS, TO_SIX_DIGITS, plain
from quasistatic_ref.lab.program.mechanism import slices
from quasistatic_ref.lab.program.rotation import AXES, quaternion_product, unit
from quasistatic_ref.lab.vectors.challenge.fresh import CHALLENGED
from quasistatic_ref.lab.vectors.challenge.run import challenge
from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.converters import places, tangent_map
from tests.lab.vectors.committed_cases import ROOT, by_size, expected_of

PAGE = ROOT / "docs" / "guides" / "check_your_implementation.md"
ROW = re.compile(r"^\| (`.+?) \| (.+?) \| .+ \|$", re.MULTILINE)
NAME = re.compile(r"`(\w+)`")
H_STEP = 0.01
"""The time step of a port that divides by it where no case says one [s]."""
PROGRAM = LAYERS | TO_SIX_DIGITS
NEAREST = integration.difference


def answer(layer, case, **changes):
    return plain(PROGRAM[layer]({**case, **changes}))


def scaled(output, field, factor):
    """An answer whose numbers of one field, if it has it, are so many times as large."""
    if field not in output:
        return output
    return {**output, field: (factor * np.array(output[field])).tolist()}


def times(layer, field, factor):
    """The mistake of a field that is so many times as large."""
    return layer, field, lambda case: scaled(answer(layer, case), field, factor)


def unsigned_phi(case):
    output = answer("distance", case)
    return scaled(output, "phi", np.sign(output["phi"]))


def world_frame(case):
    turned = tangent_map(case["mechanism"], case["q"], "world")
    return {"J": [(np.array(J) @ turned).tolist() for J in answer("jacobian", case)["J"]]}


def unactuated_first(case):
    _, n_a, _ = slices(case["mechanism"])
    return {"J": [np.roll(J, -n_a, axis=1).tolist() for J in answer("jacobian", case)["J"]]}


def mu_omega_without_unit(case):
    contacts = [{**c, "mu_omega": c["mu_omega"] * c["mu_v"]} for c in case["contacts"]]
    return answer("rows", case, contacts=contacts)


def impulse_for_force(case):
    return answer("wrench", case, h=1.0)


def straight_line(case):
    turns = np.array(case["delta_q"])
    for body, _, v in places(case["mechanism"]):
        turns[v][: {"floating": 3, "planar": 2}.get(body["joint"], 0)] = 0.0
    moved = answer("integrate", case, delta_q=case["delta_q"] - turns)["q"]
    return answer("integrate", case, q=moved, delta_q=turns)


def other_tangents(n):
    i = int(np.argsort(np.abs(n))[1])
    d1 = unit(AXES[i] - n[i] * n)
    return d1, np.cross(n, d1)


def weight_on_all(case):
    loads = [*case.get("wrenches", [])]
    for body in case["mechanism"]["bodies"]:
        weight = body.get("mass", 0.0) * np.array(case["gravity"])
        loads.append({"body": body["name"], "force": weight.tolist(), "torque": [0.0] * 3})
    return answer("step", case, gravity=[0.0] * 3, wrenches=loads)


def with_patches(layer, module, **values):
    """The program of a layer with other values of some names of a module."""

    def program(case):
        with patch.multiple(module, **values):
            return answer(layer, case)

    return program


def targets_as_they_are(kinds):
    """Joints of these kinds: the difference of angles, or the quaternion of either sign."""

    def difference(body, target, q):
        nearest = NEAREST(body, target, q)
        if body["joint"] not in kinds:
            return nearest
        if body["joint"] == "floating":
            turn = quaternion_product(np.append(-q[3:6], q[6]), target[3:])
            if turn[3] < 0:  # exp6 of the long way is the same pose
                nearest[3:] *= 1 - 2 * np.pi / np.linalg.norm(nearest[3:])
            return nearest
        turn = np.arctan2(target[-1], target[-2]) - np.arctan2(q[-1], q[-2])
        return np.append(nearest[:-1], turn)

    return with_patches("step", integration, difference=difference)


def ranked(rounding, unit=candidates.RANKED, of=min):
    """Distances in multiples of `unit` of the size of a shape, rounded by a function."""

    def gaps(phi, size):
        return rounding(phi / (unit * size)) if size else phi

    def size(alpha, beta):
        extents = [candidates.extent(shape) for shape in (alpha, beta)]
        return of((x for x in extents if 0 < x < np.inf), default=0.0)

    return with_patches("step", steps, gaps=gaps, smaller=size)


def constant_n(case):
    first = []

    def contacts_of(case, at):
        contacts = steps.contacts_of(case, at)
        first[:] = first or [{key: c[key] for key in ("n", "d1", "d2")} for c in contacts]
        return [{**c, **frame} for c, frame in zip(contacts, first, strict=True)]

    with patch.object(derivatives, "contacts_of", contacts_of):
        return answer("derivative", case)


@functools.cache
def written_wrong(file, right, wrong):
    """The layers of a copy of the plain program in which one formula is another."""
    folder = Path(tempfile.mkdtemp())
    name = f"wrong_{folder.name}"
    shutil.copytree(Path(candidates.__file__).parent, folder / name)
    path = folder / name / file
    text = path.read_text("utf-8")
    assert text.count(right) == 1
    path.write_text(text.replace(right, wrong), "utf-8")
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module(f"{name}.layers").LAYERS
    finally:
        sys.path.remove(str(folder))
        shutil.rmtree(folder)


def rewritten(layer, *change):
    """The program of a layer in which one formula is another."""
    return lambda case: plain(written_wrong(*change)[layer](case))


FOLLOWS = (
    "mechanism.py",
    "J[:, columns] + joint_columns,",
    '(0 if "mimic" in body else J[:, columns]) + joint_columns,',
)
CENTRE = (
    "step.py",
    'R @ np.array(body.get("com", NONE)) + t\n',
    'R @ np.array(body["com"]) + t if "com" in body else NONE\n',
)
NO_CENTRE = rewritten("step", *CENTRE)
SINGLE = ("candidates.py", "in ways(solid, n @ pose[0]):", "in []:")
FACE_LAST = rewritten("step", "candidates.py", "return [n, face] if", "return [face, n] if")
BETWEEN = ("candidates.py", "np.abs(way - n[i]).max() > SAME_NORMAL", "False")


MISTAKES = {
    "normals reversed, unsigned phi": [
        times("distance", "n", -1),
        ("distance", "phi", unsigned_phi),
    ],
    "body and world frames swapped": [("jacobian", "J", world_frame)],
    "un-actuated coordinates first": [("jacobian", "J", unactuated_first)],
    "a follower without its leader's motion": [
        ("jacobian", "J", rewritten("jacobian", *FOLLOWS)),
        ("step", "contacts.J", rewritten("step", *FOLLOWS)),
    ],
    "sign of the contact term": [times("rows", "A", -1)],
    "mu_omega without a unit": [("rows", "A", mu_omega_without_unit)],
    "lam taken for a force": [
        times("qp", "lam", 1 / H_STEP),
        ("wrench", "wrench", impulse_for_force),
    ],
    "a velocity in the place of delta_q": [times("qp", "delta_q", 1 / H_STEP)],
    "a straight line": [("integrate", "q", straight_line)],
    "tangents by another rule": [
        ("step", "contacts.d1", with_patches("step", steps, tangents=other_tangents))
    ],
    "gravity on actuated joints": [("step", "g", weight_on_all)],
    "n kept constant": [("derivative", "dq_dq", constant_n)],
    "no centre of mass": [("step", "g", NO_CENTRE)],
    "q_bar (-) q the long way": [
        ("step", "g", targets_as_they_are({kind})) for kind in ("continuous", "planar", "floating")
    ],
    "the compliance of a run": [("step", "forces", with_patches("step", forces, COMPLIANCE=1e-8))],
    "gaps ranked in another unit": [
        ("step", "contacts.index", ranked(np.rint, of=max)),
        ("step", "contacts.index", ranked(np.rint, unit=1e-10)),
    ],
    "gaps rounded another way": [
        ("step", "contacts.index", ranked(lambda x: np.floor(x + 0.5))),
        ("step", "contacts.index", ranked(lambda x: np.ceil(x - 0.5))),
    ],
    "another angle between normals": [
        (layer, field, with_patches(layer, candidates, FACING=0.9685))
        for layer, field in (("selection", "indices"), ("step", "contacts.index"))
    ],
    "normals of single corners": [
        ("step", "contacts.index", rewritten("step", *SINGLE)),
        ("step", "contacts.n", FACE_LAST),
    ],
    "a point between two faces": [("step", "contacts.n", rewritten("step", *BETWEEN))],
    "other tolerances of ties": [
        ("step", "contacts.index", with_patches("step", candidates, **{name: value}))
        for name, value in (
            ("OVER", 1e-8),
            ("REPEATED", 1e-8),
            ("SKEW", 1e-5),
            ("SAME_NORMAL", 1e-5),
            ("SPANNED", 1e-5),
        )
    ],
}
"""Each as its layer, the field that is wrong, and the plain program with it."""
PROGRAMS = [one for each in MISTAKES.values() for one in each]


IN_FILES_ALONE = {
    "the compliance of a run",
    "gaps ranked in another unit",
    "gaps rounded another way",
    "another angle between normals",
    "other tolerances of ties",
}
"""Six digits do not tell them apart, and no challenge asks them."""
TO_ALL_DIGITS = {*IN_FILES_ALONE, "normals of single corners"}
EVIDENT = [one for name, each in MISTAKES.items() for one in each if name not in TO_ALL_DIGITS]
ASKED = [one for name, each in MISTAKES.items() for one in each if name not in IN_FILES_ALONE]


def wrong_field(layer, case, output, digits=6):
    """The first field of an answer to a committed case that is not right to so many digits."""
    record = expected_of(layer)[case.id]
    return verdict_to_digits(layer, case.input, record, output, digits).field


def test_they_are_those_of_the_page():
    _, _, section = PAGE.read_text("utf-8").partition("## Classic mistakes")
    table, _, _ = section.partition("\n## ")
    layers_of = {mistake: set(NAME.findall(layers)) for layers, mistake in ROW.findall(table)}
    assert layers_of == {name: {layer for layer, *_ in each} for name, each in MISTAKES.items()}


@pytest.mark.parametrize(("layer", "field", "program"), PROGRAMS)
def test_a_committed_case_finds_it_and_passes_without_it(layer, field, program):
    digits = 6 if (layer, field, program) in EVIDENT else None
    found = next(
        case
        for case in by_size(layer)
        if wrong_field(layer, case, program(case.input), digits) == field
    )
    assert not wrong_field(layer, found, answer(layer, found.input), digits)


EARLIER = {NO_CENTRE: "H", FACE_LAST: "contacts.index"}
"""The field that stands before its own: a challenge names that one where a case has both wrong."""


def one_for_each_field():
    """Those that a challenge asks; of a field of a layer the first one is not long."""
    seen = set()
    for layer, field, program in ASKED:
        if layer in CHALLENGED:
            marks = pytest.mark.long if (layer, field) in seen else ()
            yield pytest.param(layer, field, program, marks=marks)
            seen.add((layer, field))


@pytest.mark.parametrize(("layer", "field", "program"), list(one_for_each_field()))
def test_a_challenge_finds_it(layer, field, program):
    found = challenge(lambda _, case: program(case), layers=[layer], cases=500)
    named = {finding.field for finding in found.findings}
    assert named & {field, EARLIER.get(program)}
