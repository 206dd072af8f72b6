"""The last step of the run of scene.toml, as a picture."""

from quasistatic_ref import load_scenario, trajectory_read
from quasistatic_ref.optional.show.figures import (
    draw_scene,
    figure_style,
    figure_written,
    moment,
    panels,
)

scenario = load_scenario("scene.toml")
run = trajectory_read("results/scene.npz")
with figure_style("paper"):
    page, (axes,) = panels(3.5, 3.5)
    draw_scene(axes, moment(scenario, run, -1), view="yz")
figure_written(page, ".", "picture")
