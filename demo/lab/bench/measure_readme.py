#!/usr/bin/env python3
"""Measures the accuracy and speed figures of README.md, on an idle machine, in half a minute.

    demo/lab/bench/measure_readme.py build/release/mobil demo/lab/bench/figures/PROCESSOR.readme.json
    demo/lab/bench/make_tables.py

Errors of deformation methods come from demo/gallery/active.csv (mobil frontier --finite).
"""

import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile


def run(mobil, folder, *arguments):
    subprocess.run([mobil, *arguments, "--quiet"], check=True, cwd=folder, stdout=subprocess.DEVNULL)


def read(file):
    return json.loads(file.read_text())


def bounds(comparison, pattern):
    """Returns the values of the bounds whose name matches, of all walks."""
    values = [bound["value"] for bound in comparison["bounds"] if re.search(pattern, bound["what"])]
    if not values or None in values:
        sys.exit(f"mobil compare tells nothing of '{pattern}'")
    return values


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    mobil, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(mobil, folder, "compare", "--out", "compare")
        comparison = read(folder / "compare/compare.json")
        inside = bounds(comparison, "inside the band")
        results = [
            ("compare.angles_inside.least", min(inside), "1"),
            ("compare.angles_inside.most", max(inside), "1"),
            ("compare.vertical_correlation", min(bounds(comparison, "vertical force, correlation")), "1"),
            ("compare.fore_aft_correlation", min(bounds(comparison, "fore-aft force, correlation")), "1"),
            ("compare.hip_moment_correlation", min(bounds(comparison, "hip_moment, correlation")), "1"),
        ]
        walks, crowds = [], []
        for _ in range(5):
            run(mobil, folder, "walk", "--seconds", "10", "--out", "walk")
            walks.append(read(folder / "walk/summary.json")["time"]["us_per_tick"])
        for _ in range(3):
            run(mobil, folder, "crowd", "--people", "10000", "--report", "crowd.json")
            crowds.append(read(folder / "crowd.json")["tick_ms_p50"])
        results += [
            ("walk.us_per_tick", statistics.median(walks), "us"),
            ("crowd.tick_ms_p50", statistics.median(crowds), "ms"),
        ]
        run(mobil, folder, "bench", "kinematics", "--json", "bench.json")
        bench = read(folder / "bench.json")
        results += [("readme.pose_us", row["value"], row["unit"]) for row in bench["results"]
                    if row["name"] == "kinematics.small_crowd.us_per_person_tick"]
    head = json.dumps({"machine": bench["machine"]}, indent=2)[:-2]
    rows = ",\n    ".join(json.dumps({"name": name, "value": value, "unit": unit}) for name, value, unit in results)
    out.write_text(f'{head},\n  "results": [\n    {rows}\n  ]\n}}\n')
    print(f"written {out}")


if __name__ == "__main__":
    main()
