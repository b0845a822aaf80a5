#!/usr/bin/env python3
"""Writes the tables of speed in our documents from files that `mobil bench --json` wrote.

    demo/lab/bench/make_tables.py            rewrites them
    demo/lab/bench/make_tables.py --check    prints differences of documents, status 1

A document marks the place of a table with two lines; the script writes the text between them:

    <!-- figures: muscles -->
    <!-- end -->

Columns are the machines of demo/lab/bench/figures, each a file or several. A row is a line of the tables below. The table of
README.md has figures of several commands in sentences, those of the machine that measured all of them; errors and costs of
ways to deform muscles are those of demo/gallery/active.csv and frontier.csv, an AMD EPYC's.
"""

import argparse
import csv
import difflib
import json
import math
import pathlib
import re
import sys

US, NS, MS = ("µs", 1), ("ns", 1), ("ms", 1e-3)  # unit shown, and its number in one of the file's
SPEED, CM = ("m/s", 1), ("cm", 1)
PERCENT, TIMES = ("%", 100), ("times", 1)

# name: rows of a description, the figure's name in the file, and its unit
TABLES = {
    "machine": [
        ("multiply-adds, one core", "machine.fma_peak_gflops", ("Gflop/s", 1)),
        ("memory, one core", "machine.bandwidth_gbps", ("GB/s", 1)),
    ],
    "people": [
        ("a person's gait for a tick, in a crowd that fits in the caches", "gait.small_crowd.us_per_person_tick", US),
        ("a person's pose for a tick, so too", "kinematics.small_crowd.us_per_person_tick", US),
        ("a step solved anew, when a walk changes", "gait.us_per_resolve", US),
        ("a muscle's line of action", "lines.us_per_muscle_tick", US),
        ("a vertex of muscle or bone, by its control points", "skinning.ns_per_vertex", NS),
        ("a vertex of skin, of somebody near", "skin.near.ns_per_vertex", NS),
    ],
    "avoidance": [
        ("one way, 0.5 people a m²", "avoidance.one_way_0.5.m_per_s", SPEED),
        ("one way, 1", "avoidance.one_way_1.m_per_s", SPEED),
        ("one way, 2", "avoidance.one_way_2.m_per_s", SPEED),
        ("one way, 2, if nobody turned the shoulders", "avoidance.one_way_2_unturned.m_per_s", SPEED),
        ("both ways, 0.2", "avoidance.both_ways_0.2.m_per_s", SPEED),
        ("both ways, 0.5", "avoidance.both_ways_0.5.m_per_s", SPEED),
        ("both ways, 1", "avoidance.both_ways_1.m_per_s", SPEED),
        ("both ways, 1, from 200 to 600 s", "avoidance.both_ways_1_long.m_per_s", SPEED),
        ("crossing, 0.5", "avoidance.crossing_0.5.m_per_s", SPEED),
        ("crossing, 1", "avoidance.crossing_1.m_per_s", SPEED),
        ("through a door of 1.2 m", "avoidance.door.people_per_s", ("people/s", 1)),
        ("worst overlap of trunks one way, 2 people a m²", "avoidance.one_way_2.overlap_cm", CM),
        ("both ways, 1, ten minutes", "avoidance.both_ways_1_long.overlap_cm", CM),
        ("crossing, 1", "avoidance.crossing_1.overlap_cm", CM),
        ("at the door", "avoidance.door.overlap_cm", CM),
        ("worst overlap of shoulders one way, 2 people a m²", "avoidance.one_way_2.shoulders_cm", CM),
        ("both ways, 1, ten minutes", "avoidance.both_ways_1_long.shoulders_cm", CM),
        ("at the door", "avoidance.door.shoulders_cm", CM),
        ("choosing, a person and tick, crossing, 1", "avoidance.crossing_1.us_per_person_tick", US),
    ],
    "threads": [
        ("serial share of a tick", "threads.unseen.serial_share", PERCENT),
        ("2 threads against 1", "threads.unseen.2.speedup", TIMES),
        ("4", "threads.unseen.4.speedup", TIMES),
        ("8", "threads.unseen.8.speedup", TIMES),
        ("16", "threads.unseen.16.speedup", TIMES),
        ("16, by the model at most", "threads.unseen.16.speedup_predicted", TIMES),
        ("64, by the model at most", "threads.unseen.64.speedup_predicted", TIMES),
        ("everybody compact: serial share of a tick", "threads.compact.serial_share", PERCENT),
        ("2 threads against 1", "threads.compact.2.speedup", TIMES),
        ("16", "threads.compact.16.speedup", TIMES),
        ("16, by the model at most", "threads.compact.16.speedup_predicted", TIMES),
    ],
    "muscles": [
        ("a step of 81 nodes, explicit, one stiffness for all", "fem.explicit81.shared.us_per_step", US),
        ("its share of the core's multiply-adds", "fem.explicit81.shared.peak_fraction", PERCENT),
        ("the same, a stiffness for each", "fem.explicit81.individual.us_per_step", US),
        ("Eigen's sparse product needs", "fem.explicit81.ratio_to_eigen", TIMES),
        ("Eigen's, of sixteen muscles at once", "fem.explicit81.ratio_to_eigen_batched", TIMES),
        ("Bullet's deformable body needs", "fem.explicit81.ratio_to_bullet", TIMES),
        ("12 modes of a finer mesh, a tick", "modal.us_per_tick", US),
        ("and their control points", "modal.us_per_tick_with_control_points", US),
        ("two threads against one", "fem.threads2_speedup", TIMES),
    ],
}

