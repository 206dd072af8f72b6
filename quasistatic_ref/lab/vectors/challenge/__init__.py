"""New cases for as long as one likes, asked of a program that answers line by line."""
