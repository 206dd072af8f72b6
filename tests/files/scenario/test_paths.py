"""``package://NAME/PATH`` in a scenario: a file of an installed package, or a plain refusal."""

import pytest

from quasistatic_ref import ScenarioError
from quasistatic_ref.files.scenario.paths import path_in, shared_folders
from quasistatic_ref.text.table_reader import TableReader


def path_found(folder, address):
    return path_in(folder, TableReader({"urdf": address}, "bodies.arm", ScenarioError), "urdf")


@pytest.fixture
def share(tmp_path, monkeypatch):
    """A package `arms` with one file, and a file next to it, under a path of Python's."""
    folder = tmp_path / "site" / "cmeel.prefix" / "share"
    (folder / "arms").mkdir(parents=True)
    (folder / "arms" / "arm.urdf").write_text("<robot/>")
    (folder / "secret.urdf").write_text("<robot/>")
    monkeypatch.syspath_prepend(tmp_path / "site")
    return folder


def test_a_file_of_an_installed_package_is_found_from_any_folder(share, tmp_path):
    path = path_found(tmp_path / "elsewhere", "package://arms/arm.urdf")
    assert path == share / "arms" / "arm.urdf"
    assert shared_folders(path) == [share]


def test_a_file_elsewhere_has_no_shared_folder(share, tmp_path):
    assert shared_folders(tmp_path / "arm.urdf") == []


@pytest.mark.parametrize(
    "address",
    ["package://nowhere/arm.urdf", "package://arms/leg.urdf", "package://", "package://arms"],
)
def test_a_scenario_that_is_not_installed_is_refused_with_the_remedy(share, tmp_path, address):
    with pytest.raises(ScenarioError, match=r"pip install 'quasistatic-ref\[robots\]'") as caught:
        path_found(tmp_path, address)
    assert (caught.value.field, caught.value.value) == ("bodies.arm.urdf", address)


def test_a_path_does_not_leave_its_package(share, tmp_path):
    with pytest.raises(ScenarioError, match="must be a path inside the package"):
        path_found(tmp_path, "package://arms/../secret.urdf")
    for address in ("package://../share/secret.urdf", "package://./secret.urdf"):
        with pytest.raises(ScenarioError, match="installed package"):
            path_found(tmp_path, address)


def test_a_link_does_not_lead_out_of_its_package(share, tmp_path):
    (share / "arms" / "link.urdf").symlink_to(share / "secret.urdf")
    with pytest.raises(ScenarioError, match="must be a path inside the package"):
        path_found(tmp_path, "package://arms/link.urdf")
