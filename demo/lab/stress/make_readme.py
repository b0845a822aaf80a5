#!/usr/bin/env python3
"""Writes demo/lab/stress/README.md from what `mobil stress --json FILE` wrote. Usage: make_readme.py FILE"""
import json
import pathlib
import sys

HEAD = """# Hard cases

What `mobil stress` tries, what is promised of each case, and what was measured. The reason of each bound is in the
program's own output. Made by

    mobil stress --json stress.json && demo/lab/stress/make_readme.py stress.json

in {seconds:.0f} s: {held} of {all} promises held. Margin: how many times over the promise is kept; a dash where the bound is
zero, which is met or not, or the margin has no end.

"""


def margin(row):
    bound, value = row["bound"], row["value"]
    if not isinstance(value, (int, float)) or bound == 0:
        return "–"
    ratio = bound / value if row["promise"] == "at most" and value else value / bound if row["promise"] == "at least" else None
    if ratio is None or ratio <= 0:
        return "–"
    return f"{ratio:.2g}" if ratio < 10 else f"{ratio:.0f}" if ratio < 1000 else "> 1000"


def main():
    figures = json.loads(pathlib.Path(sys.argv[1]).read_text())
    rows = figures["rows"]
    text = [HEAD.format(seconds=figures["seconds"], held=figures["held"], all=len(rows))]
    entry = None
    for row in rows:
        if row["name"] != entry:
            entry = row["name"]
            text.append(f"\n## {entry}\n\n| tried | promised | happened | margin |\n|---|---|---|---|\n")
        cells = (row["tried"], row["promised"], row["happened"], margin(row))
        text.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n")
    pathlib.Path(__file__).with_name("README.md").write_text("".join(text))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
