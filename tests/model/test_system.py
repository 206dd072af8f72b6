"""System: the paper's order of coordinates, with their names and units."""


def test_coordinates_are_actuated_first_then_in_order_of_the_bodies(scene):
    names = [coordinate.name for coordinate in scene.coordinates]
    twist = ("x", "y", "z", "rx", "ry", "rz")
    assert names == [
        *(f"arm/base.{axis}" for axis in twist), "arm/spin", "desk/slide",
        *(f"box/base.{axis}" for axis in twist), "arm/swing", "arm/slide", "desk/swing",
        "desk/spin",
    ]  # fmt: skip
    assert (scene.n_a, scene.n_u, scene.n_v) == (8, 10, 18)
    assert [coordinate.actuated for coordinate in scene.coordinates] == [True] * 8 + [False] * 10
    units = {coordinate.name: coordinate.unit for coordinate in scene.coordinates}
    assert units["arm/base.z"] == units["arm/slide"] == "m"
    assert units["arm/base.rx"] == units["arm/spin"] == units["arm/swing"] == "rad"
