"""The same quantities from engines that share no code with this package.

They are compared where both solve the same step. How engines differ over whole scenes is in
validation/programs/engines.
"""
