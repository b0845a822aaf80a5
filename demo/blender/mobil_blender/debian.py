"""Two faults of Debian 12's Blender 3.4.1 beside newer Python packages, mended while the add-on is enabled.

The importer of glTF uses `numpy.bool`, which numpy 1.24 no longer has. The importer of BVH opens files with the mode
"rU", which Python 3.11 no longer accepts.
"""

from __future__ import annotations

import builtins
import sys
from typing import Any

import bpy
import numpy

_mended: list[str] = []


def _open(file: Any, mode: str = "r", *rest: Any, **named: Any) -> Any:
    return builtins.open(file, mode.replace("U", ""), *rest, **named)


def register() -> None:
    if bpy.app.version >= (3, 5, 0):
        return
    if "bool" not in vars(numpy):
        numpy.bool = bool
        _mended.append("numpy")
    if sys.version_info >= (3, 11):
        try:
            from io_anim_bvh import import_bvh
        except ImportError:
            return
        import_bvh.open = _open
        _mended.append("bvh")


def unregister() -> None:
    if "numpy" in _mended:
        del numpy.bool
    if "bvh" in _mended:
        from io_anim_bvh import import_bvh

        del import_bvh.open
    _mended.clear()
