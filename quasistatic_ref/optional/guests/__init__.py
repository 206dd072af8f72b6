"""States and scenes of other simulators.

``compiler`` has MuJoCo compile a file, after ``fence`` has looked at what it reads.
``mujoco_state`` reads a state, ``mujoco`` makes a step of it, ``scene`` a scenario of a whole scene
with ``system`` and ``drive``, and ``mujoco_opinion`` an opinion. ``drake`` and ``drake_opinion`` do
the same for Drake's states. One for both are ``state_step``, and what is compared: ``compared``,
``findings``, ``opinion``.
"""
