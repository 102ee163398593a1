"""Random arrays, dtypes, layouts, times and functions against NumPy: the first cases of tools/random_arrays.py."""

import sys
import unittest
from pathlib import Path

import nutik

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import random_arrays  # noqa: E402


class RandomArrays(unittest.TestCase):
    def test_each_picture_keeps_its_bound(self):
        shares = [random_arrays.check(nutik, number) for number in range(150)]
        self.assertLessEqual(max(shares), 1.0)
        self.assertGreater(max(shares), 0.01, "the bounds say nothing")
        print(f"largest share of a bound: {max(shares):.3f}")


if __name__ == "__main__":
    unittest.main()
