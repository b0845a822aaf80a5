"""Turns the library's axes (x left, y up, z ahead) to Blender's, in which a person faces -Y and Z is up.

Lengths are metres and rotations quaternions (w x y z) in all arrays that leave this package's library.py.
"""

from __future__ import annotations

import numpy as np


def places(rows: np.ndarray) -> np.ndarray:
    """Turns positions or directions, (…, 3)."""
    return np.stack((rows[..., 0], -rows[..., 2], rows[..., 1]), axis=-1)


def library_places(rows: np.ndarray) -> np.ndarray:
    """Turns positions or directions of Blender back, (…, 3)."""
    return np.stack((rows[..., 0], rows[..., 2], -rows[..., 1]), axis=-1)


def quaternions(rows: np.ndarray) -> np.ndarray:
    """Turns rotations x y z w, (…, 4), to w x y z."""
    return np.concatenate((rows[..., 3:], places(rows)), axis=-1)


def conjugate(q: np.ndarray) -> np.ndarray:
    return q * np.array((1.0, -1.0, -1.0, -1.0))


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Multiplies quaternions, (…, 4)."""
    w, v = a[..., :1], a[..., 1:]
    u, s = b[..., :1], b[..., 1:]
    return np.concatenate((w * u - np.sum(v * s, -1, keepdims=True), w * s + u * v + np.cross(v, s)), axis=-1)


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Rotates vectors, (…, 3), by quaternions, (…, 4)."""
    w, u = q[..., :1], q[..., 1:]
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def about_z(angle_rad: np.ndarray) -> np.ndarray:
    """Returns rotations about the vertical, positive to a person's left, (…, 4)."""
    half, zero = np.asarray(angle_rad) / 2, np.zeros_like(angle_rad)
    return np.stack((np.cos(half), zero, zero, np.sin(half)), axis=-1)


def of_matrices(m: np.ndarray) -> np.ndarray:
    """Returns the rotations of orthogonal matrices, (…, 3, 3), as quaternions."""
    squares = np.stack(
        (
            1 + m[..., 0, 0] + m[..., 1, 1] + m[..., 2, 2],
            1 + m[..., 0, 0] - m[..., 1, 1] - m[..., 2, 2],
            1 - m[..., 0, 0] + m[..., 1, 1] - m[..., 2, 2],
            1 - m[..., 0, 0] - m[..., 1, 1] + m[..., 2, 2],
        ),
        axis=-1,
    )
    a, b, c = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    d, e, f = m[..., 1, 0] + m[..., 0, 1], m[..., 0, 2] + m[..., 2, 0], m[..., 2, 1] + m[..., 1, 2]
    s = [squares[..., i] for i in range(4)]
    rows = np.stack(
        [np.stack(row, -1) for row in ((s[0], a, b, c), (a, s[1], d, e), (b, d, s[2], f), (c, e, f, s[3]))], axis=-2
    )  # four multiples of the quaternion; the longest is exact
    best = np.argmax(squares, axis=-1)
    q = np.take_along_axis(rows, best[..., None, None], axis=-2)[..., 0, :]
    return q / np.linalg.norm(q, axis=-1, keepdims=True)
