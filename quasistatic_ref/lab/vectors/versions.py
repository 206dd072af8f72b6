"""The version of the vectors: within a version no case of a layer changes."""

MANIFEST = "manifest.json"
FORMAT = "quasistatic-ref/vectors-manifest"
FORMAT_VERSION = 1
RELEASE = 13
"""The version: counted up whenever an input or an expected output changes."""
