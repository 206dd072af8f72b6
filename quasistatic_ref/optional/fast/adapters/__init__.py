"""One file a solver: the program in arrays that are kept, handed to the solver's own interface."""
