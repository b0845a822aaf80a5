"""Redraws three figures of the library's gallery from Python: angles, ground reaction and moments over a gait cycle, at
five speeds.  Usage: figures.py [FOLDER]"""

import pathlib
import sys

import numpy as np

import mobil
from matplotlib.figure import Figure
from mobil.plots import over_cycle

SPEEDS_M_S = (0.8, 1.1, 1.4, 1.7, 2.0)


def draw(walks: dict[float, mobil.Walk], rows: dict[str, tuple[str, object]], path: pathlib.Path) -> None:
    figure = Figure(figsize=(4 * len(rows), 3.6), layout="constrained")
    for axes, (title, (unit, of)) in zip(np.atleast_1d(figure.subplots(1, len(rows))), rows.items()):
        for number, (speed, walk) in enumerate(walks.items()):
            axes.plot(*over_cycle(walk, of(walk)), color=f"C{number}", label=f"{speed:.1f} m/s")
        axes.set(title=title, ylabel=unit, xlabel="% of the right gait cycle", xlim=(0, 100))
    axes.legend(fontsize="small")
    figure.savefig(path)
    print(path)


def main(folder: pathlib.Path) -> None:
    walks = {speed: mobil.walk(height_m=1.8, mass_kg=80, speed_m_s=speed) for speed in SPEEDS_M_S}
    joints = {"hip flexion": "hip_flexion", "knee flexion": "knee_flexion", "ankle dorsiflexion": "ankle_dorsiflexion"}
    draw(walks, {title: ("deg", lambda walk, name=name: np.degrees(walk.joint(f"{name}_right")))
                 for title, name in joints.items()}, folder / "angles.svg")
    draw(walks, {title: ("N/kg", lambda walk, column=column: walk.ground[:, 0, column] / walk.mass_kg)
                 for title, column in {"vertical": 1, "fore-aft": 2}.items()}, folder / "ground_reaction.svg")
    draw(walks, {title: ("N m/kg", lambda walk, name=title: walk.moment(f"{name}_right") / walk.mass_kg)
                 for title in ("hip", "knee", "ankle")}, folder / "moments.svg")


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    target.mkdir(parents=True, exist_ok=True)
    main(target)
