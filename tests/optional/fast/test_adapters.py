"""Adapters alone: an answer in closed form, a program rewritten in place, cold and warm starts."""

from importlib import import_module

import numpy as np
import pytest

from quasistatic_ref.optional.fast.adapters.daqp import STATUS
from quasistatic_ref.optional.fast.adapters.program import Program, SparseProgram
from quasistatic_ref.solve.backends import BACKENDS, installed
from tests.closeness import assert_within
from tests.tolerances import OPTIMUM

every_backend = pytest.mark.parametrize("name", installed("native"))


def adapter_class(name):
    return getattr(
        import_module(f"quasistatic_ref.optional.fast.adapters.{name}"), BACKENDS[name].adapter
    )


def write_program(program, h, g, a, b):
    """Rewrite a program: H = [[h, 1], [1, 2]], g = (0, g), and the rows a x_1 >= b, x_2 >= -9.

    Where the first row bears load and the second does not, x_1 = b / a, x_2 = (g - x_1) / 2 and
    lam_1 = (h x_1 + x_2) / a, by the two entries of H x - g = A'lam.
    """
    program.H[:] = [[h, 1.0], [1.0, 2.0]]
    program.f[:] = [0.0, -g]
    program.A[:] = [[a, 0.0], [0.0, 1.0]]
    program.b[:] = [b, -9.0]
    x_1 = b / a
    x_2 = (g - x_1) / 2
    return [x_1, x_2], [(h * x_1 + x_2) / a, 0.0]


def adapter_and_program(name):
    """An adapter in its backend's own options, and the program that it holds."""
    order = adapter_class(name).ORDER
    H = np.zeros((2, 2), order=order)
    A = np.zeros((2, 2), order=order)
    program = Program(H, np.zeros(2), A, np.zeros(2))
    write_program(program, h=3.0, g=4.0, a=2.0, b=2.0)
    return adapter_class(name)(program, BACKENDS[name].first(1e-12)), program


@every_backend
@pytest.mark.parametrize("h", [3.0, 5.0])
def test_a_program_that_is_rewritten_is_solved_as_it_stands(name, h):
    adapter, program = adapter_and_program(name)
    for g, a in ((4.0, 2.0), (6.0, 4.0)):
        x, lam = write_program(program, h, g, a, b=2.0)
        reply = adapter.reply(same_H=h == 3.0, warm=False)
        assert reply.solved
        assert reply.iterations > 0
        assert_within(reply.x, x, OPTIMUM)
        assert_within(reply.lam, lam, OPTIMUM)


@every_backend
def test_rows_that_contradict_each_other_are_not_solved(name):
    """2 x_1 >= 2 and -2 x_1 >= 2."""
    adapter, program = adapter_and_program(name)
    program.A[1] = [-2.0, 0.0]
    program.b[1] = 2.0
    assert not adapter.reply(same_H=True, warm=False).solved


@every_backend
def test_a_cold_start_takes_as_long_as_the_first_and_a_warm_one_is_shorter(name):
    adapter, _ = adapter_and_program(name)
    first, warm, cold = (adapter.reply(True, warm=warm) for warm in (False, True, False))
    assert cold.iterations == first.iterations
    assert (warm.iterations < first.iterations) == adapter_class(name).WARM


def test_every_exit_flag_of_daqp_has_a_word():
    """By its manual 1 and 2 are solutions, -1 to -6 are none; -1 is that of no feasible point."""
    assert sorted(STATUS) == [-6, -5, -4, -3, -2, -1, 1, 2]
    adapter, program = adapter_and_program("daqp")
    assert adapter.reply(same_H=True, warm=False).status == "optimal"
    program.A[1] = [-2.0, 0.0]
    program.b[1] = 2.0
    assert adapter.reply(same_H=True, warm=False).status == "infeasible"


def sparse_program(H, f, A, b):
    """A program in compressed columns, zeros of H and A left out."""
    from scipy.sparse import csc_matrix

    return SparseProgram(csc_matrix(H), csc_matrix(np.triu(H)), f, csc_matrix(A), b)


def test_daqp_solves_what_nothing_couples_by_itself():
    """Parts of 1 to 4 unknowns, shuffled, the first without rows; b has what is written last.

    The optimum is unique: the answer to all of it at once is the same.
    """
    rng = np.random.default_rng(5)
    part = rng.permutation(np.repeat(np.arange(4), [1, 2, 3, 4]))
    part_of_row = rng.permutation(np.repeat([1, 2, 3], [3, 4, 6]))
    root = np.where(part[:, None] == part, rng.normal(size=(10, 10)), 0.0)
    H = root @ root.T + np.eye(10)
    A = np.where(part_of_row[:, None] == part, rng.normal(size=(13, 10)), 0.0)
    f = rng.normal(size=10)
    b = np.zeros(13)
    adapter = adapter_class("daqp")(sparse_program(H, f, A, b), BACKENDS["daqp"].first(1e-12))
    assert sorted(len(one.program.f) for one in adapter.workspaces) == [1, 2, 3, 4]
    for scale in (0.1, 1.0):
        b[:] = A @ rng.normal(size=10) - scale * rng.random(13)  # so that there is a solution
        reply = adapter.reply(True, warm=False)
        whole = adapter_class("daqp")(Program(H, f, A, b), BACKENDS["daqp"].first(1e-12))
        right = whole.reply(True, warm=False)
        assert reply.solved
        assert right.lam.max() > OPTIMUM
        assert_within(reply.x, right.x, OPTIMUM)
        assert_within(reply.lam, right.lam, OPTIMUM)
    b[np.flatnonzero(part_of_row == 3)] = np.inf
    reply = adapter.reply(True, warm=False)
    assert (reply.solved, reply.status) == (False, "infeasible")


def test_piqp_scales_dense_programs_only():
    """Its own number of rounds for a dense program, none for a sparse one in natural units."""
    dense, program = adapter_and_program("piqp")
    sparse = adapter_class("piqp")(sparse_program(program.H, program.f, program.A, program.b), {})
    assert dense.solver.settings.preconditioner_iter > 0
    assert sparse.solver.settings.preconditioner_iter == 0
