"""Facts of the friction cones."""

COUNTS = {
    "pyramid": (6, 4),
    "product": (8, 4),
    "facets-10": (12, 10),
    "facets-1024": (1026, 1024),
    "frictionless": (1, 1),
    "ellipsoid": (4, 4),
}
