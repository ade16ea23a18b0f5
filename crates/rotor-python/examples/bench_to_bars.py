"""From bench files to the bar chart: what the actuators of a bench leave of a rotor's vibration.

    python bench_to_bars.py [BENCH] [-o OUT] [--inflow free]

The cells below run one after another in a notebook too. Without BENCH the shipped synthetic one is used. The chart is
drawn by matplotlib if it is there, else written as SVG by hand.
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

# %% the chart
names, kinds = list(left), list(next(iter(left.values())))
title = "What control leaves of the vibration index J, percent"
try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4))
    for i, kind in enumerate(kinds):
        places = np.arange(len(names)) + 0.8 * (i - 0.5 * (len(kinds) - 1)) / len(kinds)
        axes.bar(places, [left[name][kind] for name in names], 0.8 / len(kinds), label=kind)
    axes.set_xticks(range(len(names)), names)
    axes.axhline(100.0, color="black", linewidth=0.8)
    axes.set_ylabel("J with control over J without, %")
    axes.set_title(title)
    axes.legend()
    chart = asked.out / "bars.png"
    figure.savefig(chart, dpi=150, bbox_inches="tight")
except ImportError:
    colours = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee"]
    tallest = max(100.0, max(max(bars.values()) for bars in left.values()))
    width, height, foot = 120 * len(names) + 160, 300, 250
    parts = [f'<text x="20" y="20">{title}</text>']
    for i, name in enumerate(names):
        for j, kind in enumerate(kinds):
            tall = 200.0 * left[name][kind] / tallest
            wide = 96.0 / len(kinds)
            x, y = 20 + 120 * i + wide * j, foot - tall
            colour = colours[j % len(colours)]
            parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{wide - 2:.1f}" height="{tall:.1f}" fill="{colour}"/>')
            parts.append(f'<text x="{x:.1f}" y="{y - 4:.1f}" font-size="10">{left[name][kind]:.0f}</text>')
        parts.append(f'<text x="{20 + 120 * i}" y="{foot + 18}">{name}</text>')
    for j, kind in enumerate(kinds):
        x, y = 120 * len(names) + 30, 60 + 20 * j
        parts.append(f'<rect x="{x}" y="{y - 10}" width="12" height="12" fill="{colours[j % len(colours)]}"/>')
        parts.append(f'<text x="{x + 18}" y="{y}">{kind}</text>')
    body = "\n".join(parts)
    chart = asked.out / "bars.svg"
    chart.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" font-size="12">\n{body}\n</svg>\n'
    )
print(f"actuator, result and chart in {asked.out}: {chart.name}")
