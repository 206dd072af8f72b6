"""The step under Coulomb's law, without the rise of sliding contacts."""
