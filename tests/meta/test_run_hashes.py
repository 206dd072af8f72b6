"""A sample of validation/make/run_hashes.py: two kernels of OpenBLAS, one hash."""

from validation.make.run_hashes import Environment, hashes, hashes_in

NAMES = ("bunny_grasp", "block_incline", "door")
STEPS = 35
"""Formed by BLAS, q differed from steps 32, 1 and 29 on."""


def test_other_kernels_and_no_vector_code_end_at_the_same_bits():
    here = hashes(NAMES, STEPS, fast=True)
    for where in (Environment("Haswell"), Environment("Nehalem", vectors=False)):
        assert hashes_in(where, NAMES, STEPS) == here
