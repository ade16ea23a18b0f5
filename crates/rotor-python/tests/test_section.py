"""Sections against the command and against themselves."""

import numpy as np
import pytest

import rotor_hhc


@pytest.mark.parametrize("model", ["quasi-steady", "incompressible", "hariharan-leishman", "calibrated"])
def test_amplitudes_are_those_of_the_command(model, hhc):
    mach = 0.0 if model == "incompressible" else 0.4
    options = {"motion": "pitch", "model": model, "mach": mach, "flap_chord": 0.25}
    found = rotor_hhc.section_response([0.1, 0.3], effectiveness=(0.8, 0.9, 1.0), **options)
    given = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
    printed = hhc.json("section", "--reduced-frequency", 0.3, "--effectiveness", "0.8,0.9,1", *given)
    for load in ("cn", "cm", "ch"):
        assert found[load].dtype == np.complex128
        assert [found[load][1].real, found[load][1].imag] == printed[load]
    assert set(printed["remarks"]) <= set(found["remarks"])


def test_a_history_settles_on_the_response_at_its_frequency():
    k, per_cycle, cycles = 0.2, 360, 30
    step = 2.0 * np.pi / k / per_cycle
    phase = k * step * np.arange(cycles * per_cycle)
    flap, still = 0.05 * np.sin(phase), np.zeros(phase.size)
    last = slice(-per_cycle, -2)
    for motion, angles in [("flap", (still, flap)), ("pitch", (flap, still)), ("plunge", (flap, still))]:
        found = rotor_hhc.section_history(step, *angles, pitching=motion == "pitch", mach=0.3)
        exact = rotor_hhc.section_response(k, motion=motion, mach=0.3)
        for load in ("cn", "cm", "ch"):
            wanted = 0.05 * (exact[load][0] * np.exp(1j * phase)).imag
            error = np.abs(found[load] - wanted)[last].max() / np.abs(0.05 * exact[load][0])
            assert error < 1e-3, (motion, load, error)
    assert found["s_semichords"][3] == 3.0 * step


def test_what_is_out_of_range_has_the_words_of_the_command(hhc):
    said = hhc("section", "--reduced-frequency", "0.1", "--mach", "1.2").stderr.strip().removeprefix("error: ")
    with pytest.raises(rotor_hhc.Error) as refused:
        rotor_hhc.section_response(0.1, mach=1.2)
    assert str(refused.value) == said
    with pytest.raises(rotor_hhc.Error, match=r"reduced_frequency\[2\]: .*0 to 1000"):
        rotor_hhc.section_response([0.1, 0.2, -0.1])
    with pytest.raises(rotor_hhc.Error, match="unknown choice `glide`; known here: flap, pitch, plunge"):
        rotor_hhc.section_response(0.1, motion="glide")
    with pytest.raises(rotor_hhc.Error, match="as many as of the incidence"):
        rotor_hhc.section_history(0.5, np.zeros(5), np.zeros(4))
