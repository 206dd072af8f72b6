"""Bugs planted in a simulator that works: the checker names the layer and the mistake."""

import sys
import types

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.check.hypotheses import HYPOTHESES
from tests.lab.vectors.material import (
    RUNNERS,
    cases,
    planted_bugs,
    report_on,
    right_answers,
    runner,
    small_cases,
)
from tests.lab.vectors.runner_faults import (
    each_contact,
    inputs_changed,
    interleaved,
    jacobians_read_by_columns,
    mu_omega_times_mu_v,
    multiplied,
    negative,
    normals_reversed,
    outputs_changed,
    patched,
    straight_moves,
    torsion_forgotten,
    unsigned_contacts,
    world_moves,
    world_twists,
    wrong_order,
)

FAULTS = {
    # fault: (layer, how the runner is made wrong, mistake that is to be named)
    "distance: n from beta to alpha": ("distance", negative("n"), "normals reversed"),
    "distance: |phi|": (
        "distance",
        outputs_changed(lambda o: {**o, "phi": np.abs(o["phi"]).tolist()}),
        "unsigned phi",
    ),
    "distance: points of the other body": (
        "distance",
        outputs_changed(lambda o: {**o, "alpha": o["beta"], "beta": o["alpha"]}),
        "alpha and beta swapped",
    ),
    "distance: wxyz read": (
        "distance",
        patched("numpy_runner", "rotation", wrong_order),
        "quaternions read as wxyz",
    ),
    "selection: nearest by |phi|": (
        "selection",
        inputs_changed(lambda c: {**c, "phi": [np.abs(phi).tolist() for phi in c["phi"]]}),
        "unsigned phi",
    ),
    "jacobian: twists in the world": (
        "jacobian",
        patched("numpy_runner", "kinematics", world_twists),
        "world and body frames swapped",
    ),
    "jacobian: columns first": (
        "jacobian",
        outputs_changed(lambda o: {"J": [np.transpose(J).tolist() for J in o["J"]]}),
        "J transposed",
    ),
    "jacobian: alpha relative to beta": ("jacobian", negative("J"), "alpha and beta swapped"),
    "jacobian: spin about -n": (
        "jacobian",
        inputs_changed(normals_reversed),
        "spin sign",
    ),
    "jacobian: no spin": (
        "jacobian",
        outputs_changed(lambda o: {"J": [J[:3] for J in o["J"]]}),
        "torsion rows missing",
    ),
    "jacobian: wxyz read": (
        "jacobian",
        patched("runner_mechanism", "rotation", wrong_order),
        "quaternions read as wxyz",
    ),
    "rows: mu_omega without a length": (
        "rows",
        inputs_changed(lambda c: each_contact(c, mu_omega=lambda k: 1.0)),
        "mu_omega taken as dimensionless",
    ),
    "rows: mu_omega mu_v": (
        "rows",
        inputs_changed(mu_omega_times_mu_v),
        "mu_omega multiplied by mu_v",
    ),
    "rows: n reversed": (
        "rows",
        inputs_changed(normals_reversed),
        "normals reversed",
    ),
    "rows: |phi|": (
        "rows",
        inputs_changed(lambda c: each_contact(c, phi=lambda k: abs(k["phi"]))),
        "unsigned phi",
    ),
    "rows: b = phi": ("rows", negative("b"), "sign of b"),
    "rows: A and the contact term negative": ("rows", negative("A"), "sign of the contact term"),
    "rows: four of them": (
        "rows",
        inputs_changed(lambda c: each_contact(c, rows=lambda k: 4)),
        "torsion rows missing",
    ),
    "rows: MuJoCo's order": (
        "rows",
        patched("numpy_runner", "cone_table", interleaved),
        "rows interleaved",
    ),
    "rows: J read by columns": (
        "rows",
        inputs_changed(jacobians_read_by_columns),
        "J transposed",
    ),
    "qp: lam <= 0": ("qp", negative("lam", "A_lam"), "sign of the contact term"),
    "qp: forces": ("qp", multiplied(100.0, "lam", "A_lam"), "lam and force mixed up by h"),
    "qp: velocities": ("qp", multiplied(100.0, "delta_q"), "v in the place of delta_q"),
    "wrench: impulses": (
        "wrench",
        inputs_changed(lambda c: {**c, "h": 1.0}),
        "lam and force mixed up by h",
    ),
    "wrench: mu_omega mu_v": (
        "wrench",
        inputs_changed(mu_omega_times_mu_v),
        "mu_omega multiplied by mu_v",
    ),
    "wrench: no torque": ("wrench", outputs_changed(torsion_forgotten), "torsion rows missing"),
    "wrench: MuJoCo's order": (
        "wrench",
        patched("numpy_runner", "cone_table", interleaved),
        "rows interleaved",
    ),
    "integrate: twists in the world": (
        "integrate",
        patched("numpy_runner", "moved", world_moves),
        "world and body frames swapped",
    ),
    "integrate: straight": (
        "integrate",
        patched("numpy_runner", "moved", straight_moves),
        "a straight line in the place of the screw",
    ),
    "integrate: times h again": (
        "integrate",
        inputs_changed(lambda c: {**c, "delta_q": [0.01 * x for x in c["delta_q"]]}),
        "v in the place of delta_q",
    ),
    "step: mu_omega mu_v": (
        "step",
        inputs_changed(mu_omega_times_mu_v),
        "mu_omega multiplied by mu_v",
    ),
    "step: twists in the world": (
        "step",
        patched("numpy_runner", "kinematics", world_twists),
        "world and body frames swapped",
    ),
    "step: MuJoCo's order": (
        "step",
        patched("numpy_runner", "cone_table", interleaved),
        "rows interleaved",
    ),
    "step: |phi|": ("step", outputs_changed(unsigned_contacts), "unsigned phi"),
}


