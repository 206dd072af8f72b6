"""The command on a folder of another pair, whose pushes the model itself made."""

import csv
import json

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.predict import prediction
from quasistatic_ref.lab.reality.push import pushed_scene
from quasistatic_ref.lab.reality.settings import Settings
from tests.lab.reality.test_identify import planted_loads

RATIO = 0.03
RADIUS = 0.01
SIDES = 0.05 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def write_table(path, head, rows):
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([head.split(","), *rows])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Loads of a planted ratio, and three pushes as the model has them."""
    folder = tmp_path_factory.mktemp("measured")
    (folder / "shapes.json").write_text(json.dumps({"tile": SIDES.tolist()}))
    pair = Pair("glass/tile", Outline(SIDES), 0.3, RADIUS, None)
    columns = "surface,shape,mu_pusher_used,finger_radius"
    write_table(folder / "patches.csv", columns, [["glass", "tile", 0.3, RADIUS]])
    loads = planted_loads(60, 0.0, 0, RATIO)
    rows = np.hstack([loads.wrench, loads.twist])
    write_table(folder / "loads.csv", "surface,shape,f_x,f_y,tau,v_x,v_y,omega",
            [["glass", "tile", *row] for row in rows])  # fmt: skip
    rows = []
    for k, across in enumerate((-0.02, 0.0, 0.03)):
        before = np.array([0.1, 0.2, 0.4])
        tip = np.array([[0.1 + across, 0.11], [0.1 + across, 0.15]])
        after = prediction(pushed_scene(Settings(), pair, RATIO), before, tip, "off").pose
        rows.append(["glass", "tile", k, *before, *after, *tip.ravel()])
    head = "surface,shape,push,x0,y0,theta0,x1,y1,theta1,tip_x0,tip_y0,tip_x1,tip_y1"
    write_table(folder / "pushes.csv", head, rows)
    return folder


def command(folder, out, *more):
    where = ("--data", str(folder), "--out", str(out), "--jobs", "1", "--quiet")
    return main(["validate", "reality", *where, *more])


def test_pushes_that_the_model_made_are_predicted_from_planted_loads(folder, tmp_path, capsys):
    assert command(folder, tmp_path, "--json") == 0
    record = json.loads(capsys.readouterr().out)
    own = record["pairs"]["glass/tile"]
    assert own["pushes"] == 3
    assert "published" not in own
    assert max(own["error"]["mean"]) < 1e-3 * min(own["moved"]["mean"])
    assert set(record["steps"]) <= {"exact", "enclosure"}
    assert record["mu_omega_over_mu_v"]["glass/tile"] == pytest.approx(RATIO, rel=1e-6)
    assert json.loads((tmp_path / "reality.json").read_text()) == record


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("reality", "--cone", "frictionless"), "no friction to identify"),
        (("reality", "--cone", "elipsoid"), "ellipsoid"),
        (("reality", "--fraction", "0"), "--fraction"),
        (("reality", "--jobs", "0"), "--jobs"),
        (("reality", "--sets", "abs/rekt1"), "abs/rect1"),
        (("reality", "--data", "nowhere"), "patches.csv"),
        (("incline", "--fraction", "0.1"), "validate reality"),
    ],
)
def test_what_is_not_usable_ends_in_one_sentence(tmp_path, monkeypatch, cli, arguments, says):
    monkeypatch.chdir(tmp_path)
    said = cli("validate", *arguments, status=2).err
    assert says in said
    assert said.count("\n") == 1
