"""Mutants tried by tests that are collected once: a fork of this process for each mutant.

Of the tests, a mutant meets those that run a function it changes, which was seen by running each
test once in a fork of its own. Those that have noticed a mutant of the same function come first,
then the quickest.
"""

from __future__ import annotations

import ast
import gc
import importlib
import json
import signal
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from tqdm import tqdm

from quasistatic_ref.formats.files import text_written
from validation.tools.mutating.forks import Job, forked, more_time
from validation.tools.mutating.mutants import Mutant
from validation.tools.mutating.swapped import (
    changed_functions,
    forget_results,
    function_name,
    living_functions,
    swap,
)

PATIENCE = 4.0
"""A test hangs that takes so many times as long as without the mutant, and three seconds more."""
OWN, OTHERS = 20.0, 3.0
"""Seconds of tests that one mutant meets, of its own files and of others, as long as they take when
they are traced: about three times as long as otherwise. The slowest are left out."""
NOTICED = {int(signal.SIGXCPU): "hangs", int(signal.SIGALRM): "hangs"}
"""What a signal that ended the tests says of the mutant; any other signal: it is broken."""


@dataclass(frozen=True)
class Touch:
    """What one test does without a mutant: the functions it runs, its seconds, and if it passes."""

    functions: frozenset[tuple[str, str]]
    seconds: float
    passed: bool

    @classmethod
    def of(cls, said: dict[str, Any] | int) -> Touch:
        """What a fork says, which a signal may have ended."""
        if isinstance(said, int):
            return cls(frozenset(), 0.0, passed=False)
        functions = frozenset((path, name) for path, name in said["functions"])
        return cls(functions, said["seconds"], said["passed"])


