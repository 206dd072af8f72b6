"""Contacts smoothed by a log barrier (Pang, Suh, Yang and Tedrake, 2023), for gradients."""

import cvxpy as cp

from quasistatic_ref.step.extension import Extension


def smoothing(weight):
    """Forces at a distance weight / slack / h; the hard step is the limit weight -> 0 [N m s]."""
    return Extension(lambda s: [-weight * sum(cp.sum(cp.log(rows)) for rows in s.slack)])
