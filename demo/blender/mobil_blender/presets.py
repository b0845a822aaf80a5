"""Named walks."""

from __future__ import annotations

from typing import Any, NamedTuple

from . import library


class Preset(NamedTuple):
    meaning: str
    speed_m_s: float = 1.4
    style: dict[str, float] = {}


WALKS = {
    "Usual": Preset("The usual walk of adults"),
    "Stroll": Preset(
        "Slow, with little arm swing",
        0.9,
        {"arm_forward_deg": 9.0, "arm_back_deg": 12.0, "toe_out_deg": 9.0},
    ),
    "Brisk": Preset(
        "Fast, with bent elbows",
        1.9,
        {"arm_forward_deg": 26.0, "elbow_forward_deg": 60.0, "elbow_back_deg": 35.0},
    ),
    "March": Preset(
        "Straight arms, high swing",
        1.5,
        {"arm_forward_deg": 45.0, "arm_back_deg": 30.0, "elbow_forward_deg": 12.0, "trunk_lean_deg": 0.0},
    ),
    "Tired": Preset(
        "Slow and bent, feet close to the ground",
        0.8,
        {
            "trunk_lean_deg": 9.0,
            "arm_forward_deg": 6.0,
            "arm_back_deg": 6.0,
            "toe_clearance_m": 0.006,
            "strike_pitch_deg": 14.0,
        },
    ),
    "Catwalk": Preset(
        "Feet on one line, moving hips",
        1.3,
        {"step_width_h": 0.02, "pelvis_rotation_deg": 11.0, "pelvis_list_deg": 8.0, "toe_out_deg": 2.0},
    ),
    "Limp": Preset("Short, quick steps of the left leg", 0.9, {"step_asymmetry": 0.08, "time_asymmetry": 0.1}),
}


def values(name: str) -> dict[str, float]:
    """Returns the settings of a named walk: its speed, the usual step length, and a complete style."""
    preset = WALKS[name]
    style = {one.name: preset.style.get(one.name, one.usual) for one in library.STYLE}
    return {"speed_m_s": preset.speed_m_s, "step_length_m": 0.0, **style}


def put(of: Any, name: str) -> None:
    for setting, value in values(name).items():
        setattr(of, setting, value)
