"""What a solver prints when it begins does not reach standard output."""

import os
import sys
from types import SimpleNamespace

from quasistatic_ref.solve.greeting import greeting_silenced


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
