"""A name for what a value is, to the bit: the same in every process."""

import hashlib

from quasistatic_ref.formats.plain import bits


def fingerprint(value: object) -> str:
    """SHA-256 of what :func:`~quasistatic_ref.formats.plain.bits` compares, in hexadecimal.

    It is the same in every process: of arrays, texts and shapes, and not of mappings, whose order
    is not.
    """
    return hashlib.sha256(repr(bits(value)).encode()).hexdigest()
