"""Good texts that are spoilt."""

SCENE = """
format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 2
gravity = [0, 0, -9.81]
cone = "pyramid"
record = "full"
solver = { backend = "clarabel", accuracy = 1e-12, certify = "full" }
limits = { penetration = 0.05, reach = 10 }
[bodies.gripper]
urdf = "gripper.urdf"
base = "floating"
actuated = ["base", "width"]
K_q = { base = [800, 800, 800, 20, 20, 20], width = 2000 }
pose = { xyz = [0, 0, 0.2], rpy = [0, 0, 0.1] }
positions = { width = 0.06 }
gravity_compensated = false
[[bodies.gripper.targets]]
t = 0.0
width = 0.06
base = { xyz = [0, 0, 0.2], rpy = [0, 0, 0.1] }
[[bodies.gripper.targets]]
t = 0.5
width = 0.05
base = { xyz = [0, 0, 0.3], rpy = [0, 0.1, 0] }
[bodies.ball]
urdf = "sphere.urdf"
base = "floating"
cloud = "cloud.xyz"
pose = { xyz = [0, 0, 0.05] }
[[bodies.ball.wrenches]]
t = 0.0
force = [0, 0, 0]
torque = [0, 0, 0.01]
[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }
[shapes.post]
capsule = { radius = 0.1, length = 1 }
pose = { xyz = [2, 0, 0], rpy = [1, 0, 0] }
[shapes.block]
box = { size = [0.1, 0.2, 0.3] }
pose = { xyz = [-2, 0, 0] }
[shapes.pillar]
cylinder = { radius = 0.1, length = 1 }
pose = { xyz = [0, 2, 0] }
[contacts.floor]
alpha = "floor"
beta = "ball"
mu_v = 0.5
mu_omega = 0.01
rows = 6
k = 2
[contacts.around]
alpha = ["post", "block", "pillar", "gripper/left_finger"]
beta = "ball"
mu_v = 0.6
rows = 4
k = 1
"""
"""Every field of a scenario at least once."""
SETTINGS = (
    "contacts.floor.mu_v=0.3", "steps=1", "bodies.ball.pose.xyz=[0, 0, 0.06]", 'cone="ellipsoid"',
    "shapes.floor.halfspace={ normal = [0, 0, 1], offset = 0 }", "solver.certify=residual",
)  # fmt: skip
SOLVERS = """format = "quasistatic-ref/study"
version = 1
kind = "solvers"
time_limit = 2.0
budget = 10.0
repetitions = 2
[problems]
seed = 3
scenarios = ["sphere_spin", "stack"]
families = { scenarios = 4 }
[settings.high]
accuracy = 1e-9
promised = 4.0
[[runs]]
solvers = ["qpsolvers:clarabel", "cvxpy:osqp"]
settings = ["default", "high"]
units = ["natural", "raw"]
warm = [false, true]
every = 3
"""
TRIANGLES = (0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)
CORNERS = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
PCD = """VERSION .7
FIELDS x y z rgb
SIZE 4 4 4 4
TYPE F F F U
COUNT 1 1 1 1
WIDTH 4
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 4
DATA """
PLY = """ply
format {} 1.0
comment made by hand
element vertex 4
property float x
property float y
property float z
property uchar red
element face 0
property list uchar int vertex_indices
end_header
"""
