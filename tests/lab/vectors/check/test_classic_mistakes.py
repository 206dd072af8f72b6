"""The page's classic mistakes: the plain program with each of them is found, by field.

The plain program itself passes: ``test_plain_program``.
"""

import functools
import importlib
import re
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import pytest

from quasistatic_ref.lab import program
from quasistatic_ref.lab.program.layers import LAYERS, TO_SIX_DIGITS, plain
from quasistatic_ref.lab.vectors.challenge.fresh import CHALLENGED
from quasistatic_ref.lab.vectors.challenge.run import challenge
from tests.lab.vectors.committed_cases import ROOT, by_size, verdict_on

PAGE = ROOT / "docs" / "guides" / "check_your_implementation.md"
ROW = re.compile(r"^\| (`.+?) \| (.+?) \| .+ \|$", re.MULTILINE)
NAME = re.compile(r"`(\w+)`")

MISTAKES = tomllib.loads(Path(__file__).with_name("mistakes.toml").read_text("utf-8"))
EVERY = [(name, *change) for name, one in MISTAKES.items() for change in one["changes"]]
OF_THE_PAGE = [one for one in EVERY if one[0] != "on no page"]
CHALLENGES = [
    one for one in EVERY if one[1] in CHALLENGED and "in_files_alone" not in MISTAKES[one[0]]
]


@functools.cache
def written_wrong(file, right, wrong):
    """The layers of a copy of the plain program in which one formula is another."""
    folder = Path(tempfile.mkdtemp())
    name = f"wrong_{folder.name}"
    shutil.copytree(Path(program.__file__).parent, folder / name)
    path = folder / name / file
    text = path.read_text("utf-8")
    assert text.count(right) == 1
    path.write_text(text.replace(right, wrong), "utf-8")
    sys.path.insert(0, str(folder))
    try:
        module = importlib.import_module(f"{name}.layers")
    finally:
        sys.path.remove(str(folder))
        shutil.rmtree(folder)
    return module.LAYERS | module.TO_SIX_DIGITS


def wrong_field(layers, layer, case, digits):
    """The first field of an answer to a committed case that is not right to so many digits."""
    return verdict_on(case.id, plain(layers[layer](case.input)), digits).field


def test_the_mistakes_are_those_of_the_page():
    _, _, section = PAGE.read_text("utf-8").partition("## Classic mistakes")
    table, _, _ = section.partition("\n## ")
    layers_of = {mistake: set(NAME.findall(layers)) for layers, mistake in ROW.findall(table)}
    names = {name for name, *_ in OF_THE_PAGE}
    assert layers_of == {n: {layer for layer, *_ in MISTAKES[n]["changes"]} for n in names}


@pytest.mark.shared
@pytest.mark.parametrize(("name", "layer", "field", "file", "right", "wrong"), OF_THE_PAGE)
def test_a_committed_case_finds_each_mistake_and_passes_without_it(
    name, layer, field, file, right, wrong
):
    digits = None if "all_digits" in MISTAKES[name] else 6
    layers = written_wrong(file, right, wrong)
    found = next(
        case for case in by_size(layer) if wrong_field(layers, layer, case, digits) == field
    )
    assert not wrong_field(LAYERS | TO_SIX_DIGITS, layer, found, digits)


@pytest.mark.long  # up to half a minute each
@pytest.mark.parametrize(("name", "layer", "field", "file", "right", "wrong"), CHALLENGES)
def test_a_challenge_finds_each_mistake(name, layer, field, file, right, wrong):
    layers = written_wrong(file, right, wrong)
    found = challenge(lambda _, case: layers[layer](case), layers=[layer], cases=500)
    assert found.findings[0].field in (field, MISTAKES[name].get("earlier"))
