"""What becomes of each thing that a MuJoCo model or state can say, in one table.

A thing is a field of ``mjModel`` or of its ``opt``, a member of an enumeration that says of which
kind an element is, or a part of the state (``mjtState``), from which MuJoCo computes all else in
``mjData``. The tests hold that each thing that MuJoCo knows stands here once, and try each.
"""

from __future__ import annotations

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState

USED = """
body_contype body_conaffinity
body_gravcomp body_inertia body_ipos body_iquat body_mass body_pos body_quat body_subtreemass
jnt_axis jnt_pos jnt_range jnt_limited jnt_margin jnt_stiffness
jnt_actfrcrange jnt_actfrclimited jnt_actgravcomp
qpos0 qpos_spring dof_armature dof_frictionloss dof_M0
geom_adhesion geom_friction geom_gap geom_margin geom_pos geom_quat geom_size
geom_condim geom_conaffinity geom_contype geom_priority geom_fluid
pair_adhesion pair_friction pair_gap pair_margin pair_dim
hfield_data hfield_size mesh_vert site_pos site_quat wrap_prm eq_data
tendon_stiffness tendon_lengthspring tendon_range tendon_limited tendon_margin tendon_armature
tendon_actfrcrange tendon_actfrclimited tendon_frictionloss tendon_length0
actuator_armature actuator_biasprm actuator_cranklength actuator_ctrlrange actuator_ctrllimited
actuator_dynprm actuator_forcerange actuator_forcelimited actuator_gainprm actuator_gear
actuator_lengthrange actuator_acc0 actuator_actearly actuator_group actuator_delay
actuator_actrange actuator_actlimited actuator_history
opt.timestep opt.gravity opt.wind opt.density opt.viscosity opt.o_margin opt.o_friction
opt.ccd_iterations opt.ccd_tolerance opt.sdf_initpoints opt.sdf_iterations
opt.cone opt.disableflags opt.enableflags opt.disableactuator
"""
"""What a step is made of: here, or by MuJoCo in what it says of the state."""

WITHOUT_EFFECT = """
body_margin body_invweight0 body_user
jnt_solimp jnt_solref jnt_user jnt_group
dof_damping dof_dampingpoly dof_solimp dof_solref dof_length dof_invweight0
geom_aabb geom_rbound geom_rgba geom_solimp geom_solmix geom_solref geom_user geom_group
geom_castshadow pair_solimp pair_solref pair_solreffriction
mesh_normal mesh_polynormal mesh_pos mesh_quat mesh_scale mesh_texcoord
site_size site_rgba site_user site_group eq_solimp eq_solref eq_active0
tendon_damping tendon_dampingpoly tendon_invweight0 tendon_rgba tendon_user tendon_width
tendon_group tendon_solimp_fri tendon_solimp_lim tendon_solref_fri tendon_solref_lim
actuator_damping actuator_dampingpoly
actuator_length0 actuator_user tree_sleep_policy stat vis
geom_matid site_matid site_type tendon_matid mesh_facenormal mesh_facetexcoord
opt.impratio opt.tolerance opt.iterations opt.integrator opt.jacobian opt.solver
opt.ls_iterations opt.ls_tolerance opt.noslip_iterations opt.noslip_tolerance
opt.sleep_tolerance opt.magnetic opt.o_solref opt.o_solimp
"""
"""Velocities, softness, solvers, sensors, looks, and numbers that only the compiler reads."""

PLACES = """
n* flg_* *id *adr *num *nnz *colind *_diag *simple *simplenum *sameframe *signature map*
*_type *_objtype pair_geom* hfield_n* mesh_* plugin plugin_* geom_plugin actuator_ctrlspec paths opt
"""
"""Whole numbers that say how many elements there are, what each is, and what it belongs to."""

SEEN = "bvh cam efm0 efmC key light mat name numeric oct sensor skin tex text tuple"
"""Fields that begin with these are of things that are seen, noted or measured: without effect.
Those of efm0 and efmC are of solvers."""

REFUSED = {
    "jnt_springyield": "makes a spring plastic",
    "tendon_springyield": "makes a spring plastic",
    "jnt_stiffnesspoly": "makes a spring nonlinear; use stiffness alone",
    "tendon_stiffnesspoly": "makes a spring nonlinear; use stiffness alone",
    "geom_surfacevel": "moves a surface, and a step has no velocities; set it to zero",
}
"""Fields that must be zero: why, and what to do. Fields of flex are refused, too."""

PLUGINS = ("body_plugin", "actuator_plugin")
"""Plugins that push, which are refused."""

