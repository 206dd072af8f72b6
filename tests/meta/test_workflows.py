"""Workflows name actions by their hashes, and leave no credentials behind."""

import re

import pytest
import yaml

from tests.pages import ROOT

HASH = re.compile(r"@[0-9a-f]{40}$")
FILES = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


@pytest.fixture(scope="module", params=FILES, ids=lambda file: file.stem)
def jobs(request):
    """Jobs of a workflow."""
    return yaml.safe_load(request.param.read_text("utf-8"))["jobs"].values()


def test_actions_are_named_by_hash_and_checkouts_keep_no_credentials(jobs):
    used = [step for job in jobs for step in job["steps"] if "uses" in step]
    assert [step["uses"] for step in used if not HASH.search(step["uses"])] == []
    checkouts = [step for step in used if step["uses"].startswith("actions/checkout@")]
    assert checkouts
    assert {step["with"]["persist-credentials"] for step in checkouts} == {False}
