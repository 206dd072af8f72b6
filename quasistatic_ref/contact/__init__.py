"""Where bodies touch: signed distances, closest points and contact Jacobians."""
