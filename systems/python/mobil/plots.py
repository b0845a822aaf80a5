"""Plots of a walk with matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import names
from .walks import Walk


def over_cycle(walk: Walk, values: np.ndarray, side: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Overlays the gait cycles of a side. Returns percent of the cycle, ascending, and the values there."""
    percent = 100 * walk.phase[:, side]
    order = np.argsort(percent, kind="stable")
    return percent[order], np.asarray(values)[order]


def plot_walk(walk: Walk, label: str | None = None, figure: Any = None) -> Any:
    """Plots angles, ground reaction, moments and muscles of the right leg over its gait cycle. Returns a Figure.

    `figure`: an earlier result to draw into.
    """
    if figure is None:
        try:
            from matplotlib.figure import Figure
        except ImportError as error:
            raise ImportError("plots need matplotlib; install it (Debian: python3-matplotlib)") from error
        figure = Figure(figsize=(11, 7), layout="constrained")
        figure.subplots(2, 3)
    angle, ground, moment, length, belly, centre = figure.axes
    for axes, title, unit in (
        (angle, "hip, knee, ankle", "deg"),
        (ground, "ground reaction, vertical and fore-aft", "N/kg"),
        (moment, "moments: hip, knee, ankle", "N m/kg"),
        (length, "lines of action", "over rest"),
        (belly, "bellies: elongation", "mm"),
        (centre, "centre of mass: height", "m"),
    ):
        axes.set_title(title, fontsize="medium")
        axes.set_ylabel(unit)
        axes.set_xlabel("% of the cycle")
        axes.set_xlim(0, 100)
    for number, joint in enumerate(("hip_flexion", "knee_flexion", "ankle_dorsiflexion")):
        named = joint.split("_")[0] if label is None else f"{joint.split('_')[0]}, {label}"
        angle.plot(*over_cycle(walk, np.degrees(walk.joint(f"{joint}_right"))), color=f"C{number}", label=named)
    for number, column in enumerate((1, 2)):
        ground.plot(*over_cycle(walk, walk.ground[:, 0, column] / walk.mass_kg), color=f"C{number}")
    for number, joint in enumerate(("hip", "knee", "ankle")):
        moment.plot(*over_cycle(walk, walk.moment(f"{joint}_right") / walk.mass_kg), color=f"C{number}")
    line = {name: names.LINE.index(name) for name in ("length_m", "rest_length_m")}
    for number, (name, rows) in enumerate(walk.lines.items()):
        ratio = rows[:, 0, line["length_m"]] / rows[:, 0, line["rest_length_m"]]
        length.plot(*over_cycle(walk, ratio), color=f"C{number}", label=name.replace("_", " "))
    for number, (name, rows) in enumerate(walk.bellies.items()):
        belly.plot(*over_cycle(walk, 1000 * rows[:, 0, names.REPORT.index("elongation_m")]), color=f"C{number}")
    centre.plot(*over_cycle(walk, walk.centre_of_mass[:, 1]), label=label)
    for axes in (angle, length) if walk.lines else (angle,):
        axes.legend(fontsize="x-small")
    return figure
