"""The same quantities from engines that share no code with this package."""
