"""H kept by K_q and the blocks of M_u: formed when it is read, what follows from it once."""

import copy
import pickle

import numpy as np

from quasistatic_ref.step.hessian import Hessian, hessian
from tests.made import bits

BLOCKS = np.array([np.diag([1.0, 2.0]), [[3.0, 0.5], [0.5, 4.0]]])
WHOLE = np.block([[BLOCKS[0], np.zeros((2, 2))], [np.zeros((2, 2)), BLOCKS[1]]])
K_Q = np.array([[5.0, 1.0], [1.0, 6.0]])


def test_blocks_stand_for_the_whole_matrix():
    by_blocks, whole = Hessian(0.5, K_Q, BLOCKS), Hessian(0.5, K_Q, WHOLE)
    written = pickle.dumps(by_blocks)
    assert bits(by_blocks.M_u) == bits(WHOLE)
    assert bits(by_blocks.matrix) == bits(hessian(0.5, K_Q, WHOLE)) == bits(whole.matrix)
    assert bits(by_blocks.entries) == bits(whole.entries)
    for some in ([0, 1], [1, 2, 5], [3, 4], [5], []):
        at = np.array(some, np.int64)
        part = by_blocks.part(at)
        assert bits(part.matrix) == bits(whole.part(at).matrix)
        assert bits(part.matrix) == bits(whole.matrix[np.ix_(at, at)].copy())
        assert by_blocks.part(at) is part
    assert by_blocks.once(np.size) is by_blocks.once(np.size)
    for again in (pickle.loads(pickle.dumps(by_blocks)), copy.deepcopy(by_blocks)):
        assert again == by_blocks
        assert pickle.dumps(again) == written  # without what follows
