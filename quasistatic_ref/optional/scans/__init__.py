"""From a scan to a body: stray points, the solid that points enclose, and a scenario's table."""
