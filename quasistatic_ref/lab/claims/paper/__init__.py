"""What the paper claims, and what this implementation comes to."""
