"""Rows of tables beside tests: their scenes, and what is found in them by hand."""

import copy
import tomllib
from contextlib import chdir
from pathlib import Path

import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cylinder,
    Sphere,
    load_scenario,
)

UNPROVED = {"certify": "off"}
"""Findings are the same without proofs, which take most of a run's time."""
USUAL = {"h": 0.01, "steps": 1}
SOLIDS = {"box": lambda *size: Box(size=size), "sphere": Sphere, "cylinder": Cylinder}
SOLIDS["capsule"] = Capsule
HERE = Path(__file__).parent


def rows_of(*files, name="case"):
    """The rows of tables, which know their folder."""
    return [
        {"folder": file.parent} | row
        for file in map(HERE.joinpath, files)
        for row in tomllib.loads(file.read_text("utf-8"))[name]
    ]


def params(rows):
    """Rows as parameters of a test."""
    return [
        pytest.param(row, id=row["what"], marks=pytest.mark.long if "long" in row else ())
        for row in rows
    ]


CASES = rows_of(*sorted(HERE.glob("doctor/cases/*.toml")))


def changed(tables, changes):
    """Tables of which some values, named by their path, are others."""
    tables = copy.deepcopy(tables)
    for key, value in changes.items():
        *path, last = key.split(".")
        inner = tables
        for part in path:
            inner = inner[part]
        inner[last] = value
    return tables


def made(case, changes=(), also=dict, **more):
    """The scenario of a case, whose simple bodies are made here, or of a scene of MuJoCo.

    Files of a case are beside it. `also` is what else is done to its tables.
    """
    tables = also(changed(case.get("scene", case), dict(changes))) | more
    with chdir(case["folder"]):
        if "mjcf" in tables:
            import mujoco  # which tests of what stands may lack

            from quasistatic_ref import mujoco_scenario

            model = mujoco.MjModel.from_xml_string(tables["mjcf"])
            return mujoco_scenario(model, **USUAL | tables.get("with", {}))
        for body in tables["bodies"].values():
            kind, *sizes = body["urdf"].split()
            if kind in SOLIDS:
                *sizes, mass = map(float, sizes)
                body["urdf"] = Body.of_shape("solid", SOLIDS[kind](*sizes), mass).urdf
        return load_scenario(USUAL | {"fast": True, "solver": UNPROVED} | tables)


def assert_found(findings, hand):
    """Of each finding its numbers, words of its cause or remedy, or words of each sentence."""
    assert {one.name for one in findings} == hand.keys()
    for name, expected in hand.items():
        of = [one for one in findings if one.name == name]
        assert all(one.sentence.startswith(one.cause) for one in of)
        for key, value in expected.items():
            if key == "each":
                assert len(of) == len(value)
                lacking = [word for word in value if not any(word in one.sentence for one in of)]
                assert not lacking, f"{lacking} are not in {of}"
            elif isinstance(value, str):
                texts = [getattr(one, key) for one in of]
                assert [text for text in texts if value in text], f"not in the {key} of {texts}"
            else:
                number, off = value
                right = pytest.approx(number, rel=off, abs=0.0 if number else off)
                assert abs(of[-1].numbers[key]) == right
