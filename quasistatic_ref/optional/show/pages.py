"""The page of each class of the core that shows itself."""

from collections.abc import Callable

from quasistatic_ref.formats.shown import HTML, TEXT
from quasistatic_ref.optional.show.derivative_words import derivatives_page
from quasistatic_ref.optional.show.model_words import system_page
from quasistatic_ref.optional.show.show import Page, html_page, text_page
from quasistatic_ref.optional.show.simulate_words import (
    NOT_IN_TEXT,
    recorder_page,
    result_page,
    scenario_page,
    simulator_page,
    trajectory_page,
)
from quasistatic_ref.optional.show.step_words import (
    certificate_page,
    contacts_page,
    extra_page,
    form_page,
    problem_page,
    solution_page,
    step_page,
)

PAGES: dict[str, Callable[..., Page]] = {
    "Certificate": certificate_page,
    "Contacts": contacts_page,
    "Derivatives": derivatives_page,
    "Extra": extra_page,
    "Recorder": recorder_page,
    "Scenario": scenario_page,
    "Simulator": simulator_page,
    "SparseContacts": contacts_page,
    "StandardForm": form_page,
    "StepData": step_page,
    "StepProblem": problem_page,
    "StepResult": result_page,
    "StepSolution": solution_page,
    "System": system_page,
    "Trajectory": trajectory_page,
}
"""By the name of the class: to show a step, neither pinocchio nor coal is imported."""
WIDE = ("StepResult", "Trajectory")
"""Classes whose tables have more columns than a line of text has room for."""


def text(shown: object) -> str:
    """An object in words, as ``repr`` shows it."""
    name = _class_with_page(shown)
    return text_page(PAGES[name](shown), *(NOT_IN_TEXT if name in WIDE else ()))


def html(shown: object) -> str:
    """An object as an HTML element, as a notebook shows it."""
    return html_page(PAGES[_class_with_page(shown)](shown))


def _class_with_page(shown: object) -> str:
    return next(kind.__name__ for kind in type(shown).__mro__ if kind.__name__ in PAGES)


TEXT.fill(text)
HTML.fill(html)