KINDS = {
    "jnt_type": ("mjtJoint", "FREE BALL SLIDE HINGE", "", ""),
    "eq_type": ("mjtEq", "CONNECT WELD JOINT TENDON", "", "FLEX FLEXVERT FLEXSTRAIN DISTANCE"),
    "actuator_trntype": (
        "mjtTrn", "JOINT JOINTINPARENT SLIDERCRANK TENDON SITE BODY", "", "SO3 UNDEFINED",
    ),
    "actuator_dyntype": (
        "mjtDyn", "NONE INTEGRATOR FILTER FILTEREXACT", "MUSCLE", "DCMOTOR PID USER",
    ),
    "actuator_gaintype": ("mjtGain", "FIXED AFFINE", "MUSCLE", "DCMOTOR SO3 PID USER"),
    "actuator_biastype": ("mjtBias", "NONE AFFINE", "MUSCLE", "DCMOTOR SO3 USER"),
}  # fmt: skip
"""Fields that say of which kind an element is: MuJoCo's enumeration, and which of its kinds are
used, said in the answer, and refused."""

STATE = (
    "TIME QPOS ACT HISTORY CTRL QFRC_APPLIED XFRC_APPLIED EQ_ACTIVE MOCAP_POS MOCAP_QUAT",
    "QVEL",
    "WARMSTART USERDATA",
    "PLUGIN PLASTIC",
)
"""Parts of a state: used, said in the answer, without effect, and those of what is refused."""

OBJECTS = {"jnt": "joint", "eq": "equality"}
"""MuJoCo's names of elements, where fields abbreviate them."""


def kind_of(state: MujocoState, field: str, i: int) -> str:
    """The kind of an element, such as ``"MUSCLE"``, by one of the fields of ``KINDS``."""
    kinds = getattr(state.mujoco, KINDS[field][0])
    return str(kinds(int(getattr(state.model, field)[i])).name).split("_", 1)[1]


def check(state: MujocoState) -> None:
    """Refuse elements of a state that no step can represent: ModelError.

    Raises
    ------
    ModelError
        Naming element and field.
    """
    model = state.model
    if model.nflex:
        problem = "is not supported, as bodies are rigid; leave it out"
        raise ModelError(problem, field=state.words("flex", 0))
    for field, reason in REFUSED.items():
        values = getattr(model, field)
        for i in np.argwhere(values)[:1, 0].tolist():
            raise ModelError(reason, field=named(state, field, i), value=values[i].tolist())
    for field in PLUGINS:
        for i in np.flatnonzero(getattr(model, field) >= 0)[:1].tolist():
            raise ModelError("pushes with a plugin; leave it out", field=named(state, field, i))
    for i in np.flatnonzero(model.actuator_gainprm[:, 1]).tolist():
        if kind_of(state, "actuator_gaintype", i) == "AFFINE":
            problem = "makes the gain depend on the length; put the stiffness into biasprm"
            raise ModelError(problem, field=named(state, "actuator_gainprm", i))
    for field, (_, _, _, refused) in KINDS.items():
        for i in range(len(getattr(model, field))):
            kind = kind_of(state, field, i)
            if kind in refused.split():
                problem = "is of a kind that no step has; use another"
                raise ModelError(problem, field=named(state, field, i), value=kind.lower())


def check_run(state: MujocoState) -> None:
    """Refuse what a state can say and a run cannot: ModelError, naming element and field."""
    model = state.model
    loose = model.tendon_lengthspring[:, 0] < model.tendon_lengthspring[:, 1]
    for i in np.flatnonzero(loose & (model.tendon_stiffness > 0)).tolist():
        problem = "has a range in which the spring is slack, and K_q is that of a whole run; "
        problem += "give one length"
        raise ModelError(problem, field=f"{state.words('tendon', i)}.springlength")
    for i in range(model.nu):
        if kind_of(state, "actuator_dyntype", i) == "MUSCLE":
            problem = "has a lag between control and force, which a run does not have; "
            problem += "use a filter, or no dyntype"
            raise ModelError(problem, field=f"{state.words('actuator', i)}.dyntype", value="muscle")
    sticky = "attracts bodies across a gap, which no step can express; leave it out"
    for i in range(model.nu):
        if kind_of(state, "actuator_trntype", i) == "BODY":
            raise ModelError(sticky, field=f"{state.words('actuator', i)}.body")
    for field in ("geom_adhesion", "pair_adhesion"):
        for i in np.flatnonzero(getattr(model, field))[:1].tolist():
            raise ModelError(sticky, field=named(state, field, i))


def named(state: MujocoState, field: str, i: int) -> str:
    """An element's field in words, such as ``joint[knee].stiffnesspoly``."""
    kind, _, rest = field.partition("_")
    return f"{state.words(OBJECTS.get(kind, kind), i)}.{rest}"
