"""New cases for as long as one likes, sent to a program that answers line by line.

It makes cases, sends them, and makes smaller what fails. Whether an answer is right is decided by
``check``.
"""
