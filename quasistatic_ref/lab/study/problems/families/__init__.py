"""Where problems come from: scenarios, and scenes in which one number is turned."""
