"""Proofs that rows contradict each other, at the rows that a dual ray of HiGHS names."""

from __future__ import annotations

from importlib import import_module
from itertools import chain
from typing import Final

import numpy as np
from flint import fmpq, fmpz, fmpz_mat

from quasistatic_ref.exact.qp.basis import SMALL, LinearModel
from quasistatic_ref.exact.qp.block import Block
from quasistatic_ref.numbers.arrays import Array, Indices

FEW: Final = 32
"""Rows of a program up to which the dual method ends as soon."""
MOST: Final = 400
"""Rows of a ray above which their factors take longer than the dual method may."""


def ray_proof(block: Block) -> dict[int, fmpq] | None:
    """Factors of rows that contradict each other, if those of a dual ray do; else None.

    A ray has a factor for each row of several entries. Where a column of their sum vanishes, but
    for rounding, it has to; these columns give the factors in fractions. Bounds cancel the others.
    """
    if block.m <= FEW:
        return None
    try:
        model = LinearModel(block)
        ray = _ray(model)
    except ImportError:  # a light installation
        return None
    if ray is None:
        return None
    bears = np.abs(ray) > SMALL * np.abs(ray).max(initial=0.0)
    rows = model.general[bears]
    if not 0 < len(rows) <= MOST:
        return None
    for factors in _factors(block, rows, ray[bears]):
        proof = _with_bounds(model, factors)
        if proof is not None:
            return proof
    return None


def _ray(model: LinearModel) -> Array | None:
    """HiGHS's factors of the rows of several entries; None if it finds no contradiction."""
    cost = np.zeros(model.block.n)
    solver = model.solver(cost, presolve="off", simplex_strategy=1)
    if solver.getModelStatus() != import_module("highspy").HighsModelStatus.kInfeasible:
        return None
    _, is_there, ray = solver.getDualRay()
    return np.array(ray) if is_there else None


def _factors(block: Block, rows: Indices, ray: Array) -> list[dict[int, fmpq]]:
    """The factors of rows, each way, that leave the columns zero that a ray leaves so."""
    a = block.entries.some(rows, np.arange(block.n)).dense()
    left, size = np.abs(ray @ a), np.abs(ray) @ np.abs(a)
    whole = [block.row(int(i)) for i in rows]
    vanish = np.flatnonzero((size > 0) & (left <= SMALL * size)).tolist()
    none = fmpz(0)
    columns = [[row.entries.get(j, none) for row in whole] for j in vanish]
    basis, nullity = fmpz_mat(len(columns), len(rows), [*chain(*columns)]).nullspace()
    if nullity != 1:
        return []
    w = [fmpq(row[0]) for row in basis.tolist()]
    return [
        {int(i): sign * v * row.unit for i, v, row in zip(rows, w, whole, strict=True) if v}
        for sign in (1, -1)
    ]


def _with_bounds(model: LinearModel, factors: dict[int, fmpq]) -> dict[int, fmpq] | None:
    """Factors with those of bounds that cancel what is left; None if that is no proof."""
    block = model.block
    left, _ = block.combined(factors)
    proof = dict(factors)
    for j, v in left.items():
        k = int((model.of_low if v < 0 else model.of_high)[j])
        if k < 0:
            return None
        bound = block.row(k)
        proof[k] = -v * bound.unit / bound.entries[j]
    left, limit = block.combined(proof)
    signed = all(i < block.equations or v > 0 for i, v in proof.items())
    return proof if signed and not left and limit < 0 else None
