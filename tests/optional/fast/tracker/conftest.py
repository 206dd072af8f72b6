"""Trees of several levels for few points."""

import pytest

from quasistatic_ref.optional.fast.tracker import ball_tree, tracker_bound


@pytest.fixture
def small_leaves(monkeypatch):
    """Two points in a ball, four balls on top; no more of them are opened than a list needs."""
    monkeypatch.setattr(ball_tree, "SMALL", 4)
    monkeypatch.setattr(ball_tree, "LEAF", 2)
    monkeypatch.setattr(tracker_bound, "BEAM", 1)
