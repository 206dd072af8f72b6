"""When compiled functions stand in the place of NumPy's, and when they do not."""

import os
import subprocess
import sys

import pytest

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.optional.compiled import leaves

pytestmark = pytest.mark.extra("fast")


@pytest.mark.parametrize("word", leaves.LEAVES)
def test_each_answers_its_trials(word):
    for instance, arguments in leaves.LEAVES[word].trials():
        assert leaves.LEAVES[word].of(instance)(*arguments) is not None
    assert leaves.is_right(word)


def test_one_with_other_bits_is_left_out(monkeypatch, capfd):
    """As if a compiler had made it wrong."""
    leaf = leaves.LEAVES["Sums.plus"]
    wrong = leaf._replace(of=lambda sums: lambda *ends: leaf.of(sums)(*ends) + 1e-16)
    monkeypatch.setattr(leaves, "LEAVES", {"Sums.plus": wrong})
    leaves.is_right.cache_clear()
    system = System([Body.of_shape("ball", Sphere(0.05), mass=0.3)])
    assert system.integrate(system.q_start, [0.1, 0, 0, 0, 0, 0]).tolist()[0] == 0.1
    assert leaves.compiled_method("Sums.plus", system.sums) is None
    assert capfd.readouterr().err == "compiled code is left out: Sums.plus has other bits\n"
    leaves.is_right.cache_clear()


@pytest.mark.parametrize("value", ["0", "1"])
def test_a_variable_of_the_environment_turns_all_off(value):
    code = (
        "import quasistatic_ref as qr; from quasistatic_ref.optional.compiled import leaves;"
        "s = qr.System([qr.Body.of_shape('b', qr.Sphere(0.05), mass=0.3)]).sums;"
        "print(leaves.compiled_method('Sums.plus', s) is None)"
    )
    environment = os.environ | {"QUASISTATIC_REF_COMPILED": value}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == [str(value == "0")]
