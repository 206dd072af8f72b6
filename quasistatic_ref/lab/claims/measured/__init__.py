"""Claims about measured pushes.

They state what ``lab/reality`` predicts, and predict nothing themselves.
"""
