"""From bench files to the bar chart: what the actuators of a bench leave of a rotor's vibration.

    python bench_to_bars.py [BENCH] [-o OUT] [--inflow free]

The cells below run one after another in a notebook too. Without BENCH the shipped synthetic one is used.
"""

# %% what is asked
import argparse
import pathlib

import numpy as np

import rotor_hhc

ROOT = pathlib.Path(__file__).resolve().parents[3]
asked = argparse.ArgumentParser(description="From bench files to the bar chart.")
asked.add_argument("bench", nargs="?", default=ROOT / "fixtures/bench/apa500l_synthetic", type=pathlib.Path)
asked.add_argument("-o", "--out", default=pathlib.Path("out/bars"), type=pathlib.Path)
asked.add_argument("--inflow", default="drees", help="uniform, drees, pitt-peters or free")
asked = asked.parse_args()
asked.out.mkdir(parents=True, exist_ok=True)

# %% bench files to an actuator: every model is fitted, cross-validation chooses
actuator = rotor_hhc.identify(asked.bench)
actuator.save(asked.out / "actuator.ron")
print(f"{actuator.title}: {actuator.summary['model']}")
for run in actuator.runs:
    if run["use"] == "HeldOut":
        print(f"  {run['id']}: {run['nrmse_percent']:.1f} % of the deviation, held out")

# %% the actuator alone: 5 Hz about the middle of its range, and the voltage that moves the flap by a sine
time_s = np.arange(0.0, 1.0, 1e-3)
low, high = actuator.range_volt
command = 0.5 * (low + high) + 0.25 * (high - low) * np.sin(2.0 * np.pi * 5.0 * time_s)
flap_deg = actuator.simulate(time_s, command, angle=True)
sine_deg = flap_deg.mean() + 0.4 * np.ptp(flap_deg) * np.sin(2.0 * np.pi * 5.0 * time_s)
inverse = actuator.invert(time_s, sine_deg, angle=True)
print(f"flap {np.ptp(flap_deg):.1f} deg peak to peak; a sine of it to {inverse.nrmse_percent:.2f} % rms")

# %% on the rotor: the paper's case with this actuator
study = rotor_hhc.run(asked.out / "actuator.ron", inflow=asked.inflow)
study.save(asked.out)
left = {}
for line in study.control:
    name = "/".join(str(harmonic) for harmonic in line["harmonics"]) + "/rev"
    left.setdefault(name, {})[line["actuator"]] = 100.0 - line["reduction_percent"]
for name, bars in left.items():
    print(name, ", ".join(f"{actuator} {percent:.1f} %" for actuator, percent in bars.items()))

# %% the chart, as SVG by hand: any plotting package does with `left` what it likes
kinds = list(next(iter(left.values())))
colours = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee"]
tallest = max(100.0, *(percent for bars in left.values() for percent in bars.values()))
parts = ['<text x="20" y="20">What control leaves of the vibration index J, percent</text>']
for i, (name, bars) in enumerate(left.items()):
    parts.append(f'<text x="{20 + 120 * i}" y="268">{name}</text>')
    for j, kind in enumerate(kinds):
        tall, wide = 200.0 * bars[kind] / tallest, 96.0 / len(kinds)
        x, y, colour = 20 + 120 * i + wide * j, 250.0 - tall, colours[j % len(colours)]
        parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{wide - 2:.1f}" height="{tall:.1f}" fill="{colour}"/>')
        parts.append(f'<text x="{x:.1f}" y="{y - 4:.1f}" font-size="10">{bars[kind]:.0f}</text>')
for j, kind in enumerate(kinds):
    parts.append(f'<text x="{120 * len(left) + 30}" y="{60 + 20 * j}" fill="{colours[j % len(colours)]}">{kind}</text>')
box = f'viewBox="0 0 {120 * len(left) + 180} 300" font-family="sans-serif" font-size="12"'
body = "\n".join(parts)
chart = asked.out / "bars.svg"
chart.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {box}>\n{body}\n</svg>\n')
print(f"actuator, result and chart in {asked.out}: {chart.name}")
