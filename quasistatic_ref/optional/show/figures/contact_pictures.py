"""Which contacts of a run stick, and which slide."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.show.figures.looks import STATES
from quasistatic_ref.optional.show.figures.moments import contact_states
from quasistatic_ref.optional.show.figures.style import legend_above, scaled
from quasistatic_ref.simulate.trajectory import Trajectory

COLOURS: Final = {"apart": "white", "sticking": STATES["sticking"], "sliding": STATES["sliding"]}
"""White, black and, in print without colours, a middle grey."""
WORDS: Final = {"apart": "bears no load", "sticking": "sticks", "sliding": "slides"}


def stick_slip_map(axes: Axes, run: Trajectory) -> None:
    """Draw which contacts stick and which slide: a row for each contact, time to the right.

    Parameters
    ----------
    axes : Axes
    run : Trajectory
        With the record ``"full"``: others do not know what slides.

    Raises
    ------
    InputError
        If the run has no steps, or another record.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> scenario = qr.load_scenario("block_incline", ["record=full"], steps=3)
    >>> qr.figures.stick_slip_map(axes, scenario.run(progress=False))
    >>> axes.get_xlabel()
    'time t [s]'
    """
    if not run.steps:
        raise InputError("has no steps to show", field="trajectory")
    if run.header.record != "full":
        problem = "does not know what slides; run it again with record = 'full'"
        raise InputError(problem, field="record", value=run.header.record)
    states = contact_states(run)
    numbers = np.select([states == state for state in COLOURS], range(len(COLOURS)))
    end = run["t"][-1]
    axes.imshow(
        numbers.T, aspect="auto", interpolation="nearest", cmap=ListedColormap([*COLOURS.values()]),
        vmin=0, vmax=len(COLOURS) - 1, extent=(0.0, end, states.shape[1] - 0.5, -0.5),
    )  # fmt: skip
    pairs = run.pair_names
    first = [j for j, name in enumerate(pairs) if j == 0 or pairs[j - 1] != name]
    axes.hlines(np.array(first[1:]) - 0.5, 0.0, end, color="0.5", linewidth=scaled(0.8))
    axes.set_yticks(first, [pairs[j].partition("(")[0] for j in first])
    axes.set(xlabel="time t [s]", ylabel="contacts")
    axes.grid(visible=False)
    handles = [
        Patch(facecolor=colour, edgecolor="black", label=WORDS[state])
        for state, colour in COLOURS.items()
    ]
    legend_above(axes, handles)
