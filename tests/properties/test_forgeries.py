"""Whatever stands in a solution file is proved: every field of every kind is forged."""

import json
from collections import Counter
from dataclasses import fields, replace

import numpy as np
import pytest

from quasistatic_ref.certify.certificate import verify
from quasistatic_ref.certify.solution import Certificate
from quasistatic_ref.cli.solution_files import solution_read, solution_text
from quasistatic_ref.cli.verify import refutation
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID, cone
from quasistatic_ref.tolerances import ENCLOSED
from tests.helpers import pinch, point_on_floor
from tests.oracles import forgeries
from tests.oracles.forged_scenes import between_walls, scenes
from tests.oracles.forgeries import at_random, good_file, outcomes, refused
from tests.oracles.records import places
from tests.oracles.solution_truth import truth_of, wrenches

SCENES = scenes()
PROVES_NOTHING = ("none", "residual in the ellipsoid")
RANDOM = 40
"""Random forgeries of each file: 2 s in all."""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "solution.json"


def named(record):
    """The names of all fields that stand in a record."""
    return {".".join(k for k in where if isinstance(k, str)) for where in places(record)}


@pytest.mark.parametrize(("kind", "name"), dict(SCENES.keys()).items())  # one of each kind
def test_no_false_file_passes(path, kind, name):
    step = SCENES[kind, name]
    good = good_file(step, kind)
    assert refused(step, good, path) == (kind in PROVES_NOTHING)
    counts = {}
    for field, said, forged in outcomes(step, good, path):
        assert said != "PASSED", (field, forged)
        counts.setdefault(field, Counter())[said] += 1
    assert counts.keys() >= named(good)
    assert all(said["refused"] for said in counts.values())
    freely = {field for field, said in counts.items() if said["still true"]}
    allowed = {"delta_q", "lam", "lam and wrench", "certificate.error_bound", "certificate.gap"}
    assert freely <= ({"farkas"} if kind == "infeasible" else allowed)
    if kind == "exact":
        assert not freely


@pytest.mark.parametrize(("kind", "name"), SCENES)
def test_no_random_forgery_passes(path, kind, name):
    step = SCENES[kind, name]
    good = good_file(step, kind)
    rng, truth, tried = np.random.default_rng(1), truth_of(step, good), 0
    for forged in (at_random(rng, step, good) for _ in range(RANDOM)):
        tried += forged != good
        assert refused(step, forged, path) or truth(forged), forged
    assert tried > RANDOM / 2


def test_every_kind_and_every_claim_of_a_certificate_is_forged():
    """A kind without a scene, or a claim that is in no kind of file, would not be attacked."""
    in_files = {"kind"}
    for name, label in ((PYRAMID, ""), (ELLIPSOID, " in the ellipsoid")):
        for kind, names in cone(name).claims.items():
            short = kind in ("none", "enclosure")
            assert any(kind + label * (not short) == scene for scene, _ in SCENES), (kind, name)
            in_files |= set(names)
    in_memory = {"residuals", "step"}
    assert in_files | in_memory == {field.name for field in fields(Certificate)}


def test_the_forger_notices_a_verification_that_believes_everything(monkeypatch, path):
    step = SCENES["exact", "touches, but bears nothing"]
    good = good_file(step, "exact")
    monkeypatch.setattr(forgeries, "refutation", lambda *_: None)
    said = Counter(said for _, said, _ in outcomes(step, good, path))
    assert said["PASSED"] > 50


def forged(step, path, **changes):
    """What is wrong with a true solution of a step in which some fields are changed."""
    record = json.loads(solution_text(solve_step(step)))
    certificate = record["certificate"]
    for name, value in changes.items():
        (certificate if name in certificate else record)[name] = value
    path.write_text(json.dumps(record))
    return refutation(step, solution_read(path, step))


def test_a_force_between_walls_that_nothing_touches_is_refused(path):
    """1,000 N on both walls, 1 m away: balanced, in their cones, and at work over 1 m each."""
    step = between_walls()
    record = json.loads(solution_text(solve_step(step)))
    assert forged(step, path) is None
    lam = record["lam"]
    for wall in (1, 2):
        lam[wall][0] += 1000.0 * step.h
    both = {"lam": lam, "wrench": wrenches(step, lam)}
    for gap in (record["certificate"]["gap"], 1e9):
        for error in (record["certificate"]["error_bound"], 1e9):
            reason = forged(step, path, **both, gap=gap, error_bound=error)
            assert "error_bound is 1" in reason or "presses where nothing touches" in reason


PINCH, SLIDE = pinch(grip=5.0, offset=0.02), point_on_floor(force=(4.0, 1.0, -2.943))
CLAIMS = [
    *((SLIDE, ELLIPSOID, "error_bound", bound) for bound in (1e9, 2 * ENCLOSED, -1.0, 0.0)),
    *((PINCH, cone, "error_bound", bound) for cone in (PYRAMID, ELLIPSOID)
      for bound in (-1.0, 5e-324, -0.0)),
    (PINCH, ELLIPSOID, "multipliers_unique", True),
    (PINCH, ELLIPSOID, "differentiable", True),
    (PINCH, ELLIPSOID, "smallest_inactive_slack", 0.0),
    (PINCH, ELLIPSOID, "smallest_active_multiplier", 1.0),
    (PINCH, ELLIPSOID, "residuals", {}),
    (PINCH, ELLIPSOID, "active", [[0, 0]]),
]  # fmt: skip
"""Of an enclosure, another bound than its own; of an exact answer, any error; what the ellipsoid
does not prove, and other rows than those of the loaded contacts."""


@pytest.mark.parametrize(("step", "cone", "claim", "value"), CLAIMS)
def test_a_claim_that_is_not_proved_is_refused(path, step, cone, claim, value):
    posed = step.replace(cone=cone)
    record = json.loads(solution_text(solve_step(posed)))
    assert not refused(posed, record, path)
    record["certificate"][claim] = value
    assert refused(posed, record, path)


def test_verify_in_python_holds_an_uncertified_answer_to_its_bound():
    """The bound that comes with an answer holds; a tenth of a correct one does not."""
    step = SCENES["residual", "slides"]
    answer = solve_step(step, certify="residual")
    lam = np.maximum(np.concatenate([answer.lam, answer.lam_extra]), 0.0)
    claims = answer.certificate
    assert verify(step, answer.delta_q, (), lam, claims)
    short = replace(claims, error_bound=claims.error_bound * 1e-3)
    assert "the error is larger" in verify(step, answer.delta_q, (), lam, short).reason
    wide = replace(claims, error_bound=1.5)
    assert "from 0 to 1" in verify(step, answer.delta_q, (), lam, wide).reason
    assert "negative" in verify(step, answer.delta_q, (), lam - 1e-3, claims).reason
