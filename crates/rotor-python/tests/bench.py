"""A small bench made here: plays behind a lag."""

import numpy as np

STEP_S = 1e-3


def displacement_um(command_volt):
    """The sum of a gain and four plays, um."""
    moved = 1.2 * command_volt
    for half_width in (5.0, 15.0, 30.0, 50.0):
        middle, play = command_volt[0], np.empty_like(command_volt)
        for n, volt in enumerate(command_volt):
            middle = min(max(middle, volt - half_width), volt + half_width)
            play[n] = middle
        moved = moved + 0.25 * play
    return moved


def run(frequency_hz, amplitude_volt):
    """Four cycles about 65 V: time, command, displacement."""
    time_s = np.arange(0.0, 4.0 / frequency_hz, STEP_S * max(1.0, 1.0 / frequency_hz))
    command_volt = 65.0 + amplitude_volt * np.sin(2.0 * np.pi * frequency_hz * time_s)
    return time_s, command_volt, displacement_um(command_volt)


def runs():
    """Two frequencies, three amplitudes."""
    return {
        f"sine_{hertz}hz_{volt}v": run(float(hertz), float(volt))
        for hertz in (1, 10)
        for volt in (30, 55, 80)
    }


def write(folder, named, gain):
    """The same as a data folder."""
    folder.mkdir()
    entries = ""
    for name, columns in named.items():
        rows = "".join(f"{t!r},{u!r},{x!r}\n" for t, u, x in zip(*(c.tolist() for c in columns)))
        (folder / f"{name}.csv").write_text("time_s,command_V,displacement_um\n" + rows)
        entries += f'(id: "{name}", file: "{name}.csv", role: Reference),\n'
    (folder / "dataset.ron").write_text(
        f'(kind: ActuatorBench, title: "made here", flap_deg_per_um: Some({gain}), runs: [{entries}])'
    )