# A description, and two columns with figures as {name|format}.
TUNED, PAPERS = "active.modal-12, tuned, finite shape", "active.explicit-central, 81 nodes"
SENTENCES = {
    "readme": [
        ("a tick of 10,000 people with eight muscles each, the nearest 500 within 1 mm",
         "{crowd.tick_ms_p50|ms} on {machine.cores|cores} of an {machine.cpu|text}",
         "a frame at 60 Hz is 16.7 ms (`mobil crowd --people 10000`)"),
        ("shape of an active muscle in a walk, against nonlinear finite elements",
         f"{{{TUNED}.all_off|%}} off, {{{TUNED}.cost_us|µs}} a tick",
         f"the paper's linear method is {{{PAPERS}.all_off|%}} off, {{{PAPERS}.cost_us|µs}} (`mobil frontier --finite`)"),
        ("joint angles at five walking speeds",
         "within the measured band for {compare.angles_inside.least|%} to {compare.angles_inside.most|%} of the cycle",
         "published norms of measured walks (`mobil compare`)"),
    ],
    "frontier": [
        ("the paper's choice: 81 nodes, explicit, 2 ms", "{line.explicit-central.81.2.error|.1%}", "{line.explicit-central.81.2.us|µs} a muscle and tick"),
        ("its 525 nodes; its 3321", "{line.explicit-central.525.1.4.error|.1%}; {line.explicit-central.3321.0.7.error|.1%}",
         "{line.explicit-central.525.1.4.us|µs}; {line.explicit-central.3321.0.7.us|µs}"),
        ("8 modes of 8×8×32 cells; with the 81 control points placed", "{line.modal.2673.8.error|.1%}",
         "1/{line.modal.2673.8.ratio|.0f}; 1/{line.modal.2673.8.ratio_points|.0f} of the paper's choice"),
        ("12 modes; with points", "{line.modal.2673.12.error|.1%}",
         "1/{line.modal.2673.12.ratio|.0f}; 1/{line.modal.2673.12.ratio_points|.0f}"),
        ("24 modes; with points", "{line.modal.2673.24.error|.1%}",
         "1/{line.modal.2673.24.ratio|.0f}; 1/{line.modal.2673.24.ratio_points|.0f}"),
        ("12 modes of 4×4×16 cells (made in a tenth of a second); 32", "{line.modal.425.12.error|.1%}; {line.modal.425.32.error|.1%}",
         "1/{line.modal.425.12.ratio|.0f}; 1/{line.modal.425.32.ratio|.0f}"),
        ("static, 81 nodes: real walks jolt", "{line.static.81.16.7.error|%}", "{line.static.81.16.7.us|µs}"),
        ("with gravity and the frame's motion (`--loads frame`): 12 modes; the paper's choice",
         "{frame.modal.2673.12.error|.1%}; {frame.explicit-central.81.2.error|.1%}", "1/{frame.modal.2673.12.ratio|.0f}; {frame.explicit-central.81.2.us|µs}"),
    ],
}
HEADINGS = {"readme": "| | mobil | compared with |", "frontier": "| method | error | cost |"}
IN_SENTENCES = {
    "%": lambda value: f"{100 * value:.0f} %",
    ".1%": lambda value: f"{100 * value:.1f} %",
    ".0f": lambda value: f"{value:.0f}",
    "1": lambda value: f"{math.floor(100 * value) / 100:.2f}",  # least values: never better than they are
    "µs": lambda value: shown(value, US),
    "text": str,
    "ms": lambda value: shown(value, ("ms", 1)),
    "cores": lambda value: {1: "one core", 2: "two cores"}.get(value, f"{value} cores"),
}

