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

import pytest

from quasistatic_ref.lab import program
from quasistatic_ref.lab.program.layers import LAYERS, TO_SIX_DIGITS, plain
from quasistatic_ref.lab.vectors.challenge.fresh import CHALLENGED
from quasistatic_ref.lab.vectors.challenge.run import challenge
from tests.lab.vectors.committed_cases import ROOT, by_size, verdict_on

PAGE = ROOT / "docs" / "guides" / "check_your_implementation.md"
ROW = re.compile(r"^\| (`.+?) \| (.+?) \| .+ \|$", re.MULTILINE)
NAME = re.compile(r"`(\w+)`")

FOLLOWER = (
    "mechanism.py",
    "J[:, columns] + joint_columns,",
    '(0 if "mimic" in body else J[:, columns]) + joint_columns,',
)
SLIDER = (
    "mechanism.py",
    "J[:, columns] + joint_columns,",
    '(0 if body["joint"] == "prismatic" else J[:, columns]) + joint_columns,',
)
FREE_JOINT = "joint_columns[:3, :3] = {0}\n            joint_columns[3:, 3:] = {0}\n"
LONG_WAY = "np.arctan2(s1, c1) - np.arctan2(s, c)"
KEPT = 'return shape | {"points": list(dict.fromkeys(map(tuple, shape["points"])))}'
AXIS = "np.where(d > 0, d, 1)[:, None]"
ROUNDED = "np.rint(phi / (RANKED * smaller_size))"

MISTAKES = {
    "normals reversed, unsigned phi": [
        ("distance", "n", "distance.py", '"n": n}', '"n": -n}'),
        ("distance", "phi", "distance.py", '{"phi": phi', '{"phi": np.abs(phi)'),
    ],
    "body and world frames swapped": [
        ("jacobian", "J", "mechanism.py", FREE_JOINT.format("R"), FREE_JOINT.format("AXES")),
    ],
    "un-actuated coordinates first": [
        (
            "jacobian", "J", "mechanism.py", "jacobians.append(J)",
            'jacobians.append(np.roll(J, -slices(case["mechanism"])[1], axis=1))',
        ),
    ],
    "a follower without its leader's motion": [
        ("jacobian", "J", *FOLLOWER),
        ("step", "contacts.J", *FOLLOWER),
        ("jacobian", "J", *SLIDER),
        ("step", "contacts.J", *SLIDER),
    ],
    "sign of the contact term": [
        ("rows", "A", "rows.py", "return np.column_stack(", "return -np.column_stack("),
    ],
    "mu_omega without a unit": [
        ("rows", "A", "rows.py", 'c["mu_omega"] * T', 'c["mu_omega"] * c["mu_v"] * T'),
    ],
    "lam taken for a force": [
        ("qp", "lam", "optimum.py", '"lam": lam, "A_lam"', '"lam": lam / 0.01, "A_lam"'),
        ("wrench", "wrench", "wrench.py", 'np.array(c["lam"]) / h', 'np.array(c["lam"])'),
    ],
    "a velocity in the place of delta_q": [
        ("qp", "delta_q", "optimum.py", '{"delta_q": x,', '{"delta_q": x / 0.01,'),
    ],
    "a straight line": [
        ("integrate", "q", "integration.py", "rotation(p) @ shift", "rotation(p) @ v"),
    ],
    "tangents by another rule": [
        (
            "step", "contacts.d1", "candidates.py", "i = int(np.argmin(np.abs(n)))",
            "i = int(np.argsort(np.abs(n))[1])",
        ),
    ],
    "gravity on actuated joints": [
        (
            "step", "g", "step.py", "tau = np.append(np.zeros(n_a), weight[n_a:])", "tau = weight",
        ),
    ],
    "n kept constant": [
        (
            "derivative", "dq_dq", "derivative.py", "contacts_there = contacts_of(case_nearby, at)",
            "contacts_there = [{**there, **{key: c[key] for key in ('n', 'd1', 'd2')}} "
            "for there, c in zip(contacts_of(case_nearby, at), contacts, strict=True)]",
        ),
    ],
    "no centre of mass": [
        (
            "step", "g", "step.py", 'R @ np.array(body.get("com", NONE)) + t\n',
            'R @ np.array(body["com"]) + t if "com" in body else NONE\n',
        ),
    ],
    "q_bar (-) q the long way": [
        ("step", "g", "integration.py", "return np.array([w])", f"return np.array([{LONG_WAY}])"),
        ("step", "g", "integration.py", "/ size, w])", f"/ size, {LONG_WAY}])"),
        ("step", "g", "integration.py", "p = -p if p[3] < 0 else p\n", "\n"),
    ],
    "the compliance of a run": [
        ("step", "forces", "forces.py", "COMPLIANCE = 1e-9", "COMPLIANCE = 1e-8"),
    ],
    "gaps ranked in another unit": [
        ("step", "contacts.index", "candidates.py", "return min((x for", "return max((x for"),
        ("step", "contacts.index", "candidates.py", ROUNDED, ROUNDED.replace("RANKED", "1e-10")),
    ],
    "gaps rounded another way": [
        ("step", "contacts.index", "candidates.py", ROUNDED, f"np.floor({ROUNDED[8:-1]} + 0.5)"),
        ("step", "contacts.index", "candidates.py", ROUNDED, f"np.ceil({ROUNDED[8:-1]} - 0.5)"),
    ],
    "another angle between normals": [
        (layer, field, "candidates.py", "FACING = 0.9689124217106447", "FACING = 0.9685")
        for layer, field in (("selection", "indices"), ("step", "contacts.index"))
    ],
    "normals of single corners": [
        ("step", "contacts.index", "candidates.py", "in ways(solid, n @ pose[0]):", "in []:"),
        ("step", "contacts.n", "candidates.py", "return [n, face] if", "return [face, n] if"),
    ],
    "a point between two faces": [
        ("step", "contacts.n", "candidates.py", "np.abs(way - n[i]).max() > SAME_NORMAL", "False"),
        ("step", "contacts.n", "candidates.py", "heights.min(axis=0)", "heights.mean(axis=0)"),
        ("step", "contacts.n", "candidates.py", "(phi <= TIED)", "(phi <= -TIED)"),
    ],
    "points of a cloud that are equal": [
        ("step", "contacts.alpha", "candidates.py", KEPT, "return shape"),
    ],
    "no way out of an axis": [
        (layer, field, "distance.py", f"{AXIS}, AXES[0])", f"{AXIS}, AXES[2])")
        for layer, field in (("distance", "n"), ("step", "contacts.n"))
    ],
    "other tolerances of ties": [
        ("step", "contacts.index", "candidates.py", f"\n{right}", f"\n{wrong}")
        for right, wrong in (
            ("OVER, SKEW = 1e-9", "OVER, SKEW = 1e-8"),
            ("REPEATED = 1e-9", "REPEATED = 1e-8"),
            ("OVER, SKEW = 1e-9, 1e-6", "OVER, SKEW = 1e-9, 1e-5"),
            ("SAME_NORMAL = 1e-6", "SAME_NORMAL = 1e-5"),
            ("SPANNED = 1e-6", "SPANNED = 1e-5"),
        )
    ],
}  # fmt: skip
"""Each as a layer, its field that is wrong, and a file with a formula and what is in its place."""
EVERY = [(name, *one[:2], one[2:]) for name, each in MISTAKES.items() for one in each]
FIRST_OF_EACH = [
    pytest.param(name, *one[:2], one[2:], marks=pytest.mark.long if i else ())
    for name, each in MISTAKES.items()
    for i, one in enumerate(each)
]
"""README's line takes the first of each mistake."""
SPECIAL = [
    (
        "selection", "indices", "candidates.py", 'order = np.argsort(phi, kind="stable")',
        "order = np.lexsort((-np.arange(len(phi)), phi))",
    ),
    ("step", "H", "step.py", "n_a] = h * K_q", "n_a] = h * np.diag(np.diag(K_q))"),
]  # fmt: skip
"""Others, which show where distances are equal, or K_q is not diagonal."""
IN_FILES_ALONE = {
    "the compliance of a run",
    "gaps ranked in another unit",
    "gaps rounded another way",
    "another angle between normals",
    "other tolerances of ties",
}
"""Six digits do not tell them apart, and no challenge asks them."""
TO_ALL_DIGITS = {*IN_FILES_ALONE, "normals of single corners"}
EARLIER = {
    "no centre of mass": "H",
    "normals of single corners": "contacts.index",
    "points of a cloud that are equal": "contacts.index",
}
"""The field that stands before its own: a challenge names that one where a case has both wrong."""


