"""Failures of other projects that this one works around: a test fails when one is mended.

Then the workaround can go: see solve/plain_options.py, solve/ask.py and docs/studies.md.
"""

import os

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.solve.plain_options import plain_options
from quasistatic_ref.study.grade import exam
from quasistatic_ref.study.keeper import Keeper
from quasistatic_ref.study.solvers import SETTINGS, Solver
