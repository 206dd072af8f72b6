"""Does it stand? What each body of a scene lacks, if targets and loads stayed as they are."""
