"""Contact forces by compliance: their definition, the faces of their cones, a guess, the proof."""
