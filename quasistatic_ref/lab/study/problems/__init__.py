"""Quadratic programs of contact with exact answers: sets of them, made, kept, checked, exported.

It knows no solver. Answers are the exact method's, with a proof. Only the family ``scenarios`` is
made here; the set ``contact-qp`` is frozen, and ``dials`` says what their families
vary.
"""
