"""The tolerance study of benches/studies.rs as a vectorised NumPy script, on two threads.

    python3 benches/tolerance.py SAMPLES

The same formulas as method `exact` with the tooth compliance of Kuang and Yang and the contact compliance of Eq. 55,
in arrays of 4096 samples that stay in the cache. NumPy lets the threads run side by side. Prints the percentiles, the
probabilities and the seconds without the start of Python.
"""

import json
import math
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

Z, M, ALPHA, B, BORE = 20, 5e-3, math.radians(20), 8e-3, 20e-3
YOUNG, POISSON, DENSITY = 205e9, 0.3, 7800.0
SPEED = 2000 * math.pi / 30
RB = M * Z / 2 * math.cos(ALPHA)
RA = M * (Z / 2 + 1)
A = M * Z
ALPHA_W = math.acos(2 * RB / A)
TIP = math.sqrt(RA**2 - RB**2)
START = A * math.sin(ALPHA_W) - TIP
PITCH = math.pi * M * math.cos(ALPHA)
TANGENT = A * math.sin(ALPHA_W)
GAMMA = math.acos(RB / RA) - ALPHA_W
GIVE = 2 * (1 - POISSON**2) / YOUNG
C = 3.867 + 1.612 * Z - 0.02916 * Z**2 + 0.0001553 * Z**3
D = 2.637 - 1.222 * Z + 0.02217 * Z**2 - 0.0001179 * Z**3
MASS = math.pi * DENSITY * B / 2 * (RB**4 - BORE**4) / RB**2
CHUNK = 4096


def tooth(radius):
    return 1 / (1e9 * (C + D * (radius - M * Z / 2) / M))


def contact(force, curvature):
    half_width = np.sqrt(4 * force / B * curvature * GIVE / math.pi)
    return GIVE / math.pi * (1.27 + 0.781 * np.log(M / half_width))


def tip(u):
    """The gap S, the drop of rb2' and the curvature radius on the driver."""
    chord = 4 * A * RA * np.sin(u / 2) * np.sin(GAMMA + u / 2)
    rho = np.sqrt(START**2 + chord)
    ahead = chord / (rho + START)
    eta = GAMMA + u
    psi = np.arctan2(RA * np.sin(eta), A - RA * np.cos(eta)) - PSI_E
    chi = psi + np.arctan2(RB * ahead, RB**2 + rho * START)
    drop = 2 * A * np.sin(ALPHA_W + chi / 2) * np.sin(chi / 2)
    return ahead + RB * u - RB * chi, drop, rho


PSI_E = math.atan2(RA * math.sin(GAMMA), A - RA * math.cos(GAMMA))
ALONG = START + PITCH
DELTA_TEETH = tooth(math.hypot(RB, ALONG)) + tooth(math.hypot(RB, TANGENT - ALONG))
DELTA_CURVATURE = ALONG * (TANGENT - ALONG) / TANGENT
BEND = (START + TIP) * TIP / START
TIP_TOOTH = tooth(RA)


def force(base_pitch, power, relief):
    mesh_force = power / SPEED / RB
    deflection = mesh_force / B * (DELTA_TEETH + contact(mesh_force, DELTA_CURVATURE))
    total = 2 * base_pitch / math.sqrt(2) - relief + deflection
    strikes = total > 0
    total = np.where(strikes, total, 1e-6)
    u = np.sqrt(2 * total / BEND)
    for _ in range(3):
        gap, drop, _ = tip(u)
        u = u * np.exp(np.log(total / gap) * gap / (u * drop))
    _, drop, rho = tip(u)
    teeth = tooth(np.sqrt(RB**2 + rho**2)) + TIP_TOOTH
    curvature = rho * TIP / (rho + TIP)
    arm = (RB - drop) / RB
    mass = MASS * MASS / (MASS * arm * arm + MASS)
    momentum = SPEED * drop * np.sqrt(B * mass)
    found = momentum / np.sqrt(teeth)
    for _ in range(4):
        found = momentum / np.sqrt(teeth + contact(found, curvature))
    return np.where(strikes, found, np.nan)


def chunk(seed, count):
    random = np.random.default_rng(seed)
    return force(
        random.normal(16e-6, 2e-6, count),
        random.uniform(14e3, 16e3, count),
        random.normal(24e-6, 3e-6, count),
    )


def main(samples):
    begin = time.perf_counter()
    counts = [min(CHUNK, samples - first) for first in range(0, samples, CHUNK)]
    seeds = np.random.SeedSequence(7).spawn(len(counts))
    with ThreadPoolExecutor(2) as pool:
        values = np.concatenate(list(pool.map(chunk, seeds, counts)))
    struck = values[~np.isnan(values)]
    percentiles = np.percentile(struck, [5, 50, 95])
    print(
        json.dumps(
            {
                "percentiles": percentiles.tolist(),
                "mean": struck.mean(),
                "corner_contact": len(struck) / samples,
                "exceeded": float((struck > 1000).sum() / samples),
                "seconds": time.perf_counter() - begin,
            }
        )
    )


main(int(sys.argv[1]))
