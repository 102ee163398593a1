"""Tests of FnPlotter.py; check_fnplotter.py runs them."""
