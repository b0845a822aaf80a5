#!/usr/bin/env python3
"""Native times of the ticks of bench.mjs on one thread: median and best of 200, µs.

Usage: PYTHONPATH=build/release/python demo/web/bench.py
"""

import time

import mobil


def timed(name, body):
    times = []
    for _ in range(200):
        began = time.perf_counter()
        body()
        times.append(1e6 * (time.perf_counter() - began))
    times.sort()
    print(f"{name:<44} {times[100]:6.0f} ({times[0]:.0f})")


def bench(name, count, muscles):
    world = mobil.World(threads=1)
    world.spawn(
        height_m=[1.6 + 0.3 * (i % 17) / 17 for i in range(count)],
        mass_kg=70,
        speed_m_s=[1 + 0.5 * (i % 13) / 13 for i in range(count)],
        place=[[i % 40, 0, i // 40] for i in range(count)],
        muscles=muscles,
    )
    world.tick(300)
    timed(name, world.tick)


def modal(points):
    return mobil.muscles(method="modal", modes=12, control_points=points)


bench("one person, eight muscles, explicit", 1, mobil.muscles(method="explicit_central"))
bench("one person, modal, control points", 1, modal(1))
bench("1000 people, bones", 1000, None)
bench("1000 people, modal, unseen", 1000, modal(0))
bench("1000 people, modal, control points", 1000, modal(1))
