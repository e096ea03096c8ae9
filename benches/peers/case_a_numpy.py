"""Case A by the explicit scheme as a loop of numpy calls: the same steps as
case_a.c, all blades at once.  case_a_numpy.py STEP_S REPEATS"""
import sys

import numpy as np

from machine import BLADES, CLEARANCE, DIAMETERS, END, LENGTH, MASS, NU, PHASES, PULSE, STIFFNESS, ZETA, measure

h, repeats = float(sys.argv[1]), int(sys.argv[2])
phases = np.array(PHASES)
shapes = np.stack([np.cos(phases), np.sin(phases)])
disk = BLADES / 2 * (15000 + 6000 * (1 - np.cos(2 * np.pi * DIAMETERS / BLADES)))
stiffness = np.array([STIFFNESS, STIFFNESS, disk, disk])
mass = np.array([MASS, MASS, 0.20825 * BLADES / 2, 0.20825 * BLADES / 2])
zeta = np.array([ZETA, ZETA, 0.04, 0.04])
inertia, drag = mass / h**2, zeta * np.sqrt(mass * stiffness) / h
keep, compliance = (inertia - drag) / (inertia + drag), 1 / (inertia + drag)


def pulse(n):
    begins, ends = max(n * h - h / 2, 0), min(n * h + h / 2, LENGTH)
    return PULSE if n == 0 else max(ends - begins, 0) * PULSE / h


def pushes(w, gap):
    """Of the rows with these predicted gaps, the multipliers that only push."""
    rows = np.arange(len(gap))
    while True:
        push = np.linalg.solve(w[np.ix_(rows, rows)], gap[rows])
        if (push <= 0).all():
            return rows, push
        rows = rows[push <= 0]


def solve():
    steps = round(END / h)
    x, step = np.zeros(4), np.array([-(h**2) * PULSE / MASS / 2, 0, 0, 0])
    impacts, touched, force = [], {}, np.zeros(4)
    for n in range(steps):
        force[0] = pulse(n)
        step = keep * step + compliance * (force - stiffness * x)
        x = x + step
        beta = NU * (n + 1) * h + phases + DIAMETERS * (x[2:] @ shapes)
        cos, sin = np.cos(beta), np.sin(beta)
        gaps = CLEARANCE + x[0] * cos + x[1] * sin
        closed = np.flatnonzero(gaps < 0)
        if not len(closed):
            continue
        cos, sin = cos[closed], sin[closed]
        lever = DIAMETERS * (x[1] * cos - x[0] * sin)
        c = np.stack([cos, sin, lever * shapes[0, closed], lever * shapes[1, closed]])
        rows, push = pushes(c.T @ (compliance[:, None] * c), gaps[closed])
        change = -compliance * (c[:, rows] @ push)
        x, step = x + change, step + change
        for blade in closed[rows]:
            if n + 1 - touched.get(blade, -9) > 2:
                impacts.append(((n + 1) * h, blade + 1))
            touched[blade] = n + 1
    return steps, impacts, x[:2]


measure(solve, repeats)
