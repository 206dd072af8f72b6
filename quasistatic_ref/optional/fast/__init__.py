"""The same steps in less time; every certified answer has the same bits without this folder."""
