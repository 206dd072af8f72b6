"""Which backend the word ``fast`` means where none is named."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.exact.components import connected_components
from quasistatic_ref.model.system import System
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.solve.backends import DAQP, DEFAULT
from quasistatic_ref.step.cones import cone

DENSE_BELOW: Final = 600_000
"""Entries of J, 4 n_c n_v, of the largest group of bodies below which ``fast`` asks DAQP, whose
matrices are dense, where no backend is named."""


def default_backend(system: System, pairs: Sequence[ContactPair], cone_name: str, law: str) -> str:
    """The backend of ``fast`` where none is named: DAQP, where its dense matrices are small enough.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    cone_name, law : str
    """
    if not (law == CONVEX and cone(cone_name).polyhedral):
        return DEFAULT
    moves = system.column_map.moves[:, 0] > 0
    moved = [moves[pair.alpha.link] | moves[pair.beta.link] for pair in pairs]
    pair, joint = np.nonzero(np.reshape(moved, (len(pairs), moves.shape[1])))
    shape = len(pairs), system.n_v
    of_coordinate, of_pair = connected_components(pair, system.column_map.owner[joint], shape)
    n_c = np.array([one.n_c for one in pairs], dtype=np.int64)
    sizes = np.bincount(of_coordinate)
    entries = 4 * np.bincount(of_pair, n_c, len(sizes)) * sizes
    return DAQP if entries.max(initial=0) < DENSE_BELOW else DEFAULT
