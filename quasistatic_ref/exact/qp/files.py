"""Our own files of programs with their answers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from quasistatic_ref.errors import about_file
from quasistatic_ref.exact.qp.answer import (
    QP_FORMAT,
    VERSION,
    Answer,
    ExactQP,
    QPInfeasible,
    QPNotConvex,
    QPUnbounded,
)
from quasistatic_ref.exact.qp.program import FIELDS, NO_LIMIT, program_of
from quasistatic_ref.text.content import json_read
from quasistatic_ref.text.table_reader import TableReader


def load_answer(path: str | Path) -> Answer:
    """A file of ``save``: nothing of what it claims is believed until it is verified.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    ExactQP, QPInfeasible, QPUnbounded or QPNotConvex
        The proofs as they are raised.

    Raises
    ------
    InputError
        Naming the file, the field and the value.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = Path(tempfile.mkdtemp()) / "answer.json"
    >>> _ = qr.exact_qp(np.eye(2), [-3.0, -1.0]).save(path)
    >>> bool(qr.verify(qr.load_answer(path)))
    True
    """
    with about_file(path):
        return _answer(TableReader(json_read(path)))


def _answer(top: TableReader) -> Answer:
    top.check_format(QP_FORMAT, VERSION)
    arrays = [_limits(field, top.take(field)) for field in FIELDS]
    program = program_of(*arrays, constant=top.take("constant"))
    status = top.text("status", choices=("optimal", "infeasible", "unbounded", "not convex"))
    answer: Answer
    if status == "infeasible":
        table = top.table("farkas")
        exact = {name: table.text(name) for name in table.names_left()}
        answer = QPInfeasible(program, exact)
    elif status == "unbounded":
        answer = QPUnbounded(program, top.words("x"), top.words("direction"))
    elif status == "not convex":
        answer = QPNotConvex(program, top.words("direction"))
    else:
        sizes = {"x": len(program.q)} | program.sizes
        answer = ExactQP(
            problem=program,
            **{name: top.array(name, (size,)) for name, size in sizes.items()},
            obj=top.number("obj"),
            obj_error=top.number("obj_error", least=0.0),
            active=tuple(top.words("active")),
            multipliers_unique=top.boolean("multipliers_unique"),
            least_norm=tuple(top.words("least_norm")),
            direction=tuple(top.words("direction")),
        )
    top.close()
    return answer


def _limits(field: str, value: Any) -> Any:
    """A field of JSON, whose nulls are infinite."""
    if field in NO_LIMIT and isinstance(value, list):
        return [NO_LIMIT[field] if v is None else v for v in value]
    return value
