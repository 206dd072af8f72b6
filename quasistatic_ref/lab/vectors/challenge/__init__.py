"""New cases for as long as one likes, sent to a program that answers line by line."""
