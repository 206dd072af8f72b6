"""Backends that qpsolvers reaches: ``solver = "qpsolvers:NAME"``."""
