"""Kernels of OpenBLAS for other processors, and no vector code: one hash of a run's bits.

Processes of their own: ``OPENBLAS_CORETYPE`` chooses kernels, ``NPY_DISABLE_CPU_FEATURES`` and
``GLIBC_TUNABLES`` switch vector code off.
"""

import hashlib
import os
from functools import cache

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from tests.processes import python

NAMES = ("bunny_grasp", "block_incline", "door")
STEPS = 35
"""Formed by BLAS, q differed from steps 32, 1 and 29 on."""
VECTORS = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
WITHOUT = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable",
    "NPY_DISABLE_CPU_FEATURES": " ".join(VECTORS),
}


@cache
def hashes():
    """SHA-256 of q of some runs."""
    settings = ["record=light", f"steps={STEPS}"]
    runs = [load_scenario(name, settings, fast=True).run() for name in NAMES]
    return [hashlib.sha256(run["q"].tobytes()).hexdigest() for run in runs]


@pytest.mark.parametrize(
    "settings",
    [
        {"OPENBLAS_CORETYPE": "Haswell"},
        {"OPENBLAS_CORETYPE": "Nehalem", **WITHOUT},
    ],
    ids=["Haswell", "Nehalem, no vector code"],
)
@pytest.mark.long
def test_other_kernels_and_no_vector_code_end_at_the_same_bits(settings):
    source = f"from {__name__} import hashes; print(*hashes())"
    assert python("-c", source, env={**os.environ, **settings}).stdout.split() == hashes()
