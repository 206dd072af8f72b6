"""All that exists only to be quick; every certified answer has the same bits without it."""
