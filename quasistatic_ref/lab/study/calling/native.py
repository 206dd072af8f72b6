"""Backends in their own interfaces: set up for a problem, or kept from the problem before."""

import importlib
from time import perf_counter
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, issparse, triu

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program, SparseProgram
from quasistatic_ref.solve.backends import BACKENDS, Options
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

QUIET: dict[str, Options] = {"osqp": {"verbose": False}}
"""What keeps a backend from printing, which it does by default."""


class Native:
    """One backend, called through its adapter.

    Parameters
    ----------
    name : str
        Of a backend with an adapter.
    """

    def __init__(self, name: str) -> None:
        module = importlib.import_module(f"quasistatic_ref.optional.fast.adapters.{name}")
        self.kind: type[Adapter] = getattr(module, BACKENDS[name].adapter)
        self.quiet = QUIET.get(name, {})

    def __call__(self, form: StandardForm, options: Options, before: Reply | None = None) -> Reply:
        """The reply to a problem.

        Parameters
        ----------
        form : StandardForm
        options : dict
            In the backend's own names.
        before : Reply, optional
            To the problem before: its memory and factors are kept, and where it has an x, the
            backend starts from what it found. By default the backend is set up.
        """
        if before is None:
            return self._set_up(form, options)
        p = self.program
        same_H = np.array_equal(p.H, form.H)
        p.H[:] = form.H
        p.f[:] = -form.g
        p.A[:] = form.A
        p.b[:] = form.b
        return self.adapter.reply(same_H=same_H, warm=before.x is not None)

    def _set_up(self, form: StandardForm, options: Options) -> Reply:
        self.program = self._program(form)
        begin = perf_counter()
        self.adapter = self.kind(self.program, options | self.quiet)
        ready = perf_counter()
        said = self.adapter.reply(same_H=True, warm=False)
        end = perf_counter()
        said.call_seconds = end - begin
        said.own = said.seconds
        said.setup = ready - begin
        return said

    def _program(self, form: StandardForm) -> Any:
        """The problem as the adapter takes it, dense or sparse as it is."""
        if issparse(form.H):
            P = csc_matrix(triu(form.H))
            return SparseProgram(form.H.copy(), P, -form.g, form.A.copy(), form.b.copy())
        order = self.kind.ORDER
        H = form.H.copy(order=order)
        return Program(H, -form.g, form.A.copy(order=order), form.b.copy())
