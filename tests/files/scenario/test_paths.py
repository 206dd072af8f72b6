"""``package://NAME/PATH`` in a scenario: a file of an installed package, or a plain refusal."""

import pytest

from quasistatic_ref import ScenarioError, load_scenario
from tests.files.urdf.urdf_texts import link, robot
from tests.made import text_written


def arm_of(address):
    """The body of a scenario whose URDF has an address."""
    arm = {"urdf": address, "base": "floating"}
    return load_scenario({"h": 1, "steps": 1, "bodies": {"arm": arm}}).bodies["arm"]


@pytest.fixture
def share(tmp_path, monkeypatch):
    """A package `arms` with one file, and a file next to it, under a path of Python's."""
    folder = tmp_path / "site" / "cmeel.prefix" / "share"
    for file in ("arms/arm.urdf", "secret.urdf"):
        text_written(folder / file, robot(link("arm")))
    (folder / "arms" / "link.urdf").symlink_to(folder / "secret.urdf")
    monkeypatch.syspath_prepend(tmp_path / "site")
    return folder


def test_a_file_of_an_installed_package_is_taken_with_the_folder_of_all_packages(share):
    arm = arm_of("package://arms/arm.urdf")
    assert arm.urdf == share / "arms" / "arm.urdf"
    assert arm.package_dirs[1:] == (share,)


INSIDE = "must be a path inside the package"
PACKAGE = r"is not a file of an installed package; .* pip install 'quasistatic-ref\[robots\]'"
REFUSED = {
    "package://nowhere/arm.urdf": PACKAGE,
    "package://arms/leg.urdf": PACKAGE,
    "package://": PACKAGE,
    "package://arms": PACKAGE,
    "package://../share/secret.urdf": PACKAGE,
    "package://./secret.urdf": PACKAGE,
    "package://arms/../secret.urdf": INSIDE,
    "package://arms/link.urdf": INSIDE,
}


@pytest.mark.usefixtures("share")
@pytest.mark.parametrize("address", REFUSED)
def test_an_address_that_leads_nowhere_or_out_of_its_package_is_refused(address):
    with pytest.raises(ScenarioError, match=REFUSED[address]) as caught:
        arm_of(address)
    assert (caught.value.field, caught.value.value) == ("bodies.arm.urdf", address)
