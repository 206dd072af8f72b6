"""Shared fixtures: random numbers, and what Hypothesis draws, are the same in every run.

Fixtures import what they use, so that light tests, and the process that shares out the tests, stay
light.
"""

import gc
import os
import resource
import shlex
import sys
from collections import defaultdict
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from tests import missing_parts
from tests.extras import is_in_test, is_missing, reason

settings.register_profile("same", derandomize=True, deadline=None, max_examples=10, database=None)
settings.register_profile("new", deadline=None, max_examples=15, print_blob=True)
settings.register_profile("long", deadline=None, max_examples=10_000)
settings.load_profile("same")  # pytest's --hypothesis-profile names another


def pytest_addoption(parser):
    """How many random steps both speeds take, and which share of slow tests a line takes."""
    parser.addoption("--count", type=int, default=40, help="random steps at both speeds")
    parser.addoption("--share", type=int, default=0, help="0, README's line; 1 or 2: of `shared`")


def pytest_configure(config):
    """Declare the markers of tests that need an extra, and of those that only ``.ci/run`` takes."""
    config.pluginmanager.register(missing_parts)
    config.addinivalue_line("markers", "extra(name): a test that needs an extra of pyproject.toml")
    config.addinivalue_line("markers", "long: one of many of its kind; pytest -m long takes them")
    config.addinivalue_line("markers", "shared: slow; lines that run all tests share its cases")
    config.addinivalue_line("markers", "ci: what README's line leaves to .ci/run, marked by itself")


SHARES = 3
"""Lines that share the cases of slow tests: README's, that of the lowest versions, and `extras`."""


def pytest_collection_modifyitems(config, items):
    """Skip what needs an extra that is not installed, and mark what README's line does not run."""
    whole = {Path(path).name for path in config.args} == {"tests"}
    share = {item: k for item, k in shares(items) if whole}
    for item in items:
        extras = [extra for mark in item.iter_markers("extra") for extra in mark.args]
        for extra in filter(is_missing, extras):
            item.add_marker(pytest.mark.skip(reason=reason(extra)))
        last = share.get(item) == SHARES - 1
        if last or item.get_closest_marker("long") or not all(map(is_in_test, extras)):
            item.add_marker(pytest.mark.ci)
        if item in share and share[item] != config.getoption("--share"):
            item.add_marker(pytest.mark.long)


def shares(items):
    """Each case of a slow test that one line takes, and which.

    All take the first case of each value, where parameters have columns of their own.
    """
    of_test = defaultdict(list)
    for item in items:
        if item.get_closest_marker("shared") and not item.get_closest_marker("long"):
            of_test[item.nodeid.partition("[")[0]].append(item)
    for each in of_test.values():
        columns = set(zip(*(item.callspec.indices.values() for item in each), strict=True))
        seen = [set() for _ in columns]
        rest = []
        for item, *values in zip(each, *columns, strict=True):
            fresh = [value not in those for value, those in zip(values, seen, strict=True)]
            for value, those in zip(values, seen, strict=True):
                those.add(value)
            if len(columns) == 1 or not any(fresh):
                rest.append(item)
        yield from ((item, k % SHARES) for k, item in enumerate(rest))


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect the tests without a search for garbage: what is imported stays.

    The search would take a quarter of the time, in each worker. Nor do later searches, while tests
    run, look at what was there at the end of the collection.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def state_of_the_process():
    """What a test may change for those that come after it in the same process."""
    kinds = [getattr(resource, name) for name in dir(resource) if name.startswith("RLIMIT_")]
    limits = [resource.getrlimit(kind) for kind in kinds]
    of_python = sys.get_int_max_str_digits(), sys.getrecursionlimit()
    return os.getcwd(), limits, of_python, np.geterr(), np.get_printoptions()


@pytest.fixture(autouse=True, scope="module")
def nothing_stays_changed():
    """What the tests of a file change in their process ends with them."""
    environment = {**os.environ, "PYTEST_CURRENT_TEST": ""}
    state = state_of_the_process()
    yield
    assert environment.items() <= {**os.environ, "PYTEST_CURRENT_TEST": ""}.items()
    assert state_of_the_process() == state


@pytest.fixture
def rng():
    """Random numbers, the same in every run."""
    return np.random.default_rng(20231)


@pytest.fixture
def count(request):
    """How many random steps are taken."""
    return request.config.getoption("--count")


@pytest.fixture
def cli(capsys):
    """A command's ``out`` and ``err``, once it has ended with the exit status that is expected.

    Its words are given as in a shell, several in one text; a path is one word.
    """
    from quasistatic_ref.cli.main import main

    def printed(*parts, status=0):
        words = []
        for part in parts:
            words += shlex.split(part) if isinstance(part, str) else [str(part)]
        assert main(words) == status
        return capsys.readouterr()

    return printed


@pytest.fixture
def answers(monkeypatch):
    """A function that lets a backend reply as a test wants: ``answers("daqp", reply)``.

    ``reply(solver, own)`` returns or raises; ``own()`` is what the solver would have replied.
    """
    from tests.helpers import pinch
    from tests.solvers import solver_for

    def replying(name, reply):
        kind = type(solver_for(pinch(), name))
        own = kind.reply
        monkeypatch.setattr(kind, "reply", lambda s, *of: reply(s, partial(own, s, *of)))

    return replying


@pytest.fixture(scope="session")
def things(tmp_path_factory):
    """One of every kind of public data, by name."""
    from tests.step.public_data import public_data

    return public_data(tmp_path_factory.mktemp("scene"))


@pytest.fixture
def scene(tmp_path):
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    from tests.scenes import chain_scene

    return chain_scene(tmp_path)


@pytest.fixture
def q(scene, rng):
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))


@pytest.fixture
def load(tmp_path):
    """The scenario PUSH with some of its lines replaced."""
    from quasistatic_ref import load_scenario
    from tests.scenes import PUSH, written_scenario

    def loaded(*changes):
        text = PUSH
        for old, new in changes:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        return load_scenario(written_scenario(tmp_path, text), fast=True)

    return loaded
