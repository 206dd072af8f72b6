"""What a step over a pipe costs, over the same step in one's own process; both with ``fast``.

Run ``python -m validation.make.served_steps --out FILE`` (half a minute, on a quiet machine). Steps
are taken in turn: by a simulator, and by ``quasistatic-ref serve SCENE --fast`` in lines of JSON
and in binary form, without forces. Exit status 1 if one costs more than three times the step.
"""

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from quasistatic_ref.lab.bench.timing import in_turn, microseconds, ratio
from quasistatic_ref.lab.oracle.pipes import HEAD
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.step.data import Array
from validation.tools.scripts import script_options, show_page

SCENES = ("sphere_spin", "two_finger_pinch", "block_push", "stack", "bunny_grasp")
STEPS = 200
LIMIT = 3.0
"""What a step over the pipe may cost, over the step [-]."""


class Pipe:
    """A program that serves a scene."""

    def __init__(self, scene: str, *options: str) -> None:
        words = [sys.executable, "-m", "quasistatic_ref", "serve", scene, "--fast", *options]
        self.program = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self.program.stdin is not None
        assert self.program.stdout is not None
        self.to = self.program.stdin
        self.back = self.program.stdout
        self.back.readline()  # what it is

    def line(self, q: Array, target: Array) -> Array:
        """The next configuration, asked for by a line of JSON."""
        asked = {"q": q.tolist(), "target": target.tolist(), "ask": ["q"]}
        self.to.write(json.dumps(asked).encode() + b"\n")
        self.to.flush()
        return np.array(json.loads(self.back.readline())["q"])

    def numbers(self, q: Array, target: Array, force: Array) -> Array:
        """The next configuration, asked for in binary form."""
        self.to.write(HEAD.pack(0, 0) + q.tobytes() + target.tobytes() + force.tobytes())
        self.to.flush()
        _, size = HEAD.unpack(self.back.read(HEAD.size))
        return np.frombuffer(self.back.read(size))

    def close(self) -> None:
        """End it."""
        self.to.close()
        self.program.wait()


def times(name: str) -> Mapping[str, Array]:
    """Times of each step of a scene, taken in the three ways in turn, shape (STEPS,) [s]."""
    scenario = load_scenario(name, fast=True)
    simulator = scenario.simulator()
    force = np.zeros(scenario.system.n_v)
    lines, numbers = Pipe(name), Pipe(name, "--binary")
    rounds = []
    q = scenario.system.q_start
    for k in range(STEPS):
        target = scenario.targets((k + 1) * scenario.h)
        rounds.append({
            "step": partial(simulator.step, q, target, force),
            "line": partial(lines.line, q, target),
            "numbers": partial(numbers.numbers, q, target, force),
        })  # fmt: skip
        q = simulator.step(q, target, force).q
    asked = lines.line(q, target), numbers.numbers(q, target, force)
    own = simulator.step(q, target, force).q
    assert all(np.array_equal(own, one) for one in asked)
    found = in_turn(rounds, repeat=3)
    lines.close()
    numbers.close()
    return found


HEAD_OF_PAGE = f"""# What a step over a pipe costs

Made by `python -m validation.make.served_steps`: medians of {STEPS} steps, proved and with `fast`,
the least of three times each. In one's own process, and over those by `quasistatic-ref serve`, in
lines of JSON and in binary form, without forces. At most {LIMIT:g} is wanted.
"""


def page(found: Mapping[str, Mapping[str, Array]]) -> Iterator[str]:
    """The committed page."""
    yield HEAD_OF_PAGE
    rows = [
        (name, f"{microseconds(t['step']):.0f}",
         *(f"{ratio(t[way], t['step']):.2f}" for way in ("line", "numbers")))
        for name, t in found.items()
    ]  # fmt: skip
    head = ("scene", "step [us]", "a line, over the step", "in binary form, over the step")
    yield from markdown_table(head, rows)


def main() -> int:
    """Measure; write the page."""
    options = script_options(__doc__, out=Path)
    found = {name: times(name) for name in SCENES}
    show_page("\n".join(page(found)), options.out)
    ways = ("line", "numbers")
    return int(any(ratio(t[way], t["step"]) > LIMIT for t in found.values() for way in ways))


if __name__ == "__main__":
    sys.exit(main())
