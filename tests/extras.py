"""Tests that need an extra say so where they stand: ``@pytest.mark.extra("robots")``.

Where the extra is not installed they are skipped, and pytest's summary names it. Tests of which
there are many of one kind are marked as long: ``.ci/run`` takes them, README's line does not.
"""

import re
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution, requires

import pytest

from quasistatic_ref.files.resources import scenario_names
from tests.pages import PACKAGE

OF_EXTRA = re.compile(r"""([\w.-]+).*\bextra *== *['"]([\w-]+)['"]""")
"""A requirement of the package's metadata: the name of what is required, and the extra."""


@cache
def packages_of(extra):
    """The packages of an extra."""
    matches = filter(None, map(OF_EXTRA.match, requires("quasistatic-ref") or ()))
    packages = {match[1] for match in matches if match[2] == extra}
    assert packages, f"pyproject.toml declares no extra {extra}"
    return packages


@cache
def is_missing(extra):
    """Whether a package of an extra is not installed; of ``compiled``, whether C was not."""
    if extra == "compiled":
        return not_compiled() is not None
    return not all(map(_is_installed, packages_of(extra)))


def not_compiled():
    """Why no compiled code is used here, or None."""
    if not (PACKAGE / "optional" / "compiled").is_dir():
        return "the part is not there"
    from quasistatic_ref.optional.compiled.library import missing

    return missing()


def is_in_test(extra):
    """Whether README's line, which installs the extra ``test``, has an extra."""
    return extra == "compiled" or packages_of(extra) <= packages_of("test")


def _is_installed(package):
    try:
        distribution(package)
    except PackageNotFoundError:
        return False
    return True


def reason(extra):
    """What pytest's summary says of a test that is skipped."""
    if extra == "compiled":
        return f"needs compiled code: {not_compiled()}"
    return f'needs the extra {extra}: pip install -e ".[test,{extra}]"'


def marked_parameters(names, needs):
    """Parameters of a test; those that need an extra are marked with it."""
    return [
        pytest.param(name, marks=pytest.mark.extra(needs[name])) if name in needs else name
        for name in names
    ]


def marked_as_long(scripts, short):
    """Scripts as parameters of a test; README's line takes those that are named as short."""
    return [
        pytest.param(script, id=script.stem, marks=() if script.stem in short else pytest.mark.long)
        for script in scripts
    ]


SCENARIOS = marked_parameters(scenario_names(), {"allegro_turn": "robots", "panda_push": "robots"})
"""The scenarios that come along."""
SLOW = "allegro_turn"
"""A hand, each of whose steps takes a second."""
SCENARIOS_TO_RUN = [
    pytest.param(*each.values, marks=[*each.marks, pytest.mark.long])
    if SLOW in each.values
    else each
    for each in (one if hasattr(one, "marks") else pytest.param(one) for one in SCENARIOS)
]
"""Scenarios that a test runs: the slow one is long."""
