"""MJCF models as bodies.

``mjcf`` writes each element as URDF, ``geoms`` knows MuJoCo's types of shapes, and ``ignored``
tells what is left out.
"""
