"""Pairs of solids without a closed form: coal's answers, refined and checked; clouds by coal."""
