"""Figures of claims, studies and examples, each drawn from what was measured for it.

Nothing is measured or solved here. Pictures of scenes and runs are drawn by ``optional/show``.
"""
