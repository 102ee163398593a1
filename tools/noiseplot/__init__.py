"""The parts of NoisePlotter.py."""
