"""Bodies that are held: the grasp of the paper, and when a grip holds.

The study of its clouds is ``lab/clouds``; here are its pictures.
"""
