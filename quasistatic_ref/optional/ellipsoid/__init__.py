"""The ellipsoidal friction cone: its solvers, its enclosures and their verification."""