@functools.cache
def written_wrong(file, right, wrong):
    """The layers of a copy of the plain program in which one formula is another."""
    folder = Path(tempfile.mkdtemp())
    name = f"wrong_{folder.name}"
    shutil.copytree(Path(program.__file__).parent, folder / name)
    path = folder / name / file
    text = path.read_text("utf-8")
    assert text.count(right) == 1
    path.write_text(text.replace(right, wrong), "utf-8")
    sys.path.insert(0, str(folder))
    try:
        module = importlib.import_module(f"{name}.layers")
    finally:
        sys.path.remove(str(folder))
        shutil.rmtree(folder)
    return module.LAYERS | module.TO_SIX_DIGITS


def wrong_field(layers, layer, case, digits):
    """The first field of an answer to a committed case that is not right to so many digits."""
    return verdict_on(case.id, plain(layers[layer](case.input)), digits).field


def test_the_mistakes_are_those_of_the_page():
    _, _, section = PAGE.read_text("utf-8").partition("## Classic mistakes")
    table, _, _ = section.partition("\n## ")
    layers_of = {mistake: set(NAME.findall(layers)) for layers, mistake in ROW.findall(table)}
    assert layers_of == {name: {layer for layer, *_ in each} for name, each in MISTAKES.items()}


@pytest.mark.parametrize(("name", "layer", "field", "change"), FIRST_OF_EACH)
def test_a_committed_case_finds_each_mistake_and_passes_without_it(name, layer, field, change):
    digits = None if name in TO_ALL_DIGITS else 6
    wrong = written_wrong(*change)
    found = next(
        case for case in by_size(layer) if wrong_field(wrong, layer, case, digits) == field
    )
    assert not wrong_field(LAYERS | TO_SIX_DIGITS, layer, found, digits)


def one_for_each_field():
    """Those that a challenge asks; of a field of a layer the first one is not long."""
    seen = set()
    for name, layer, field, change in [*EVERY, *(("", *one[:2], one[2:]) for one in SPECIAL)]:
        if layer in CHALLENGED and name not in IN_FILES_ALONE:
            marks = pytest.mark.long if (layer, field) in seen else ()
            yield pytest.param(name, layer, field, change, marks=marks)
            seen.add((layer, field))


@pytest.mark.parametrize(("name", "layer", "field", "change"), list(one_for_each_field()))
def test_a_challenge_finds_each_mistake(name, layer, field, change):
    wrong = written_wrong(*change)
    found = challenge(lambda _, case: wrong[layer](case), layers=[layer], cases=500)
    assert found.findings[0].field in (field, EARLIER.get(name))