MARKED = re.compile(r"(<!-- figures: (\w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def shown(value, unit):
    """Returns two digits, because figures of speed have no more."""
    value *= unit[1]
    digits = max(0, 1 - math.floor(math.log10(abs(value)))) if value else 0
    if value >= 100:
        scale = 10 ** (math.floor(math.log10(value)) - 1)
        value = round(value / scale) * scale
    return f"{value:.{digits}f} {unit[0]}"


def machines(folder):
    """Returns each machine's description, and its figures by name. A machine can have several files."""
    found = {}
    for file in sorted(folder.glob("*.json")):
        told = json.loads(file.read_text())
        machine = told["machine"]
        cores = f"{machine['cores']} core" + ("s" if machine["cores"] != 1 else "")
        processor = machine["cpu"].replace("(R)", "").replace(" Processor", "")
        heading = f"{processor}, {cores}, {machine['target']}"
        figures = found.setdefault(heading, {"machine.cores": machine["cores"], "machine.cpu": processor})
        figures.update({row["name"]: row["value"] for row in told["results"]})
    return list(found.items())


def active(file):
    """Returns errors and costs of deformation methods for active muscles, all together (mobil frontier --finite)."""
    if not file.exists():
        return {}
    with file.open() as lines:
        rows = [row for row in csv.DictReader(lines) if row["muscle"] == "all"]
    return {f"active.{row['way']}.{name}": float(row[name]) for row in rows for name in ("all_off", "cost_us")}


def frontier(file):
    """Returns those for drawn muscles (mobil frontier --long): method, nodes, and milliseconds or modes."""
    if not file.exists():
        return {}
    found = {}
    with file.open() as lines:
        for row in csv.DictReader(lines):
            part = row["basis"] if row["method"].startswith("modal") else f"{1e3 * float(row['dt_s']):.1f}".removesuffix(".0")
            name = f"{row['loads']}.{row['method']}.{row['nodes']}.{part}"
            found |= {f"{name}.error": float(row["error_rel"]), f"{name}.us": float(row["cost_us_per_tick"]),
                      f"{name}.ratio": float(row["cost_ratio_to_paper"]),
                      f"{name}.ratio_points": float(row["control_points_ratio_to_paper"])}
    return found


def sentences(name, columns, where):
    """Returns the sentences of the first machine that has measured all of their figures."""
    lines = [HEADINGS[name], "|---|---|---|"]
    names = re.findall(r"\{([^|{}]+)\|", " ".join(first + second for _, first, second in SENTENCES[name]))
    for _, figures in columns:
        if any(figure not in figures for figure in names):
            continue
        for text, *templates in SENTENCES[name]:
            said = [re.sub(r"\{([^|{}]+)\|([^}]+)\}", lambda of: IN_SENTENCES[of[2]](figures[of[1]]), one) for one in templates]
            lines.append(f"| {text} | {said[0]} | " + (f"{said[1]} |" if said[1] else "|"))
        return "\n".join(lines) + "\n"
    sys.exit(f"{where}: no machine has measured all of '{name}'; demo/lab/bench/measure_readme.py, mobil frontier --long and mobil frontier --finite do")


def table(name, columns):
    """Returns the table of all machines that have measured any of its figures."""
    columns = [(heading, figures) for heading, figures in columns if any(row[1] in figures for row in TABLES[name])]
    lines = ["| | " + " | ".join(heading for heading, _ in columns) + " |", "|---|" + "---|" * len(columns)]
    for text, figure, unit in TABLES[name]:
        values = [shown(figures[figure], unit) if figure in figures else "–" for _, figures in columns]
        lines.append(f"| {text} | " + " | ".join(values) + " |")
    return "\n".join(lines) + "\n"


def remade(text, columns, where):
    def fill(marked):
        if marked[2] in SENTENCES:
            return marked[1] + sentences(marked[2], columns, where) + marked[4]
        if marked[2] not in TABLES:
            sys.exit(f"{where}: there is no table '{marked[2]}'; there are: {', '.join([*TABLES, *SENTENCES])}")
        return marked[1] + table(marked[2], columns) + marked[4]

    return MARKED.sub(fill, text)


def documents(root):
    for file in sorted(root.rglob("*.md")):
        inside = file.relative_to(root).parts
        if inside[0] not in ("build", "out") and not inside[0].startswith("."):
            yield file


def main():
    here = pathlib.Path(__file__).resolve().parents[3]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing; status 1 where a document differs")
    parser.add_argument("--root", type=pathlib.Path, default=here, help="the project's folder")
    asked = parser.parse_args()
    errors = active(asked.root / "demo/gallery/active.csv") | frontier(asked.root / "demo/gallery/frontier.csv")
    columns = [(heading, figures | errors) for heading, figures in machines(asked.root / "demo/lab/bench/figures")]
    if not columns:
        sys.exit("demo/lab/bench/figures has no file; mobil bench --json demo/lab/bench/figures/MACHINE.json writes one")
    differ = False
    for file in documents(asked.root):
        text = file.read_text()
        new = remade(text, columns, file.relative_to(asked.root))
        if new == text:
            continue
        differ = True
        if asked.check:
            name = str(file.relative_to(asked.root))
            sys.stdout.writelines(difflib.unified_diff(
                text.splitlines(True), new.splitlines(True), name, name + " as figures have it", n=0))
        else:
            file.write_text(new)
            print(f"written {file.relative_to(asked.root)}")
    if differ and asked.check:
        sys.exit("figures differ from demo/lab/bench/figures; demo/lab/bench/make_tables.py writes them")


if __name__ == "__main__":
    main()
