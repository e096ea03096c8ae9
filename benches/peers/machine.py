"""The machine of the paper in case A, and the output that every peer prints."""
import json
import math
import time

BLADES, DIAMETERS, SPEED = 22, 3, 500.0
CLEARANCE = 0.5 - 0.4999
MASS, STIFFNESS, ZETA = 2.0, 1.544e6, 0.05
OMEGA = math.sqrt(STIFFNESS / MASS)
DAMPING = 2 * MASS * OMEGA * ZETA
PULSE, LENGTH, END = 20e3, 50e-6, 0.1
# One phase n_d Phi_i a blade; the wave turns at NU in the frame of the blades.
PHASES = [2 * math.pi * (DIAMETERS * blade % BLADES) / BLADES for blade in range(BLADES)]
NU = DIAMETERS * SPEED


def measure(solve, repeats):
    """Runs it this often and prints seconds, steps, impacts and [u_c, u_s]."""
    seconds = []
    for _ in range(repeats):
        began = time.process_time()
        steps, impacts, u = solve()
        seconds.append(time.process_time() - began)
    impacts = [[float(t), int(blade)] for t, blade in impacts]
    u = [float(x) for x in u]
    print(json.dumps({"steps": steps, "seconds": seconds, "impacts": impacts, "u_m": u}))
