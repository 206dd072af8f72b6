"""Short runs with no grave finding: cells, built with the words of finding_scenes.py.

A cell titled "no NAME" only just lacks the finding NAME, which may be a note.
"""

# %% nothing: a box that starts 0.2 mm above the floor
found = findings([box(xyz=(0, 0, 0.0502))])

# %% nothing: a capsule
pill = Body.of_shape("pill", Capsule(0.02, 0.05), 0.2, xyz=(0, 0, 0.02), rpy=(0, np.pi / 2, 0))
found = findings([pill], lies("pill", k=2))

# %% nothing: a tin on its end
found = findings([TIN], lies("tin"))

# %% nothing: a box in a corner
found = findings(
    [box()],
    [*STANDS, ("east", "box", 0.5, 4), ("north", "box", 0.5, 4)],
    [("east", Box(size=(0.1, 2, 2)), (0.1, 0, 0)), ("north", Box(size=(2, 0.1, 2)), (0, 0.1, 0))],
    push={"box": (3, 3, 0)},
)

# %% nothing: a block in a slot without friction on its walls
found = findings(
    [box()], [*STANDS, ("wall-1", "box", 0.0, 4), ("wall+1", "box", 0.0, 4)], walls(0.1)
)

# %% nothing: a block in a slot with 5 mm of clearance
found = findings([box()], IN_SLOT, walls(0.105))

# %% nothing: a planar base on a smooth floor
found = findings([box(base="planar")], lies(mu_v=0.0), push={"box": (1, 0, 0)})

# %% nothing: a drawer that a finger pushes
finger = motor("finger", size=TIP, xyz=(-0.06, 0, 0))
found = findings([DRAWER, finger], [("finger", "drawer", 0.3, 1)], target=[0.001])

# %% nothing: a box of a hundred points, all of which are kept
found = findings([box()], lies(k=100), cloud={"box": FACE})

# %% nothing: a box without weight
found = findings([box(xyz=(0, 0, 1))], [], gravity=(0, 0, 0))

# %% nothing: a box in the air that a force bears
found = findings([box(xyz=(0, 0, 1))], push={"box": (0, 0, 9.81)})
assert found == ()

# %% nothing: a box that a step moves by a fifth of its size
found = findings([box(mass=0.1)], lies(mu_v=0.0), push={"box": (20, 0, 0)}, steps=1)

# %% nothing: a wheel that turns by 0.24 rad in a step
wheel = Body("wheel", joint("revolute", "0 0 1"), actuated="all", xyz=(0, 0, 0.2))
found = findings([wheel], lies("wheel"), target=[0.24], K_q=1e6, steps=1)

# %% nothing: a target at the limit of its URDF
found = findings([motor("finger")], [], target=[1.0])

# %% nothing: a mu_omega as long as its box
found = findings([box()], mu_omega=0.1)

# %% nothing: a cloud of 19.9 m
raft = [(x, y, -0.05) for x in (-9.95, 9.95) for y in (-9.95, 9.95)]
found = findings([box()], cloud={"box": raft})

# %% nothing: a passive wheel that turns about itself, and touches nothing
found = findings([Body("wheel", joint("continuous", "0 0 1"), positions={"joint": 1.0})], [])

# %% no flush-shapes: a crate that goes from one table to another, which is 10 um lower
found = over_a_joint(TABLE, (0.25, 0, -0.02501))

# %% no uncertain-forces: what a finger pushes stops within its contact, whose load, the drag, goes to 1e-13 N
# A step leaves m/h^2 / (K_q + m/h^2) = 1/6 of the distance to the target.
slider = Body("slider", joint("prismatic", "1 0 0", (0.04, 0.04, 0.04), 0.01, 2.7e-6))
pushed = [("finger", "slider", 0.0, 4)]
found = findings(
    [slider, motor("finger", xyz=(-0.07, 0, 0))], pushed, target=[[0.01]] * 20, steps=20
)

# %% no force-beyond-a-limit: a palm of 2 N bears 1.96 N
palm = Body("palm", weak, actuated="all", xyz=(0, 0, -0.05))
found = findings([box(mass=0.2), palm], [("palm", "box", 0.5, 4)], steps=60)

# %% no force-beyond-a-limit: an effort of 1, for want of a number, under 98 N
palm = motor("palm", "0 0 1", xyz=(0, 0, -0.05))
found = findings([box(mass=10.0), palm], [("palm", "box", 0.5, 4)], steps=60, K_q=5000.0)

# %% no stray-points: a point one spacing beside the others
found = findings([box()], lies(k=100), cloud={"box": [*FACE, (0.05 + 0.1 / 9, 0, -0.05)]})

# %% no starts-inside: a finger whose middle is 1 mm beside a box
finger = motor("finger", size=TIP, xyz=(-0.051, 0, 0.05))
found = findings([box(), finger], STANDS)

# %% no time-of-proof: 9 of 12 s (those of a long run, written here)
found = findings([box()], seconds={"solve": 3.0, "proof": 9.0})
