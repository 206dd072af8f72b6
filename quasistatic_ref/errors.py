"""Everything that can go wrong, under one root.

Two families matter to a caller: :class:`InputError` (an input is not usable; exit status 2) and
:class:`~quasistatic_ref.certify.failures.StepNotSolved` (a well-formed step got no trustworthy
answer; exit status 3). Each message is one plain sentence; each object carries the data behind it.
An error that carries a thing of a folder stands in that folder.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from inspect import signature
from os import PathLike, fspath
from types import UnionType
from typing import ParamSpec, TypeVar

from quasistatic_ref.quoting import (
    clipped,
    one_line,
    short_words,
    shown_value,
    suggestion,
)

P = ParamSpec("P")
R = TypeVar("R")


class QuasistaticError(Exception):
    """Root of every error that this package raises on purpose.

    Examples
    --------
    >>> try:
    ...     qr.load_scenario("no_such_scene")
    ... except qr.QuasistaticError as error:
    ...     print(type(error).__name__)
    ScenarioError
    """

    def __str__(self) -> str:
        return one_line(short_words(super().__str__()))

    def __reduce__(self) -> tuple[object, ...]:
        # Exceptions are rebuilt from `args`, which here hold the message only.
        return _rebuilt, (type(self), self.args, self.__dict__)


class InputError(QuasistaticError, ValueError):
    """Something given by the user cannot be used; a ValueError.

    Parameters
    ----------
    problem : str
        What is wrong and what would be right, as the end of a sentence.
    field : str, optional
        Name of the offending field, e.g. ``contacts.grip.mu_v``.
    value : object, optional
        The offending value.
    file : str or Path, optional
        The file that it stands in.

    Attributes
    ----------
    change : str or None
        Where the value is written, if that is no file: ``--set h=-1`` on the command line, and in
        Python the field. The message then begins with it, in the place of file and field.

    Examples
    --------
    >>> try:
    ...     qr.Sphere(-0.01)
    ... except qr.InputError as error:
    ...     print(error)
    radius: must be a positive length (got -0.01)
    """

    def __init__(
        self,
        problem: str,
        *,
        field: str | None = None,
        value: object = None,
        file: str | PathLike[str] | None = None,
    ) -> None:
        self.problem = problem
        self.field = field
        self.value = value
        self.file = file
        self.change: str | None = None
        super().__init__(problem)

    def __str__(self) -> str:
        where = f"{clipped(fspath(self.file))}: " if self.file is not None else ""
        what = f"{clipped(self.field)}: " if self.field is not None else ""
        got = f" (got {shown_value(self.value)})" if self.value is not None else ""
        if self.change is not None:
            where = f"{clipped(self.change)}: "
            if self.change != self.field:  # it shows the value
                got = ""
            what = ""
        return one_line(f"{where}{what}{short_words(self.problem)}{got}")

    def in_file(self, file: str | PathLike[str]) -> InputError:
        """The same error, saying which file it is about (unless another place is named)."""
        if self.file is None and self.change is None:
            self.file = file
        return self


class MissingKey(InputError, KeyError):
    """A key in square brackets, as in ``trajectory["q"]``, does not exist; a KeyError.

    Examples
    --------
    >>> run = qr.load_scenario("sphere_spin", steps=1).run(progress=False)
    >>> try:
    ...     run["phy"]
    ... except KeyError as error:
    ...     print(error)
    phy: is not an array of this trajectory; did you mean 'phi'?
    """


class StepDataError(InputError):
    """The numbers of a step are not usable: wrong shape, not finite, H not positive definite.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> try:
    ...     step.replace(h=-0.02)
    ... except qr.StepDataError as error:
    ...     print(error)
    h: must be a positive number of seconds (got -0.02)
    """


class ModelError(InputError):
    """A model is not usable: its file, or a body, shape, coordinate or joint of it.

    Examples
    --------
    >>> try:
    ...     qr.Sphere(-0.01)
    ... except qr.ModelError as error:
    ...     print(error)
    radius: must be a positive length (got -0.01)
    """


class ContactError(InputError):
    """A contact pair is not usable, or its distance has no trustworthy normal.

    Examples
    --------
    >>> ball = qr.PlacedShape("ball", link=0, R=np.eye(3), t=np.zeros(3), shape=qr.Sphere(0.05))
    >>> try:
    ...     qr.ContactPair("twice", ball, ball, mu_v=0.3, mu_omega=0.0, rows=4, k=1)
    ... except qr.ContactError as error:
    ...     print(error)
    twice: both shapes are fixed to the same link; leave the pair out
    """


class ScenarioError(InputError):
    """A scenario contradicts itself or names something that does not exist.

    Examples
    --------
    >>> try:
    ...     qr.load_scenario("sphere_spin", {"contacts.floor.mu_w": 0})
    ... except qr.ScenarioError as error:
    ...     print(error.field)
    contacts.floor.mu_w
    """


class BackendError(InputError):
    """The solver is unknown or not installed, or does not support what a call needs.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> try:
    ...     qr.solve_step(step, "clarabell")
    ... except qr.BackendError as error:
    ...     print(error.field, error.value)
    backend clarabell
    """


@contextmanager
def about_file(file: str | PathLike[str]) -> Iterator[None]:
    """Make an InputError of this block say which file it is about, unless it says so already."""
    check_kind(file, str | PathLike, "path", "a path")
    try:
        yield
    except InputError as error:
        raise error.in_file(file) from None


@contextmanager
def about_field(field: str) -> Iterator[None]:
    """Make an InputError of this block name that field of a file, and not what it was read into."""
    try:
        yield
    except InputError as error:
        error.field = field
        raise


def keywords_named(function: Callable[P, R], **remedies: str) -> Callable[P, R]:
    """The same function, which answers a wrong keyword with the right one: InputError.

    `remedies` are words for keywords of which no other is near.
    """
    known = [word for word in signature(function).parameters if word != "self"]
    name = function.__qualname__.removesuffix(".__init__")

    @wraps(function)
    def answering(*args: P.args, **kwargs: P.kwargs) -> R:
        for word, value in kwargs.items():
            if word not in known:
                hint = f"; {remedies[word]}" if word in remedies else suggestion(word, known)
                raise InputError(f"is no argument of {name}{hint}", field=word, value=value)
        return function(*args, **kwargs)

    return answering


def fields_named(**remedies: str) -> Callable[[type[R]], type[R]]:
    """Have a dataclass answer a wrong keyword as :func:`keywords_named` does."""

    def answering(kind: type[R]) -> type[R]:
        constructor = "__init__"
        setattr(kind, constructor, keywords_named(getattr(kind, constructor), **remedies))
        return kind

    return answering


def check_kind(
    value: object,
    kinds: type | UnionType,
    field: str,
    wanted: str,
    error: type[InputError] = InputError,
) -> None:
    """Refuse an argument of another type: an InputError, which says what is `wanted`."""
    if not isinstance(value, kinds):
        raise error(f"must be {wanted}", field=field, value=type(value).__name__)


def _rebuilt(
    kind: type[QuasistaticError], args: tuple[object, ...], state: dict[str, object]
) -> QuasistaticError:
    error = kind.__new__(kind, *args)
    error.args = args
    error.__dict__.update(state)
    return error
