"""Numbers on the pages of docs/ that stand before a unit but are no measurement.

They were chosen, or are part of a formula, an example or a definition. Measured numbers are in
tests/quoted_pages.py.
"""

from tests import quoted_reality as reality

CHOSEN = {
    "docs/artifacts.md": [
        "c = 20 mm, $\\rho$ = 30 mm",
        "$\\mu$ = 0.3, l = 20 mm",
        "slides down 25 degrees",
    ],
    "docs/cones.md": [
        "tangents by 90 degrees",
        "; 45 degrees",
        "d of 0, 5, 20 and 50 mm",
        "a patch of 5 mm",
    ],
    "docs/conventions.md": [
        "by more than 0.1 %",
    ],
    "docs/derivations.md": ["A body 1 mm deep with h = 10 ms"],
    "docs/distances.md": ["sqrt 3 times"],
    "docs/engines.md": ["Steps are 1 ms in all engines but ours, which takes 10 ms"],
    "docs/exactness.md": ["a step lifts the bunny by 0.2 mm"],
    "docs/exercises.md": [
        "with h = 10 ms",
        "with h = 1 ms",
        "with h = 5 ms",
        "with mu_v = 0.5 and mu_omega = 20 mm press with 5 N",
        "50 mm from its centre of mass, with mu_v = 0.5 and mu_omega = 20 mm:",
        "its point r = (30, -20, -10) mm",
        "Use 1, 2 and 4 mm",
        "the rotation for 2 mm",
    ],
    "docs/extensions.md": ["0.2 kg, 20 mm off the axis"],
    "docs/guides/add_a_scenario.md": ["under 1 MB"],
    "docs/guides/first_scene.md": [
        "target lies 5 mm inside",
        "K_q times 5 mm = 5 N",
        "The target rises by 30 mm",
    ],
    "docs/guides/in_python.md": ["1 mm above the ground", "h^2 g = 3.9 mm"],
    "docs/guides/write_a_scenario.md": ["deeper than 1 %", "the same 1 %"],
    "docs/lecture.md": [
        "$K_q$ = 500 N/m whose target is 4 mm ahead, and 1 mm ahead",
        "$\\delta q_a = \\phi$ = 1 mm, and $N = K_q(\\delta\\bar q_a - \\phi)$ = 500 N/m x 3 mm",
        "$\\delta\\bar q_a$ = 4 mm is how far",
        "Take a ball of 10 mm",
        "on its face x = -50 mm",
        "opening by 1 mm moves each finger 0.5 mm away",
        "A wheel of radius r = 50 mm",
        "With h = 10 ms instead",
    ],
    "docs/quickstart.md": [
        "mu_omega = 10 mm",
        "0.5 times the weight",
        "0.5 times the normal force",
        "r = 12 mm",
        "The gripper rises by 40 mm",
        "and a step is h = 10 ms",
        "the one with 3 mm",
    ],
    "docs/studies.md": [
        "1 to 1e9 times as heavy",
        "| 3 digits |",
        "| 1, 2.5, 4 digits |",
        "| 5.5 digits |",
        "differs by up to 1 %",
        "3, 6 and 9 digits",
        "delivers 0 digits",
        "mu_omega = 1 mm",
        "ProxQP 0.8 calls",
    ],
    "docs/reality.md": reality.CHOSEN,
    "docs/speed.md": [
        "a step takes less than 90 us",
        '"less than 90 μs"',
        "The paper's 90 us",
        "a lone box of 0.5 kg by 60 mm in a step, beyond its own side; its edges then lie 7 mm",
        "the scenes now have steps of 1 ms",
        "It took 11.8 times, with a target of 12, before",
    ],
    "docs/theory/notation.md": ["6 or 4 times"],
    "docs/theory/the_paper.md": [
        "= 0.39 mm",
        "less than 90 µs for a step",
        "and 90 µs where it is quoted",
    ],
    "docs/tour.md": [
        "the height c = 40 mm",
        "corners at w = 50 mm",
        "h = 10 ms",
        "mu_omega is a length: 20 mm",
    ],
}
