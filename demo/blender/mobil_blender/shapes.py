"""Few shape keys for many recorded shapes, by singular value decomposition."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Shapes(NamedTuple):
    keys: np.ndarray
    """(shapes, vertices, 3): displacements at value 1."""
    values: np.ndarray
    """(frames, shapes): -1 to 1."""
    rms_m: float
    """Root mean square distance from the recorded vertices, over all frames and vertices."""
    max_m: float


def reduce(displacements: np.ndarray, rms_m: float = 0.0003, most: int = 32) -> Shapes:
    """Returns the fewest shapes, at most `most`, within `rms_m` of displacements (frames, vertices, 3)."""
    frames, vertices, _ = displacements.shape
    rows = displacements.reshape(frames, -1).astype(np.float64)
    squares, vectors = np.linalg.eigh(rows @ rows.T)  # few frames, many vertices
    squares, vectors = np.maximum(squares[::-1], 0.0), vectors[:, ::-1]
    left = squares.sum() - np.cumsum(squares)
    count = min(int(np.argmax(left <= rms_m**2 * frames * vertices)) + 1, most, frames)
    values = vectors[:, :count]
    scale = np.abs(values).max(axis=0)
    keys = (values.T @ rows) * scale[:, None]
    values = values / scale
    distance = np.linalg.norm((values @ keys - rows).reshape(frames, vertices, 3), axis=-1)
    rms = float(np.sqrt((distance**2).mean()))
    return Shapes(keys.reshape(count, vertices, 3), values, rms, float(distance.max()))
