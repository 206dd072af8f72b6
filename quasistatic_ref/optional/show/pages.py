"""The page of each class that has one: a scenario, a run, a step and its certificate."""

from collections.abc import Callable

from quasistatic_ref.optional.show.show import Page, html_page, text_page
from quasistatic_ref.optional.show.simulate_words import scenario_page, trajectory_page
from quasistatic_ref.optional.show.step_words import certificate_page, step_page

PAGES: dict[str, Callable[..., Page]] = {
    "Certificate": certificate_page,
    "Scenario": scenario_page,
    "StepData": step_page,
    "Trajectory": trajectory_page,
}
"""By the name of the class: to show a step, neither pinocchio nor coal is imported."""


def text(shown: object) -> str:
    """An object in words, as ``repr`` shows it."""
    return text_page(_page(shown))


def html(shown: object) -> str:
    """An object as an HTML element, as a notebook shows it."""
    return html_page(_page(shown))


def _page(shown: object) -> Page:
    names = (kind.__name__ for kind in type(shown).__mro__)
    return next(PAGES[name](shown) for name in names if name in PAGES)
