"""Case A by SciPy's solve_ivp with an event for the gap of each blade: rigid
blades, plastic impacts.  case_a_scipy.py TOLERANCE REPEATS

The steps are as long as the tolerance allows: a gap that closes and opens
within one is not seen, which does not happen here. After an impact of case A the wave leaves the blade at once. Sliding along a
blade and a held corner are other equations, which this script does not have;
it stops where they would be needed."""
import sys

import numpy as np
from scipy.integrate import solve_ivp

from machine import CLEARANCE, DAMPING, END, LENGTH, MASS, NU, PHASES, PULSE, STIFFNESS, measure

tolerance, repeats = float(sys.argv[1]), int(sys.argv[2])


def rates(force):
    def f(_, y):
        u, v = y[:2], y[2:]
        acceleration = (-DAMPING * v - STIFFNESS * u) / MASS
        return [v[0], v[1], acceleration[0] + force / MASS, acceleration[1]]

    return f


def gap_of(phase):
    def gap(t, y):
        beta = NU * t + phase
        return CLEARANCE + y[0] * np.cos(beta) + y[1] * np.sin(beta)

    gap.terminal, gap.direction = True, -1
    return gap


gaps = [gap_of(phase) for phase in PHASES]


def solve():
    t, y, steps, impacts = 0.0, np.zeros(4), 0, []
    for force, until in (PULSE, LENGTH), (0.0, END):
        f = rates(force)
        while t < until:
            run = solve_ivp(
                f, (t, until), y, method="DOP853", rtol=tolerance, atol=1e-4 * tolerance, events=gaps
            )
            if not run.success:
                sys.exit(run.message)
            t, y, steps = run.t[-1], run.y[:, -1].copy(), steps + len(run.t) - 1
            if run.status != 1:
                break
            blade = next(i for i, times in enumerate(run.t_events) if len(times))
            impacts.append((t, blade + 1))
            # The gap and its rate, with beta' = NU: the rate becomes zero.
            beta = NU * t + PHASES[blade]
            normal = np.array([np.cos(beta), np.sin(beta)])
            turned = np.array([-normal[1], normal[0]])
            y[2:] -= (y[2:] @ normal + NU * (y[:2] @ turned)) * normal
            a = np.array(f(t, y)[2:])
            if a @ normal + 2 * NU * (y[2:] @ turned) - NU**2 * (y[:2] @ normal) < 0:
                sys.exit("sliding begins, which this script does not have")
    return steps, impacts, y[:2]


measure(solve, repeats)
