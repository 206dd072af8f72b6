"""Exact answers of convex QPs and LPs, with proofs; README.md says how."""
