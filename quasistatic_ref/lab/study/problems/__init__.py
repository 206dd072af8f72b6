"""Quadratic programs of contact with exact answers: sets of them, kept, checked, exported.

It knows no solver. Answers are the exact method's, with a proof. The set ``contact-qp`` is frozen,
and its manifest says what its families vary; problems of other steps are made, not kept.
"""
