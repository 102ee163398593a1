"""What the benchmark scripts share."""

import csv


def write_csv(path, rows):
    """Writes rows, dicts with the same keys, under a line with these."""
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
