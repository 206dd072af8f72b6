"""Scenes, each with what is right by hand, and nothing else is said of it (cases/*.toml)."""

import pytest

from quasistatic_ref import RunFailed
from tests.optional.doctor.case_scenes import HERE, ROWS, made
from tests.optional.doctor.mistake_scenes import GRAVE

CASES = [
    pytest.param(case, id=case["what"], marks=pytest.mark.long if "long" in case else ())
    for case in ROWS
]
FALLS = {"free-fall", "lost-grip", "unsupported-body", "locked-guide"}
"""Findings on what does not stand, or may fall by one of several solutions of Coulomb's law."""


@pytest.fixture(autouse=True)
def in_the_folder(monkeypatch):
    """Files of a case are beside it."""
    monkeypatch.chdir(HERE)


def found(scenario):
    """What is found of a run, though it may end early."""
    try:
        return scenario.run(progress=False).findings
    except RunFailed as failure:
        return failure.trajectory.findings


@pytest.mark.parametrize("case", CASES)
def test_what_is_said_is_right_by_hand(case):
    """A remedy that is applied ends what asked for it."""
    scenario, hand = made(case), case["hand"]
    findings = scenario.findings() if "before" in case else found(scenario)
    said = {one.name: one for one in findings}
    assert said.keys() == hand.keys()
    for one in findings:
        assert GRAVE[one.name] in (None, one.grave)
        assert one.sentence.startswith(one.cause)
    for name, numbers in hand.items():
        for key, value in numbers.items():
            if key == "each":  # words of each sentence
                sentences = [one.sentence for one in findings if one.name == name]
                assert len(sentences) == len(value)
                lacking = [word for word in value if not any(word in each for each in sentences)]
                assert not lacking, f"{lacking} are not in {sentences}"
            elif isinstance(value, str):  # words of the cause, or of the remedy
                texts = [getattr(one, key) for one in findings if one.name == name]
                assert [text for text in texts if value in text], f"not in the {key} of {texts}"
            else:
                number, off = value
                right = pytest.approx(number, rel=off, abs=0.0 if number else off)
                assert abs(said[name].numbers[key]) == right
    for remedy, changes in case.get("after", {}).items():
        mended = {one.name for one in findings if one.remedy == remedy}
        assert mended
        assert mended.isdisjoint(one.name for one in found(made(case, changes)))


def standings(scenario, run, step):
    """What stands after a step of a run, or where it starts."""
    if step is not None:
        return run.stands(step, scenario)
    q = scenario.system.q_start
    force = None if scenario.force is None else scenario.force(0.0, q)
    return scenario.simulator().stands(q, scenario.targets(0.0), force)


@pytest.mark.parametrize(
    "case", [one for one in CASES if {"before", "mjcf"}.isdisjoint(one.values[0])]
)
def test_what_does_not_stand_lacks_what_is_right_by_hand(case):
    """`why` derives numbers that a row's name does not say. Others stand in the end, or fall."""
    scenario = made(case)
    try:
        run = scenario.run(progress=False, findings=False)
    except RunFailed as failure:
        run = failure.trajectory
    if "stands" not in case and run.steps and FALLS.isdisjoint(case["hand"]):
        assert False not in {row.stands for row in run.stands(run.steps - 1, scenario)}
    for body, hand in case.get("stands", {}).items():
        row = standings(scenario, run, hand.get("step"))[body]
        assert row.stands is False
        for key in ("missing_N", "missing_Nm"):
            value, off = hand.get(key, (0.0, 0.0))
            if "missing_N" in hand or "missing_Nm" in hand:
                assert getattr(row, key) == pytest.approx(value, rel=off, abs=1e-9)


@pytest.mark.parametrize("what", ["a rod slips", "a cube that a finger pushes at 0.1"])
def test_findings_do_not_depend_on_the_backend(what):
    """Contacts share loads in many ways, and backends differ in theirs."""
    (case,) = [case for case in ROWS if case["what"].startswith(what)]
    run = made(case).run(progress=False)
    for backend in ("clarabel", "osqp", "none"):
        proved = made(case, fast=False, solver={"backend": backend})
        other = proved.run(progress=False)
        assert other.header.not_looked_at == run.header.not_looked_at == ""
        said = {one.name: one for one in other.findings}
        assert said.keys() == case["hand"].keys()
        for one in run.findings:
            assert said[one.name].numbers == pytest.approx(one.numbers, rel=1e-6, abs=1e-6)
