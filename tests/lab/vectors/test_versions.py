"""Layers are frozen within a version of the vectors; its archive has the same bytes each time."""

import hashlib
import os
import shutil
import tomllib
import zipfile

import pytest

from quasistatic_ref.lab.vectors import versions
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.pack import write_zip
from quasistatic_ref.lab.vectors.versions import RELEASE, edition, manifest
from tests.lab.vectors.committed_cases import ROOT, VECTORS


@pytest.fixture
def copy(tmp_path):
    """A copy of the vectors, to be changed."""
    return shutil.copytree(VECTORS, tmp_path / "vectors")


PARTS = ("inputs", "expected")


def test_the_version_is_the_same_wherever_it_is_said():
    assert manifest(VECTORS)[0] == RELEASE
    citation = (VECTORS / "CITATION.cff").read_text()
    assert f'\nversion: "{RELEASE}"\n' in citation
    assert f"quasi-dynamic vectors {RELEASE}**" in (VECTORS / "README.md").read_text()
    assert f"quasi-dynamic-vectors-{RELEASE}.zip" in (VECTORS / "README.md").read_text()
    assert "\ntype: dataset\n" in citation


def test_a_frozen_version_has_every_layer_and_the_last_is_the_present():
    known = tomllib.loads((ROOT / "quasistatic_ref/lab/vectors/versions.toml").read_text())
    assert all(set(layers) == set(LAYERS) for layers in known.values())
    assert max(map(int, known)) == RELEASE


@pytest.mark.parametrize("part", PARTS)
def test_one_changed_digit_makes_a_layer_another_one(copy, part):
    path = copy / part / "rows.json"
    text = path.read_text()
    at = text.index("0.")
    path.write_text(text[: at + 2] + str((int(text[at + 2]) + 1) % 10) + text[at + 3 :])
    # A changed case is another version: count RELEASE up, and add to versions.toml.
    assert edition(VECTORS).changed == (), edition(VECTORS).hashes
    assert (edition(copy).release, edition(copy).changed) == (RELEASE, ("rows",))


def test_vectors_of_no_version_and_of_one_that_is_not_known_are_changed(copy):
    (copy / "manifest.json").write_text(
        (VECTORS / "manifest.json").read_text().replace(f'"release": {RELEASE}', '"release": 999')
    )
    assert edition(copy).changed == LAYERS
    (copy / "manifest.json").unlink()
    assert edition(copy).changed == LAYERS
    assert edition(copy).name == "quasi-dynamic vectors of no version"


def test_the_archive_s_bytes_do_not_depend_on_times_and_modes(copy, tmp_path):
    path, code = write_zip(VECTORS, tmp_path / "one")
    for file in copy.rglob("*.json"):
        os.utime(file, (1e9, 1e9))
        file.chmod(0o600)
    again, _ = write_zip(copy, tmp_path / "two")
    assert path.name == f"quasi-dynamic-vectors-{RELEASE}.zip"
    assert path.read_bytes() == again.read_bytes()
    assert hashlib.sha256(path.read_bytes()).hexdigest() == code
    assert (path.parent / f"{path.name}.sha256").read_text() == f"{code}  {path.name}\n"


def test_the_archive_holds_the_folder_its_licences_and_sums_that_hold(tmp_path, cli):
    cli("vectors", "pack", "--vectors", VECTORS, "--out", tmp_path)
    (path,) = tmp_path.glob("*.zip")
    with zipfile.ZipFile(path) as archive:
        assert {member.compress_type for member in archive.infolist()} == {zipfile.ZIP_STORED}
        archive.extractall(tmp_path)
    folder = tmp_path / path.stem
    inside = {p.relative_to(folder).as_posix(): p for p in folder.rglob("*") if p.is_file()}
    own = {p.relative_to(VECTORS).as_posix(): p for p in VECTORS.rglob("*") if p.is_file()}
    assert set(inside) == {*own, "SHA256SUMS"}
    assert all(inside[name].read_bytes() == own[name].read_bytes() for name in own)
    sums = [line.split("  ") for line in (folder / "SHA256SUMS").read_text().splitlines()]
    found = {name: hashlib.sha256(file.read_bytes()).hexdigest() for name, file in own.items()}
    assert {name: code for code, name in sums} == found
    assert "LICENSE.md" in inside


def test_the_licences_of_the_vectors_are_those_of_the_repository():
    bunny = "models/bunny_grasp/LICENSE-stanford-bunny.md"
    for own, here in (
        ("LICENSE", "LICENSE-BSD-3-Clause.txt"),
        (bunny, "LICENSE-stanford-bunny.md"),
    ):
        assert (VECTORS / here).read_bytes() == (ROOT / own).read_bytes()
    named = (VECTORS / "LICENSE.md").read_text()
    others = {path.name for path in VECTORS.glob("LICENSE-*")}
    assert all(f"`{name}`" in named for name in others)
    assert len(others) == 3


@pytest.mark.parametrize(
    ("file", "content", "says"),
    [
        ("inputs/rows.json", "{}", "rows: is not as version"),
        ("README.md", "# mine", "README.md: is another file than its manifest says"),
        ("manifest.json", "{}", "manifest.json: format: is missing"),
        ("manifest.json", None, "manifest.json: no such file"),
    ],
)
def test_what_is_not_as_it_should_be_is_not_packed(copy, tmp_path, cli, file, content, says):
    if content is None:
        (copy / file).unlink()
    else:
        (copy / file).write_text(content)
    said = cli("vectors", "pack", "--vectors", copy, "--out", tmp_path / "out", status=2).err
    assert says in said
    assert said.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_path_that_leads_out_of_the_folder_is_refused(copy, cli):
    path = copy / "manifest.json"
    path.write_text(path.read_text().replace('"README.md"', '"../README.md"'))
    assert "is no path inside the folder" in cli("vectors", "pack", "--vectors", copy, status=2).err
    assert not versions.PLAIN.fullmatch("a/../b")
