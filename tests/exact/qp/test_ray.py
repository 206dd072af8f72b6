"""Proofs of infeasibility at a dual ray of HiGHS: whatever it says, fractions decide."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.exact.qp import ray, search
from quasistatic_ref.exact.qp.block import blocks_of
from quasistatic_ref.exact.qp.program import program_of


def transport(rng, short):
    """What is sent along random roads from stores, which lack `short` of what towns ask for."""
    stores, towns = rng.integers(3, 7, 2)
    roads = [(i, j) for i in range(stores) for j in range(towns) if rng.random() < 0.7 or i == 0]
    n = len(roads)
    A, G = np.zeros((towns, n)), np.zeros((stores, n))
    for k, (i, j) in enumerate(roads):
        G[i, k] = A[j, k] = rng.integers(1, 4)
    b = rng.integers(1, 9, towns).astype(float)
    shares = rng.dirichlet(np.ones(stores)) * (b.sum() - short)
    P = np.diag(rng.integers(0, 2, n)).astype(float)
    return {"P": P, "q": np.ones(n), "G": G, "h": shares, "A": A, "b": b, "lb": np.zeros(n)}


def test_where_no_two_rows_are_a_proof_those_of_a_ray_are(monkeypatch, rng):
    asked = []

    def counted(block, of=search.ray_proof):
        asked.append(of(block))
        return asked[-1]

    monkeypatch.setattr(search, "ray_proof", counted)
    monkeypatch.setattr(ray, "FEW", 0)
    for _ in range(40):
        with pytest.raises(qr.QPInfeasible) as proof:
            qr.exact_qp(**transport(rng, 1.0))
        verdict = qr.verify(proof.value)
        assert verdict, verdict.reason
    assert len(asked) > 20
    assert None not in asked


def test_a_program_with_a_point_has_no_proof_whatever_the_ray_says(monkeypatch, rng):
    asked = []

    def false_ray(model):
        asked.append(rng.integers(-3, 4, len(model.general)).astype(float))
        return asked[-1]

    monkeypatch.setattr(ray, "FEW", 0)
    monkeypatch.setattr(ray, "_ray", false_ray)
    for _ in range(40):
        program = transport(rng, 1.0)
        x = rng.uniform(0, 1, len(program["q"]))
        arrays = program["P"], program["q"], program["G"], program["G"] @ x, None, None
        assert not any(map(ray.ray_proof, blocks_of(program_of(*arrays, x - 1, x + 1))))
    assert len(asked) >= 40


def test_a_light_installation_has_no_ray(monkeypatch, rng):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(ray, "LinearModel", missing)
    with pytest.raises(qr.QPInfeasible) as proof:
        qr.exact_qp(**transport(rng, 1.0))
    assert qr.verify(proof.value)
