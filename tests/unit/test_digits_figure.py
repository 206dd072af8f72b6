"""The figure of correct digits: the committed results, and steps that a backend left unsolved."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.text import Text

from quasistatic_ref.figures.digits import BackendDigits, digits_of_backends
from validation.digits_of_backends import ACCURACIES, BACKENDS, SUBJECT, records_read

LEGIBLE = 7.0  # points


@pytest.fixture
def drawn():
    figures = []

    def figure_of(records):
        figures.append(digits_of_backends(records, SUBJECT))
        return figures[-1]

    yield figure_of
    for figure in figures:
        plt.close(figure)


def words(figure):
    figure.canvas.draw()
    return [t.get_text() for t in figure.findobj(Text) if t.get_text().strip()]


def test_the_committed_results_are_all_steps_of_every_backend_and_setting():
    records = records_read()
    assert len(records) == 2 * len(BACKENDS) * len(ACCURACIES)
    assert {r.steps for r in records} == {600}
    for r in records:
        assert 0 <= r.worst <= r.low <= r.median <= r.best <= 16


def test_natural_units_are_worth_digits_at_every_accuracy():
    """The story that the docs tell: the worst step gains wherever an accuracy is asked for."""
    by_setting = {(r.units, r.backend, r.accuracy): r for r in records_read()}
    raw, natural = dict.fromkeys(r.units for r in records_read())
    for backend in BACKENDS:
        for accuracy in ACCURACIES[1:]:
            before, after = (by_setting[u, backend, accuracy] for u in (raw, natural))
            assert after.worst >= before.worst
            assert after.median >= before.median


def test_markers_are_the_medians_and_each_backend_has_its_own(drawn):
    records = records_read()
    figure = drawn(records)
    panels = dict.fromkeys(r.units for r in records)
    for axes, units in zip(figure.axes, panels, strict=True):
        lines = {line.get_label(): line for line in axes.lines}
        shapes = {lines[backend].get_marker() for backend in BACKENDS}
        assert len(shapes) == len(BACKENDS)
        for backend in BACKENDS:
            medians = [r.median for r in records if (r.units, r.backend) == (units, backend)]
            assert lines[backend].get_ydata().tolist() == medians


def test_text_is_legible_and_says_what_is_shown(drawn):
    figure = drawn(records_read())
    said = " ".join(words(figure))
    for part in ("h = 10 ms", "friction pyramid", "no step unsolved", *BACKENDS):
        assert part in said
    sizes = [t.get_fontsize() for t in figure.findobj(Text) if t.get_text().strip()]
    assert min(sizes) >= LEGIBLE


def test_unsolved_steps_are_a_category_of_their_own(drawn):
    first, *others = records_read()
    nothing = BackendDigits("here", "lost", "1e-3", 600, 600, *[np.nan] * 4)
    some = replace(first, units="here", unsolved=3)
    said = words(drawn([some, nothing, *(replace(r, units="here") for r in others[:4])]))
    assert "0.5 % unsolved" in said
    assert "100.0 % unsolved" in said
    assert any("some steps unsolved" in text for text in said)