@pytest.mark.parametrize(("layer", "fault", "mistake"), FAULTS.values(), ids=FAULTS)
def test_a_planted_bug_fails_in_its_layer_and_is_named(layer, fault, mistake, monkeypatch):
    report = report_on(layer, fault(layer, monkeypatch))
    assert not report.ok
    assert report.count("failed") > 0
    names = [named.name for named in report.mistakes]
    assert mistake in names, (names, report.trouble)


MODULES = ("runner_mechanism", "runner_curved", "runner_distance", "runner_qp", "numpy_runner")
"""Each after those that it imports from."""
SEEDED = {mistake for _, _, mistake in FAULTS.values()}
FURTHER = {name: bug for name, bug in planted_bugs().items() if bug["mistake"] not in SEEDED}


def runner_with(changes, monkeypatch):
    """The NumPy runner with texts of its files replaced."""
    runner()
    for name in MODULES:
        text = (RUNNERS / f"{name}.py").read_text()
        for file, old, new in changes:
            if file == f"{name}.py":
                assert text.count(old.replace("\\n", "\n")) == 1
                text = text.replace(old.replace("\\n", "\n"), new.replace("\\n", "\n"))
        module = types.ModuleType(name)
        monkeypatch.setitem(sys.modules, name, module)
        exec(text, module.__dict__)
    return module


@pytest.mark.parametrize("name", FURTHER)
def test_a_planted_bug_of_the_table_is_named_too(name, monkeypatch):
    bug = FURTHER[name]
    module, layer = runner_with(bug["numpy"], monkeypatch), bug["layer"]
    families = [case for case in small_cases(layer) if "of the scenario" not in case.provenance]
    if layer == "step":
        families = [case for case in cases("step") if "of the scenario" not in case.provenance]
    outputs = {c.id: module.plain(getattr(module, layer)(c.input)) for c in families}
    report = report_on(layer, outputs)
    assert report.count("failed") > 0
    named = [bug["mistake"]] if bug["mistake"] else []  # some have no name
    assert [mistake.name for mistake in report.mistakes] == named


def test_every_mistake_that_is_recognised_is_planted():
    known = {one.name for one in HYPOTHESES if set(one.predictions) - {"derivative"}}
    assert known == {bug["mistake"] for bug in planted_bugs().values()} - {""}
    assert len(known) == 36


def test_answers_that_are_right_have_no_mistake():
    for layer in ("rows", "jacobian", "selection"):
        report = report_on(layer, right_answers(layer))
        assert report.ok
        assert report.mistakes == ()
