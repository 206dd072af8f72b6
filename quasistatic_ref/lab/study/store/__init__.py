"""What was measured, kept."""
