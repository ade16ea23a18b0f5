"""Modes, trim, T and control against the command, to the last digit."""

import json

import numpy as np
import pytest

import rotor_hhc
from conftest import FIXTURES, QUICK

PAPER = FIXTURES / "cases/paper_mu030.ron"


def test_the_table_of_the_study_is_that_of_the_command(hhc):
    """The paper's study in its free wake, as bare `hhc` runs it."""
    printed = hhc.json("run", PAPER, "--inflow", "free", "--out", "own")
    with pytest.warns(rotor_hhc.Caution):
        study = rotor_hhc.run(PAPER, inflow="free")
    assert len(study.control) == 9 and study.control == printed["control"]
    assert study.figures == printed
    # and what is stored, loads and voltages of every step
    stored = json.loads((hhc.folder / "own/result.json").read_text())
    assert study.result == stored["result"] and study.key == stored["key"]
    study.save(hhc.folder / "saved")
    again = (hhc.folder / "saved/result.json").read_bytes()
    assert again == (hhc.folder / "own/result.json").read_bytes()
    # the paper's case is what is run where none is named
    at_three = next(line for line in study.control if line["harmonics"] == [3])
    assert 40.0 < at_three["reduction_percent"] < 60.0


def test_a_trim_is_that_of_the_run(hhc):
    found = rotor_hhc.trim(QUICK, advance_ratio=0.25)
    printed = hhc.json("run", QUICK, "--mu", "0.25", "--out", "own")["rows"][0]["result"]
    assert found["controls"] == printed["trim"] and found["residuals"] == printed["residuals"]
    assert found["wake"] is None and found["blades"] == 4
    loads = [printed["baseline"]["hub_nb_per_rev"][name] for name in found["loads"]]
    np.testing.assert_array_equal(found["hub_nb_per_rev"], loads)
    assert found["hub_mean"].shape == (6,) and found["load_unit"][0] != found["load_unit"][5]
    # the thrust carries what the wind-tunnel trim asks for
    assert abs(found["controls"]["ct_sigma"] - 0.07) < 1e-6


def test_t_is_that_of_export(hhc):
    assert hhc("export", QUICK, "--to", "json", "-o", "t").returncode == 0
    document = json.loads((hhc.folder / "t/rotor.json").read_text())
    arrays = {own["name"]: own for own in document["arrays"]}
    found = rotor_hhc.t_matrix(QUICK, 3)
    wanted = np.array(arrays["T_3"]["values"])[:, :, 0]
    assert found["T"].shape == (12, 2 * 2) == (len(found["loads"]), len(found["controls"]))
    np.testing.assert_array_equal(found["T"], wanted)
    np.testing.assert_array_equal(found["baseline"], np.ravel(arrays["baseline"]["values"]))
    # T says what a small voltage does to the loads: the same at another harmonic is another T
    assert not np.allclose(rotor_hhc.t_matrix(QUICK, [2])["T"], wanted)
    with pytest.raises(rotor_hhc.Error, match="case: control.harmonics"):
        rotor_hhc.t_matrix(QUICK, [0])


def test_modes_are_those_of_the_command_and_have_shapes(hhc):
    printed = hhc.json("modes", "--pitch-deg", "8", "--speeds", "0.5")
    found = rotor_hhc.modes(pitch_deg=8.0, speeds=[0.5])
    assert found["kind"] == [mode["kind"] for mode in printed["modes"]]
    assert found["per_rev"].tolist() == [mode["per_rev"] for mode in printed["modes"]]
    assert found["hz"].tolist() == [mode["hz"] for mode in printed["modes"]]
    assert len(found["fan"]) == 1 and found["steady_tip"] == printed["steady_tip"]
    stations = np.linspace(0.0, 1.0, 81)
    found = rotor_hhc.modes(undeformed=True, gyroscopic=False, stations_r=stations)
    shape = found["shape"]
    assert shape.shape == (len(found["kind"]), 81, 3) and not shape.imag.any()
    # nothing moves at the clamped root, the tip of the family moves most and in its positive sense
    assert not shape[:, 0].any()
    column = {"lag": 0, "flap": 1, "torsion": 2}
    for kind in column:
        first = shape[found["kind"].index(kind), :, column[kind]].real
        assert first.argmax() == 80 and first[-1] > 0.0, kind
    # flap modes of a uniform blade without twist of the axes: orthogonal in the mass, here uniform
    flaps = [shape[i] for i, kind in enumerate(found["kind"]) if kind == "flap"][:2]
    parts = [own[:, :2].real for own in flaps]
    product = np.trapezoid((parts[0] * parts[1]).sum(axis=1), stations)
    norms = [np.trapezoid((own * own).sum(axis=1), stations) for own in parts]
    assert abs(product) < 0.02 * np.sqrt(norms[0] * norms[1])


def test_errors_have_the_words_of_the_command(tmp_path, hhc):
    bad = tmp_path / "bad.ron"
    bad.write_text(QUICK.read_text().replace("0.2,", "0.9,").replace("QuasiSteady", "QuasiStedy"))
    cases = [
        (("run", bad), lambda: rotor_hhc.run(bad)),
        (("run", tmp_path / "none.ron"), lambda: rotor_hhc.trim(tmp_path / "none.ron")),
        (("wake", QUICK, "--mu", "0.7"), lambda: rotor_hhc.trim(QUICK, advance_ratio=0.7)),
        (("modes", QUICK, "--pitch-deg", "nan"), lambda: rotor_hhc.modes(QUICK, pitch_deg=np.nan)),
    ]
    for arguments, call in cases:
        ran = hhc(*arguments)
        with pytest.raises(rotor_hhc.Error) as refused:
            call()
        assert str(refused.value) == ran.stderr.strip().removeprefix("error: "), arguments
        assert refused.value.exit_code == ran.returncode == 2
    with pytest.raises(rotor_hhc.Error, match="unknown choice `glauert`; known here: uniform, drees"):
        rotor_hhc.trim(QUICK, inflow="glauert")


def test_other_threads_run_during_a_call():
    import threading

    ended, ticks = threading.Event(), []

    def tick():
        while not ended.wait(1e-3):
            ticks.append(None)

    thread = threading.Thread(target=tick)
    thread.start()
    try:
        rotor_hhc.trim(PAPER)
    finally:
        ended.set()
        thread.join()
    assert len(ticks) > 20, "the interpreter was held"


def test_the_version_is_that_of_the_command(hhc):
    assert hhc("--version").stdout.split()[1] == rotor_hhc.__version__
    from importlib.metadata import version

    assert version("rotor-hhc") == rotor_hhc.__version__
