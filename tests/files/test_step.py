"""Steps and solutions as JSON: bit for bit, every unknown or missing field refused by name."""

import hashlib

import numpy as np

from quasistatic_ref import Extra, load_step, save_step
from tests.cases import cases
from tests.helpers import point_on_floor, random_step
from tests.made import no_contacts, step_sha256, step_text

RNG = np.random.default_rng(11)
PLAIN = random_step(RNG, n_a=2, n_u=3, rows=(6, 4))
EXTRA = Extra(("limit", "wall"), RNG.normal(size=(2, 5)), RNG.normal(size=2))
STEPS = {
    "plain": PLAIN,
    "with rows of one's own": PLAIN.replace(extra=EXTRA),
    "without contacts": PLAIN.replace(contacts=no_contacts(5)),
    "nothing actuated": point_on_floor(),
    "everything actuated": random_step(RNG, n_a=3, n_u=0, rows=(4,)),
}


@cases("step", STEPS)
def test_a_step_read_back_is_the_same_bits(tmp_path, step):
    path = save_step(tmp_path / "step.json", step)
    back = load_step(path)
    assert back == step
    assert step_text(back) == step_text(step) == path.read_text()
    assert step_sha256(back) == step_sha256(step)


BY_HAND = (
    '{"format": "quasistatic-ref/step", "version": 1, "cone": "pyramid", "h": 0.01, "n_a": 0, '
    '"n_u": 3, "K_q": [], "M_u": [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3]], '
    '"tau_a": [], "tau_u": [0.5, 0.0, -2.0], "delta_q_bar_a": [], "contacts": [{"name": "c0", '
    '"phi": 0.001, "n": [0.0, 0.0, 1.0], "d1": [1.0, 0.0, 0.0], "d2": [0.0, 1.0, 0.0], '
    '"J": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]], "mu_v": 0.5, '
    '"mu_omega": 0.0, "rows": 4}]}\n'
)


def test_a_step_is_written_as_by_hand_and_hashed_by_its_text():
    step = point_on_floor(m=0.3, phi=0.001, force=(0.5, 0.0, -2.0))
    assert step_text(step) == BY_HAND
    assert step_sha256(step) == hashlib.sha256(BY_HAND.encode()).hexdigest()


def test_cone_and_extra_may_be_left_out(tmp_path):
    path = tmp_path / "step.json"
    path.write_text(step_text(PLAIN).replace('"cone": "pyramid", ', ""))
    assert "cone" not in path.read_text()
    assert load_step(path) == PLAIN
