"""Layer `step`: everything at once, composed layer by layer.

Its cases are files. Most were made once: each layer's correctly rounded answer was the next
one's input, and tolerances and ties came from distances in exact numbers.
"""

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's answer, through its own System, pairs and simulator."""
    from quasistatic_ref.lab.vectors.own.step import own_step

    return own_step(case_input)
