"""What is said of a run that takes long: of `fast`."""

import sys
from collections.abc import Mapping, Sequence

from tqdm import tqdm

from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.rollout import PACE
from quasistatic_ref.tolerances import SPARSE_FROM_PIQP

FIRST = 5
"""Steps whose time is measured; the one before them, which compiles the problem, is left out."""

SAVED = 0.9
"""Share of the time of a step that `fast` saves at least, on the scenes that come along."""

WORTH = 10.0
"""Seconds saved from which a run says so."""


class Pace(Observer):
    """Measures the steps of a run, and prints that `fast` would shorten it.

    Parameters
    ----------
    fast : bool
        Whether the run is fast already; of what `fast` would save nothing is said then.
    steps : int
        How many are to be taken.
    """

    def __init__(self, fast: bool, steps: int) -> None:
        self.fast = fast
        self.every_step = not fast  # until enough steps are measured
        self.left = steps
        self.times: list[float] = []
        self.opened = False

    def before(self, recorder: Recorder) -> None:
        """Before the first step, of a large scene."""
        if not self.opened:
            simulator = recorder.simulator
            said(self.opening(4 * len(simulator.layout.rows) * simulator.system.n_v))
        self.opened = True

    def after(
        self, recorder: Recorder, results: Sequence[StepResult], arrays: StepArrays
    ) -> dict[str, float]:
        """After steps, what `fast` would save."""
        for result in () if self.fast else results:  # which would be made for nothing
            said(self.advice(result.seconds))
        return {}

    def opening(self, entries: int) -> str | None:
        """One sentence before the first step, where J has so many `entries`, 4 n_c n_v."""
        if self.fast or entries < SPARSE_FROM_PIQP:
            return None
        return (
            f"J has {entries:,} entries in each step, dense on the plain path; --fast (fast=True "
            "in Python) takes large steps in blocks"
        )

    def advice(self, seconds: Mapping[str, float]) -> str | None:
        """One sentence, when enough steps are measured and `fast` would save ten seconds.

        Parameters
        ----------
        seconds : mapping of str to float
            Wall time of the parts of the step that was just taken [s].
        """
        self.left -= 1
        if self.fast or len(self.times) > FIRST:
            return None
        self.times.append(sum(seconds.values()))
        self.every_step = len(self.times) <= FIRST
        rest = self.left * sum(self.times[1:]) / FIRST
        if len(self.times) <= FIRST or SAVED * rest < WORTH:
            return None
        return (
            f"the other {self.left} steps take some {rest:.0f} s; --fast (fast=True in Python) "
            "takes the same steps sooner, to the same certified bits"
        )


def said(sentence: str | None) -> None:
    """Print a sentence, if there is one, above the bar of progress."""
    if sentence is not None:
        tqdm.write(f"quasistatic-ref: {sentence}", file=sys.stderr)


PACE.fill(Pace)
