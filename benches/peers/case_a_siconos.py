"""Case A by Siconos: the time-stepping scheme of Moreau and Jean (theta 1/2)
with 22 unilateral constraints, which are linear in the frame of the blades;
rigid blades, plastic impacts.  case_a_siconos.py STEP_S REPEATS"""
import sys

import numpy as np
import siconos.kernel as sk

from machine import CLEARANCE, DAMPING, END, LENGTH, MASS, NU, PHASES, PULSE, STIFFNESS, measure

h, repeats = float(sys.argv[1]), int(sys.argv[2])


def solve():
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    wave = sk.LagrangianLinearTIDS([0.0, 0.0], [0.0, 0.0], MASS * np.eye(2))
    wave.setCPtr(DAMPING * np.eye(2) + 2 * MASS * NU * turn)
    wave.setKPtr((STIFFNESS - NU**2 * MASS) * np.eye(2) + DAMPING * NU * turn)
    wave.setFExtPtr(np.zeros(2))
    force = wave.fExt()
    model = sk.NonSmoothDynamicalSystem(0.0, END)
    model.insertDynamicalSystem(wave)
    blades = []
    for phase in PHASES:
        relation = sk.LagrangianLinearTIR(np.array([[np.cos(phase), np.sin(phase)]]), [CLEARANCE])
        blades.append(sk.Interaction(sk.NewtonImpactNSL(0.0), relation))
        model.link(blades[-1], wave)
    times = sk.TimeDiscretisation(0.0, h)
    simulation = sk.TimeStepping(model, times, sk.MoreauJeanOSI(0.5), sk.LCP())
    steps, impacts, touched = 0, [], {}
    while simulation.hasNextEvent():
        # The mean force of the step, so that the impulse is exact.
        t = simulation.startingTime()
        share = min(max((LENGTH - t) / h, 0.0), 1.0)
        middle = NU * (t + share * h / 2)
        force[:] = share * PULSE * np.cos(middle), -share * PULSE * np.sin(middle)
        simulation.computeOneStep()
        steps += 1
        # To look at 22 multipliers takes a quarter of a step; the end state shows
        # that no impact comes later.
        for blade, interaction in enumerate(blades) if steps * h < 1e-3 else ():
            if interaction.lambda_(1)[0] > 0:
                if steps - touched.get(blade, -9) > 2:
                    impacts.append((simulation.nextTime(), blade + 1))
                touched[blade] = steps
        simulation.nextStep()
    z = complex(*wave.q()) * np.exp(1j * NU * steps * h)
    return steps, impacts, (z.real, z.imag)


measure(solve, repeats)
