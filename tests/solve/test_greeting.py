"""What a solver prints when it begins does not reach standard output."""

import os
import sys
from types import SimpleNamespace

from quasistatic_ref.solve.greeting import greeting_silenced
from tests.processes import python


def test_what_highs_prints_at_its_first_object_is_not_seen(monkeypatch, capfd):
    greeted = []

    def greeting():
        greeted.append(True)
        os.write(1, b"Running HiGHS\n")

    monkeypatch.setitem(sys.modules, "highspy", SimpleNamespace(Highs=greeting))
    greeting_silenced.cache_clear()
    for _ in range(2):
        greeting_silenced()
    greeting_silenced.cache_clear()
    print("said by us")
    assert greeted == [True]
    assert capfd.readouterr().out == "said by us\n"


PROGRAM = """
import quasistatic_ref.solve.solve
from quasistatic_ref.solve.backends import installed
assert "scs" not in installed("cvxpy")
"""


def test_a_solver_that_cannot_be_imported_is_left_out_in_our_words(tmp_path):
    (tmp_path / "scs.py").write_text("raise RuntimeError('no licence')")
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = python("-c", PROGRAM, env=environment)
    assert done.stdout == ""
    assert "UserWarning: scs is installed, but cannot be imported, and is left out" in done.stderr
    assert "licence" not in done.stderr
