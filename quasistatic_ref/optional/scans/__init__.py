"""From a scan to a body: stray points, the solid, and a table of a scenario."""
