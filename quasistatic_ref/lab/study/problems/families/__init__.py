"""Where the problems of a study come from: scenarios, and families scaled on purpose."""
