"""Within a version of the vectors no case changes."""

import hashlib

import pytest

from quasistatic_ref.lab.vectors.versions import RELEASE
from tests.lab.vectors.committed_cases import LAYERS, ROOT, VECTORS

HASHES = {
    "distance": "80735c595d255903889e3acb308a8f0744724b69840dd7c390ad9b22e3f102c4",
    "selection": "f354fd7e406274e7e237eb66c62be386ba2d65539d3d86f018ae2648983e5d44",
    "jacobian": "ac05dd92b4428eb9389e9b4b0d175bd171f5c1bc81cf0db40b74ce324e781e71",
    "rows": "486e16dbf3ddf106a85a4ef9f34e33fed779377b4d9a40ca4320cc74990253db",
    "qp": "b26d8e669f412c35cf57e1a9d2b26da48f0a5aa13efc60bd43595fc61d9b004d",
    "wrench": "ba3e8365d03d022a6bd87683268ad7a4d90f69faf87193505904abb2286f3ebc",
    "integrate": "4b0ca0c4fc608a6b66575636ac8ab2b346f8d53d03317481b3290bb7d3c4e6c1",
    "step": "4f9b36070fc74ce23133bcc3ca472d1ffa61e3f80c59b2e25a543d446cbf0d1d",
    "derivative": "b0be941667c69fab3714389a71ce5089dc8e3e201a3268b6bd89eb03945c13a2",
}
"""SHA-256 of inputs/LAYER.json followed by expected/LAYER.json. A changed case is another version:
count RELEASE up, write these again."""


def test_the_version_is_the_same_wherever_it_is_said():
    citation = (VECTORS / "CITATION.cff").read_text()
    assert f'\nversion: "{RELEASE}"\n' in citation
    assert f"quasi-dynamic vectors {RELEASE}**" in (VECTORS / "README.md").read_text()


@pytest.mark.parametrize("layer", LAYERS)
def test_the_cases_of_a_layer_are_those_of_the_version(layer):
    texts = [
        (VECTORS / part / f"{layer}.json").read_text("utf-8") for part in ("inputs", "expected")
    ]
    found = hashlib.sha256("".join(texts).encode()).hexdigest()
    assert found == HASHES[layer], (
        f"inputs or expected of {layer} have changed: restore them by git; or, for a new version, "
        f'count up RELEASE in lab/vectors/versions.py, and write "{layer}": "{found}" into '
        "tests/lab/vectors/test_versions.py"
    )


def test_the_licences_of_the_vectors_are_those_of_the_repository():
    bunny = "models/bunny_grasp/LICENSE-stanford-bunny.md"
    for source, copy in (
        ("LICENSE", "LICENSE-BSD-3-Clause.txt"),
        (bunny, "LICENSE-stanford-bunny.md"),
    ):
        assert (VECTORS / copy).read_bytes() == (ROOT / source).read_bytes()
    named = (VECTORS / "LICENSE.md").read_text()
    others = {path.name for path in VECTORS.glob("LICENSE-*")}
    assert all(f"`{name}`" in named for name in others)
    assert len(others) == 3
