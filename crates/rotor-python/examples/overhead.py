"""What the way through Python costs on a call of a million samples: python overhead.py [ACTUATOR.ron]

In: a call that is refused at its last sample, after its arrays were taken over and checked, before anything is simulated.
Out: an array of the same size, read from an answer. Both together are more than what Python adds, since the checks are made
in Rust too. Bar: 10 % of the whole call.
"""

import pathlib
import sys
import time

import numpy as np

import rotor_hhc

SAMPLES, ROUNDS, BAR_PERCENT = 1_000_000, 7, 10.0
ROOT = pathlib.Path(__file__).resolve().parents[3]


def best_s(call):
    """The shortest of some calls."""
    taken = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        call()
        taken.append(time.perf_counter() - begun)
    return min(taken)


if len(sys.argv) > 1:
    actuator = rotor_hhc.Actuator.load(sys.argv[1])
else:
    actuator = rotor_hhc.identify(ROOT / "fixtures/bench/apa500l_synthetic")
time_s = np.arange(SAMPLES) * 1e-4
low, high = actuator.range_volt
command_volt = 0.5 * (low + high) + 0.2 * (high - low) * (np.sin(63.0 * time_s) + np.cos(94.0 * time_s))
beyond_volt = command_volt.copy()
beyond_volt[-1] = high + 1000.0


def refused():
    """Takes the arrays over, and ends there."""
    try:
        actuator.simulate(time_s, beyond_volt)
    except rotor_hhc.Error as error:
        assert f"sample {SAMPLES - 1}" in str(error), error
    else:
        raise AssertionError("the last sample was not refused")


moved = actuator.simulate(time_s, command_volt)
inverse = actuator.invert(time_s, moved)
whole = best_s(lambda: actuator.simulate(time_s, command_volt))
into, out = best_s(refused), best_s(lambda: inverse.command_volt)
print(f"{actuator.title}: {1e9 * whole / SAMPLES:.1f} ns per sample, {whole:.3f} s for {SAMPLES} samples")
percent = 100.0 * (into + out) / whole
print(f"in {1e3 * into:.1f} ms, out {1e3 * out:.1f} ms: {percent:.1f} % of the call (bar {BAR_PERCENT} %)")
