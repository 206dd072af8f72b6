"""States and scenes of MuJoCo.

``compiler`` has MuJoCo compile a file, after ``fence`` has looked at what it reads.
``mujoco_state`` reads a state, ``touches`` its contacts, ``mujoco`` makes a step of it, and
``scene`` a scenario of a whole scene, with ``system`` and ``drive``. ``mujoco_opinion`` has an
opinion on a state: ``compared`` sets MuJoCo's answer next to the exact one, ``findings`` and
``overlaps`` say what is wrong, and ``opinion`` prints it.
"""