class Trials:
    """A plugin of pytest that tries mutants where pytest would run its tests.

    Parameters
    ----------
    package : Path
    chosen : mutants to try
    own : for each file of the package, the tests that are to notice its mutants
    heard : called with each mutant and what the tests say of it, or None if it changes more than
        functions
    traced : file that keeps what each test runs, for the same command to go on from
    workers : how many processes at a time
    """

    def __init__(
        self,
        package: Path,
        chosen: Iterable[Mutant],
        own: Mapping[str, tuple[str, ...]],
        heard: Callable[[Mutant, str | None], None],
        traced: Path | None = None,
        workers: int = 2,
    ) -> None:
        self.package, self.chosen, self.own = package, list(chosen), own
        self.heard, self.traced, self.workers = heard, traced, workers
        self.sources: dict[str, str] = {}
        self.noticed: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
        self.touches: dict[str, Touch] = {}
        self.failed = False

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Remember a failure, in the fork that it happens in."""
        self.failed |= report.failed

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try every mutant; the tests themselves are run in forks only."""
        if session.testsfailed:
            raise session.Interrupted("the tests cannot be collected")
        reporter = session.config.pluginmanager.getplugin("terminalreporter")
        session.config.pluginmanager.unregister(reporter)  # of thousands of runs
        self.items = {item.nodeid: item for item in session.items}
        self._make_plain()
        self.touches = {test: Touch.of(said) for test, said in self._traces().items()}
        failing = [test for test, touch in self.touches.items() if not touch.passed]
        if failing:
            raise session.Interrupted(f"{', '.join(failing)} fail without a mutant")
        for (mutant, functions), said in forked(self._jobs(), self.workers):
            if isinstance(said, int):
                self.heard(mutant, NOTICED.get(said, "broken"))
                continue
            for function in functions if said else ():
                noticed = self.noticed[function]
                noticed[:] = [said, *(test for test in noticed if test != said)]
            self.heard(mutant, "killed" if said else "survived")
        return True

    def _make_plain(self) -> None:
        """Give the functions the code of their files' plain text, from which a mutant differs once.

        The tests then pass with it, which shows that to swap code changes nothing else. A file that
        is imported only where it is used has functions from here on, too: a fork would import it
        without its mutant.
        """
        for file in {mutant.file for mutant in self.chosen}:
            parts = Path(file).with_suffix("").parts
            importlib.import_module(".".join((self.package.name, *parts)))
        self.living = living_functions(str(self.package))
        for file in {mutant.file for mutant in self.chosen}:
            path, source = str(self.package / file), (self.package / file).read_text()
            self.sources[file] = ast.unparse(ast.parse(source))
            swap(self.living[path], path, source, self.sources[file])
        gc.freeze()  # or each fork copies every page that its collector visits

    def _traces(self) -> dict[str, Any]:
        """Each test run once, in a fork of its own, so that no other has filled a cache for it.

        What stands in the file `traced` is taken from there, if it has all of these tests.
        """
        if self.traced is not None and self.traced.exists():
            kept: dict[str, Any] = json.loads(self.traced.read_text())
            if kept.keys() >= self.items.keys():
                return {test: kept[test] for test in self.items}
        jobs = [(test, self._touching(test)) for test in self.items]
        said = dict(tqdm(forked(jobs, self.workers), "tests", len(jobs)))
        if self.traced is not None:
            text_written(self.traced, json.dumps(said))
        return said

    def _touching(self, test: str) -> Job:
        def job() -> dict[str, Any]:
            forget_results()
            seen: set[tuple[str, str]] = set()
            root = str(self.package)

            def called(frame: FrameType, _event: str, _arg: object) -> None:
                if frame.f_code.co_filename.startswith(root):
                    seen.add((frame.f_code.co_filename, function_name(frame.f_code)))

            sys.settrace(called)
            threading.settrace(called)
            passed = not self._failing([test])
            sys.settrace(None)
            return {"functions": sorted(seen), "seconds": time.process_time(), "passed": passed}

        return job

    def _jobs(self) -> Iterator[tuple[tuple[Mutant, list[tuple[str, str]]], Job]]:
        """A job for each mutant, made when it is its turn: the tests before it have an order."""
        for mutant in self.chosen:
            path = str(self.package / mutant.file)
            names = changed_functions(path, self.sources[mutant.file], mutant)
            if names is None:
                self.heard(mutant, None)
                continue
            functions = [(path, name) for name in sorted(names)]
            yield (mutant, functions), self._trying(mutant, path, self._order(mutant, functions))

    def _order(self, mutant: Mutant, functions: list[tuple[str, str]]) -> list[str]:
        """The tests that a mutant meets."""
        meets = {t for t, touch in self.touches.items() if touch.functions.intersection(functions)}
        by_time = sorted(meets, key=lambda test: self.touches[test].seconds)
        own = tuple(f"tests/{test}::" for test in self.own[mutant.file])
        before = [t for f in functions for t in self.noticed[f] if t in meets][:3]
        mine = self._quickest([test for test in by_time if test.startswith(own)], OWN)
        others = self._quickest([test for test in by_time if not test.startswith(own)], OTHERS)
        return list(dict.fromkeys([*before, *mine, *others]))

    def _quickest(self, tests: list[str], seconds: float) -> list[str]:
        """As many tests, from the first on, as take so long."""
        ends = accumulate(self.touches[test].seconds for test in tests)
        return [test for test, end in zip(tests, ends, strict=True) if end < seconds]

    def _trying(self, mutant: Mutant, path: str, tests: list[str]) -> Job:
        def job() -> str:
            forget_results()
            swap(self.living[path], path, self.sources[mutant.file], mutant.source)
            return self._failing(tests)

        return job

    def _failing(self, tests: Sequence[str]) -> str:
        """The first test that fails in this process, or ""."""
        items = [self.items[test] for test in tests]
        # No test at all may run a function: nothing then fails.
        for item, after in zip(items, [*items, None][1:], strict=True):
            if item.nodeid in self.touches:
                more_time(3 + PATIENCE * self.touches[item.nodeid].seconds)
            self.failed = False
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
            if self.failed:
                return item.nodeid
        return ""
