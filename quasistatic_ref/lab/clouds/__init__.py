"""The grasp with other clouds of the same bunny: samplings, runs, and what became of them.

One study with committed rows. Readers of cloud files are in ``model`` and ``optional/readers``.
"""
