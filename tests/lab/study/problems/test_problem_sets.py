"""The sets that ship: their files, their answers by other arithmetic, and what is refused."""

import json
import re
import shutil
from dataclasses import replace
from fractions import Fraction
from hashlib import sha256
from itertools import islice

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.certify.norm import error_length
from quasistatic_ref.lab.study.problems import folder
from quasistatic_ref.lab.study.problems.checking import refutation
from tests.lab.study.asked import FACTS, NUMBERS, contact_qp_folder, manifest, set_read
from tests.oracles.rational_kkt import exact
from tests.oracles.rational_kkt import refutation as refuted_answer
from tests.tolerances import ROUNDING
from validation import check_solution as checker

FOLDER = contact_qp_folder()
PROVED = [name for name in manifest(FOLDER)["families"] if name != "sparse"]
LARGEST = 110
"""Coordinates of a problem that is proved in fractions, at most: a minute."""


def test_the_numbers_of_the_set_are_those_that_were_published():
    """Of the numbers of its two editions; the lines have a length since."""
    files = {
        one["path"]: one["sha256"] for one in manifest(FOLDER)["files"] if one["path"] != FACTS
    }
    digest = sha256(json.dumps(files, sort_keys=True).encode()).hexdigest()
    assert digest == "b1d226f79b43c91baffa80fb8083ec4efa8fd1b57e8f3b152d92954f415d7768"
    assert manifest(FOLDER)["count"] == 1510
    assert len(files) == 20


def test_every_problem_has_its_length(members):
    """The largest of the three lengths that are known of a problem of no step."""
    for one in members[::31]:
        x = np.zeros(len(one.g)) if one.answer.farkas else one.answer.x
        wanted = error_length(one.H.toarray(), one.g, x)
        assert one.error_length == one.facts["length"] == pytest.approx(wanted, rel=ROUNDING)
        assert one.natural.error_length == one.error_length / one.units.size


@pytest.mark.parametrize("kind", ["exact", "enclosed", "infeasible"])
def test_an_answer_that_was_changed_is_refuted(members, kind):
    def of_kind(one):
        return kind == ("infeasible" if one.answer.farkas else one.answer.kind)

    one = next(one for one in members if of_kind(one))
    if kind == "infeasible":
        some = dict(one.answer.farkas)
        first = next(iter(some))
        some[first] = str(Fraction(some[first]) * (1 + Fraction(1, 2**60)))
        changed = replace(one.answer, farkas=some)
    else:
        off = {"exact": 2e-16, "enclosed": 1e-12}[kind]
        changed = replace(one.answer, x=one.answer.x * (1 + off))
    assert refutation(one) is None
    assert refutation(replace(one, answer=changed)) is not None


def test_the_command_proves_answers_again_and_names_a_changed_one(members, monkeypatch, cli):
    right = next(one for one in members if one.answer.kind == "exact" and not one.answer.farkas)
    wrong = replace(right, answer=replace(right.answer, x=right.answer.x * (1 + 2e-16)))
    for one, refuted in ((right, 0), (wrong, 1)):
        monkeypatch.setattr(folder, "set_read", lambda *_, one=one: [one])
        said = cli("study problems check --exact --quiet", status=refuted)
        assert f"{1 - refuted} answers proved again, {refuted} refuted" in said.out
        assert (right.id in said.err) == bool(refuted)


def test_a_set_whose_numbers_were_changed_is_refused(tmp_path):
    shutil.copytree(FOLDER, tmp_path / "set")
    path = tmp_path / "set" / NUMBERS / "limits.npz"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))
    with pytest.raises(InputError, match=r"limits.npz.*changed|changed"):
        set_read(tmp_path / "set")
    with pytest.raises(InputError, match="holds no set of problems"):
        set_read(tmp_path)


def test_a_problem_that_is_not_there_is_refused(tmp_path, cli):
    export = "study problems export --out", tmp_path
    for more, words in (
        ("--id wedge/9/9", "holds no problem"),
        ("--every 0", "must be at least 1"),
        ("--families limits --tag nothing", "holds no problem"),
    ):
        assert words in cli(*export, more, status=2).err
    assert "is neither a folder" in cli("study problems list contact-qp-3", status=2).err


def test_the_family_whose_answers_are_not_proved_is_data_alone(members, cli):
    """Its 24 lines and numbers are read by the README's reader; the package reads the others."""
    families = {one.facts["family"] for one in members}
    assert families == {*PROVED}
    assert len(members) == 1510 - 24
    walls = [facts["answer"]["kind"] for facts, _ in readme_reader()(FOLDER, "sparse")]
    assert walls == ["bounded"] * 24
    export = "study problems export --families sparse"
    assert "is not a family with proved answers" in cli(export, status=2).err


@pytest.mark.parametrize("family", PROVED)
def test_answers_are_proved_both_ways(members, family, count):
    """A problem of each family for every 40 of ``--count``; in fractions where there is time.

    They begin with the second, whose numbers are read from behind those of the first.
    """
    most = max(1, count // 40)
    own = [one for one in members if one.facts["family"] == family][1 : 1 + most]
    assert [refutation(one) for one in own] == [None] * len(own)
    read = list(islice(readme_reader()(FOLDER, family), 1, 1 + most))
    small = [one for one in read if one[0]["n"] <= LARGEST and one[0]["answer"]["kind"] == "exact"]
    assert [refuted_in_fractions(*one) for one in small] == [None] * len(small)


def readme_reader():
    """The function ``problems(folder, family)`` of the set's README, without the package."""
    page = (FOLDER / "README.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    names = {}
    exec(code, names)
    return names["problems"]


def refuted_in_fractions(facts, numbers):
    """Why an answer is wrong; None if it is proved in Python's integers."""
    A, b = numbers["A"].toarray(), numbers["b"]
    if facts["farkas"]:
        y = [facts["farkas"].get(str(i), "0") for i in range(len(b))]
        proved = checker.infeasible(exact(A).tolist(), exact(b).tolist(), y)
        return None if proved else "its rows have a solution"
    claims = {name: numbers[name] for name in ("lam", "x", "net", "slack")}
    return refuted_answer(numbers["H"].toarray(), numbers["g"], A, b, **claims)
