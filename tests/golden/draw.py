#!/usr/bin/env python3
"""Draws the scenes of the golden set, each as the words behind `rubscope run`.

    tests/golden/draw.py PROGRAM

writes one file a kind beside this one, one scene a line: `{"name": .., "scene": ..}`. Scenes
that PROGRAM refuses are drawn again. What is expected of them is added by
`RUBSCOPE_GOLDEN=write cargo test --release golden`. The built-in scenes and the reference
cases stand in `builtin.jsonl` and `reference.jsonl`, which were written by hand.
"""

import json
import math
import pathlib
import random
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
PROGRAM = sys.argv[1]
EACH = 30
GAP = 1e-4  # clearance of Table 1 [m]


def log(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def machine(rng, most_blades=40):
    """A machine, a pulse or a start near a lock, and a step."""
    blades = rng.randint(5, most_blades)
    diameters = rng.randint(1, max(1, min(6, (blades - 1) // 2)))
    keys = {
        "bladed_disk.blades": blades,
        "operation.nodal_diameters": diameters,
        "bladed_disk.damping_ratio": rng.choice([0.001, 0.01, 0.04, 0.2]),
        "casing.damping_ratio": rng.choice([0, 0.005, 0.01, 0.02, 0.05]),
        "solver.step_s": rng.choice([1e-7, 2e-7, 5e-7]),
        "solver.end_s": rng.choice([0.004, 0.008, 0.016]),
    }
    critical = 878.635 / diameters
    keys["operation.speed_rad_s"] = round(critical * rng.uniform(0.4, 2.2), 4)
    if rng.random() < 0.35:
        near_lock(rng, keys, critical)
    else:
        keys["operation.pulse_n"] = round(log(rng, 3e3, 6e5), 2)
    if rng.random() < 0.25:
        keys["bladed_disk.stiffness_nm_per_rad"] = round(log(rng, 300, 3e5), 2)
    return keys


def near_lock(rng, keys, critical):
    """Starts a hair inside a corner of the polygon, turning with the blades."""
    blades, diameters = keys["bladed_disk.blades"], keys["operation.nodal_diameters"]
    speed = round(critical * rng.uniform(1.3, 2.4), 4)
    keys["operation.speed_rad_s"] = speed
    keys["operation.pulse_n"] = 0
    sides = blades // math.gcd(blades, diameters)
    corner = math.tan(math.pi / sides) if sides > 2 else 0.1
    u_c, u_s = -GAP * (1 - 1e-9), -GAP * corner * rng.uniform(0.2, 0.999)
    turn = diameters * speed
    keys["initial.u_c_m"], keys["initial.u_s_m"] = u_c, u_s
    keys["initial.v_c_m_s"], keys["initial.v_s_m_s"] = -turn * u_s, turn * u_c


def law(rng, keys, lining=0.2):
    if rng.random() < lining:
        keys["solver.contact"] = "smooth"
        keys["contact.stiffness_n_per_m"] = round(log(rng, 3e5, 1e9), 0)
        keys["contact.smoothing_m"] = 1e-6
        for key in ["u_c_m", "u_s_m"]:
            if "initial." + key in keys:
                keys["initial." + key] *= 0.9
    else:
        keys["solver.contact"] = rng.choice(["unilateral", "bilateral"])


def rigid(rng):
    keys = machine(rng)
    law(rng, keys)
    return keys | {"solver.model": "rigid"}, []


def modal(rng):
    keys = machine(rng)
    law(rng, keys)
    return keys | {"solver.model": "modal"}, []


def full(rng):
    keys = machine(rng, 30)
    law(rng, keys)
    keys["solver.end_s"] = min(keys["solver.end_s"], 0.008)
    return keys | {"solver.model": "full"}, []


def bilateral(rng):
    keys = machine(rng)
    keys["operation.pulse_n"] = round(log(rng, 3e3, 2e6), 2)
    return keys | {"solver.contact": "bilateral", "solver.model": rng.choice(["rigid", "modal"])}, []


def lining(rng):
    keys = machine(rng)
    law(rng, keys, 1)
    if rng.random() < 0.4:
        keys["casing.radius_m"] = 0.4999 - rng.choice([5e-6, 20e-6, 40e-6])
        for key in ["u_c_m", "u_s_m", "v_c_m_s", "v_s_m_s"]:
            keys.pop("initial." + key, None)
        keys["operation.pulse_n"] = 2000
    if rng.random() < 0.6:
        keys["bladed_disk.radial_coupling"] = rng.choice([-0.15, 0.1, 0.3, 0.5])
    return keys | {"solver.model": rng.choice(["rigid", "modal", "modal", "full"])}, []


def slope_friction(rng):
    keys = machine(rng, 26)
    keys["bladed_disk.radial_coupling"] = rng.choice([0, 0.05, 0.1, 0.2, 0.3, 0.5])
    keys["contact.friction"] = rng.choice([0, 0.05, 0.15, 0.3])
    keys["casing.tangential_ratio"] = rng.choice([0, 0.1, 0.3333])
    model = rng.choice(["modal", "modal", "modal", "full"])
    return keys | {"solver.contact": "unilateral", "solver.model": model}, []


def restitution(rng):
    keys = machine(rng)
    keys["contact.restitution"] = rng.choice([0.1, 0.3, 0.5, 0.7, 0.8])
    return keys | {"solver.contact": "unilateral", "solver.model": rng.choice(["rigid", "modal"])}, []


def imperfect(rng):
    keys = machine(rng, 26)
    blades = keys["bladed_disk.blades"]
    law(rng, keys, 0.15)
    for key in ["u_c_m", "u_s_m"]:
        if "initial." + key in keys:
            keys["initial." + key] *= 0.8
    kind = rng.choice(["long", "scatter", "tips", "orbit", "lobes", "both"])
    if kind in ("long", "both"):
        keys["bladed_disk.longest_tip_m"] = rng.choice([-5e-6, 2e-6, 10e-6])
    if kind == "scatter":
        keys["bladed_disk.tip_scatter_m"], keys["bladed_disk.tip_seed"] = 3e-6, rng.randint(1, 99)
    if kind == "tips":
        tips = [round(rng.uniform(-8e-6, 8e-6), 8) for _ in range(blades)]
        keys["bladed_disk.tips_m"] = json.dumps(tips).replace(" ", "")
    if kind == "orbit":
        keys["bladed_disk.orbit_m"], keys["bladed_disk.orbit_angle_rad"] = 8e-6, rng.choice([0, 1.3])
    if kind in ("lobes", "both"):
        keys["casing.lobes"] = rng.randint(1, 6)
        keys["casing.out_of_round_m"] = rng.choice([3e-7, 2e-6, 8e-6])
        keys["casing.out_of_round_angle_rad"] = rng.choice([0, 0.7])
    if rng.random() < 0.3 and keys["solver.contact"] != "bilateral":
        keys["bladed_disk.radial_coupling"] = 0.2
    return keys | {"solver.model": rng.choice(["rigid", "modal", "modal", "full"])}, []


def other_modes(rng):
    keys = machine(rng, 24)
    law(rng, keys, 0.3)
    if rng.random() < 0.5:
        keys["bladed_disk.nodal_diameters"] = rng.randint(0, keys["bladed_disk.blades"] // 2)
        keys["solver.model"] = "modal"
        if keys["solver.contact"] != "bilateral":
            keys["bladed_disk.radial_coupling"] = rng.choice([0, 0.3])
    else:
        keys["bladed_disk.mistuning"] = rng.choice([0.005, 0.02, 0.05])
        keys["bladed_disk.mistuning_seed"] = rng.randint(1, 99)
        keys["solver.model"] = "full"
        keys["solver.end_s"] = min(keys["solver.end_s"], 0.008)
    return keys, []


def changing(rng):
    keys = machine(rng, 26)
    law(rng, keys, 0.2)
    end, speed = keys["solver.end_s"], keys["operation.speed_rad_s"]
    keys["solver.model"] = rng.choice(["rigid", "modal", "modal", "full"])
    at = []
    if rng.random() < 0.6:
        keys["operation.speed_ramp_rad_s2"] = rng.choice([-4000, -400, 400, 8000])
    if rng.random() < 0.3:
        keys["bladed_disk.centrifugal_stiffening"] = rng.choice([0.5, 1.5])
    if rng.random() < 0.2:
        keys["casing.clearance_loss_m_s2"] = 2e-11
    if rng.random() < 0.7:
        at.append(f"{end * 0.31:.6g}:" + rng.choice([
            "pulse",
            f"operation.speed_rad_s={speed * 1.1:.6g}",
            "bladed_disk.damping_ratio=0.02",
            "casing.damping_ratio=0.03",
            "operation.speed_ramp_rad_s2=1000",
            "casing.modal_mass_kg=2.1",
        ]))
    if rng.random() < 0.3:
        at.append(f"{end * 0.62:.6g}:pulse")
    return keys, at


def words(keys, at):
    sets = [f"--set {key}={value!r}".replace("'", "") for key, value in keys.items()]
    return " ".join(["paper-nd3", *sets, *(f"--at {change}" for change in at)])


def accepted(scene):
    command = [PROGRAM, "run", "--plain", "--no-sensitivity", "--solver", "explicit", *scene.split()]
    return subprocess.run(command, capture_output=True, timeout=120).returncode == 0


KINDS = [rigid, modal, full, bilateral, lining, slope_friction, restitution, imperfect, other_modes, changing]
for number, kind in enumerate(KINDS):
    rng = random.Random(2010 + number)
    lines = []
    while len(lines) < EACH:
        scene = words(*kind(rng))
        if accepted(scene):
            lines.append({"name": f"{kind.__name__}-{len(lines):02}", "scene": scene})
    path = HERE / f"{kind.__name__}.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    print(path.name, len(lines))
