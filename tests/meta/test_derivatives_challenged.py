"""A sample of validation/make/derivatives.py: random scenes, by all that a step is made of."""

from validation.make.derivatives import challenge_outcome


def test_r35_the_package_s_derivatives_pass_a_few_new_cases():
    assert challenge_outcome(6).verdicts == {("derivative", "passed"): 6}
