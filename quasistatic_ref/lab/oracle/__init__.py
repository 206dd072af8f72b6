"""The reference beside a program that is being written: step by step, and over whole runs."""
