"""States of other simulators as steps.

``compiler`` has MuJoCo compile a file, after ``fence`` has looked at what it reads; ``mujoco``
makes a step of a state, ``scene`` a scenario of a whole scene, and ``opinion`` compares answers;
``drake`` does the same for Drake's states.
"""
