"""Faces of the pyramid on which contact forces are sought: guessed in floats, found exactly."""

import numpy as np
import pytest
from scipy.optimize import nnls

from quasistatic_ref import contact_forces, solve_step
from quasistatic_ref.exact.program import exact_matrix
from quasistatic_ref.optional.forces import eliminated, face_guess, forces
from quasistatic_ref.optional.forces.face_guess import guessed_faces, nearest_rows
from quasistatic_ref.optional.forces.faces import face, nearest_face, rows_of
from quasistatic_ref.optional.forces.of_group import group_compliance
from quasistatic_ref.optional.friction import cone_matrix
from tests.closeness import assert_within
from tests.optional.forces.blocks import POLYHEDRAL, block, walled_block
from tests.oracles import force_checks as checks
from tests.oracles.loaded_piles import loaded_pile


@pytest.mark.parametrize("step", [block(push=1.0), walled_block()])
def test_the_definition_decides_forces_where_newtons_method_does_not_end(step, monkeypatch):
    quick = contact_forces(step).wrench
    monkeypatch.setattr(forces, "eliminated_optimum", lambda *_: None)
    assert contact_forces(step).wrench.tobytes() == quick.tobytes()


def never(*_):
    raise AssertionError("what faces decide was left to the definition")


@pytest.mark.parametrize("cone", [*POLYHEDRAL, "facets-12"])
def test_the_nearest_face_obeys_its_conditions_and_has_the_nearest_point(cone, rng):
    """In small whole numbers, where many points lie on two faces; and by Lawson and Hanson's nnls.

    In exact numbers the conditions of :class:`Face` are those of the optimum.
    """
    C = rows_of(cone, len(cone_matrix(cone)))
    for z in rng.integers(-3, 4, (200, 4)):
        rows = nearest_face(cone, len(C), exact_matrix(z[:, None].astype(float)))
        found = face(cone, len(C), rows)
        lengths = (found.linear * exact_matrix(z[:, None].astype(float))).entries()
        *conditions, s_0, s_1, s_2, s_3 = lengths
        assert all(v >= 0 for v in conditions)
        s = np.array([float(v) for v in (s_0, s_1, s_2, s_3)]) / found.denominator
        nearest = C.T @ nnls(C.T, -z)[0]
        assert_within(s, nearest)
        on = C[[*nearest_rows(cone, len(C), z.astype(float))]]
        assert_within(on.T @ np.linalg.lstsq(on.T, -z)[0], nearest)


def wrong_guess(step, wrench):
    """The contacts whose face is guessed wrong, from forces."""
    c = group_compliance(step)
    program = eliminated.EliminatedStep(step, c)
    return program.wrong_faces(program.candidate(guessed_faces(step, c, wrench)))


def test_faces_are_guessed_in_floats(monkeypatch):
    """Mostly right from the start, and not only where c is so small that faces do not depend on it.

    From no forces they are as right.
    """
    wrong = []
    judged = eliminated.EliminatedStep.wrong_faces
    monkeypatch.setattr(
        eliminated.EliminatedStep, "wrong_faces",
        lambda self, candidate: wrong.append(judged(self, candidate)) or wrong[-1],
    )  # fmt: skip
    contact_forces(walled_block())
    for _, step in checks.random_steps(20):
        contact_forces(step)
        contact_forces(step, 1e-3)
        wrong_guess(step, np.zeros((step.contacts.n_c, 4)))
    assert len(wrong) >= 60
    assert sum(map(bool, wrong)) <= 2


def test_faces_of_a_pile_are_guessed_that_is_heavy_above():
    """Ten boxes, 1000 times as heavy as each other: no face is wrong, from no forces either."""
    step = loaded_pile(10.0 ** np.linspace(0, 3, 10), 1e-3, spring=1e4, press=3.0).step
    for wrench in (solve_step(step, "daqp").wrench, np.zeros((step.contacts.n_c, 4))):
        assert wrong_guess(step, wrench) == []


def test_wrong_guesses_are_mended_in_exact_numbers(monkeypatch):
    """Where float64 does not suffice, no contact is guessed to bear a load."""

    def singular(*_):
        raise np.linalg.LinAlgError

    monkeypatch.setattr(forces, "defined_optimum", never)
    steps = dict(checks.random_steps(14))
    for name in ("random 7", "random 13", "random 14"):
        quick = contact_forces(steps[name]).wrench
        with monkeypatch.context() as patch:
            patch.setattr(face_guess._Energy, "zero", singular)
            assert contact_forces(steps[name]).wrench.tobytes() == quick.tobytes()
