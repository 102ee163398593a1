"""Draws the gain functions of a function file. FnPlotter.py is its command line."""
