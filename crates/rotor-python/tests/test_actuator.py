"""Identification, simulation and inverse against the command."""

import numpy as np
import pytest

import bench
import rotor_hhc

GAIN = 0.04


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "bench"
    bench.write(folder, bench.runs(), GAIN)
    return folder


@pytest.fixture(scope="module")
def found(folder):
    return rotor_hhc.identify(folder)


@pytest.fixture
def file(found, tmp_path):
    path = tmp_path / "actuator.ron"
    found.save(path)
    return path


def test_a_folder_gives_what_the_command_prints(found, folder, hhc):
    printed = hhc.json("identify", folder, "-o", "own.ron")
    own = found.summary
    for name in ("written_to", "page_written_to"):
        assert own.pop(name) is None and printed.pop(name)
    assert own == printed
    assert (hhc.folder / "own.ron").read_text().split("model:")[1]
    assert rotor_hhc.Actuator.load(hhc.folder / "own.ron").model == found.model


def test_runs_in_memory_are_the_same_runs(found):
    own = rotor_hhc.identify(bench.runs(), title="made here", flap_deg_per_um=GAIN)
    assert own.model == found.model and own.runs == found.runs
    assert own.title == "made here" and own.range_volt == (-20.0, 150.0)
    # a list is as good as an array, a model can be asked for
    listed = {name: [column.tolist() for column in run] for name, run in bench.runs().items()}
    own = rotor_hhc.identify(listed, model="static-preisach", flap_deg_per_um=GAIN)
    assert "StaticPreisach" in own.model["law"]
    worst = max(run["nrmse_percent"] for run in own.runs)
    assert worst < 2.0, worst


def test_runs_are_held_against_one_another():
    turned = bench.runs()
    time_s, command_volt, displacement_um = turned["sine_1hz_55v"]
    turned["sine_1hz_55v"] = (time_s, command_volt, -displacement_um)
    with pytest.warns(UserWarning, match="falls as the command rises in sine_1hz_55v, and rises in"):
        rotor_hhc.identify(turned, model="static-preisach", flap_deg_per_um=GAIN)


def test_a_file_read_again_is_the_same_actuator(found, file):
    again = rotor_hhc.Actuator.load(file)
    assert (again.model, again.title, again.runs) == (found.model, found.title, found.runs)
    assert again.deg_per_um == GAIN and again.channels == ("command_V", "displacement_um")
    assert again.summary is None and "made here" in repr(again)
    # a file of another kind is not replaced
    other = file.with_name("notes.ron")
    other.write_text("(kind: Notes)")
    with pytest.raises(rotor_hhc.Error) as refused:
        found.save(other)
    assert other.read_text() == "(kind: Notes)" and "notes.ron" in str(refused.value)
    found.save(other, force=True)
    assert rotor_hhc.Actuator.load(other).model == found.model


def test_a_simulation_has_the_numbers_of_predict(found, file, hhc):
    time_s, command_volt, _ = bench.run(5.0, 40.0)
    rows = "".join(f"{t!r},{u!r}\n" for t, u in zip(time_s.tolist(), command_volt.tolist()))
    (hhc.folder / "record.csv").write_text("time_s,command_V\n" + rows)
    ran = hhc("predict", file, "--input", "record.csv", "-o", "out.csv")
    assert ran.returncode == 0, ran.stderr
    printed = np.loadtxt(hhc.folder / "out.csv", delimiter=",", skiprows=1)
    moved = found.simulate(time_s, command_volt)
    assert moved.dtype == np.float64 and moved.flags.writeable
    np.testing.assert_array_equal(moved, printed[:, 2])
    # every second sample of an array of two columns: no view is taken for its base
    both = np.column_stack([command_volt, -command_volt])
    np.testing.assert_array_equal(found.simulate(time_s, both[:, 0]), moved)
    angle = found.simulate(time_s, command_volt, angle=True)
    np.testing.assert_allclose(angle - angle[0], GAIN * (moved - moved[0]), atol=1e-9)


def test_an_inverse_has_the_numbers_of_invert(found, file, hhc):
    time_s = np.arange(400) * 2e-3
    wanted = 120.0 + 20.0 * np.minimum(time_s / 0.1, 1.0) * np.sin(40.0 * time_s)
    rows = "".join(f"{t!r},{x!r}\n" for t, x in zip(time_s.tolist(), wanted.tolist()))
    (hhc.folder / "wanted.csv").write_text("time_s,displacement_um\n" + rows)
    told = hhc.json("invert", file, "--wanted", "wanted.csv", "-o", "out.csv")
    printed = np.loadtxt(hhc.folder / "out.csv", delimiter=",", skiprows=1)
    inverse = found.invert(time_s, wanted)
    np.testing.assert_array_equal(inverse.command_volt, printed[:, 1])
    np.testing.assert_array_equal(inverse.moved, printed[:, 2])
    figures = (inverse.rms, inverse.largest, inverse.nrmse_percent)
    assert figures == tuple(told["error"][name] for name in ("rms", "largest", "nrmse_percent"))
    assert (inverse.at_limit, inverse.simulations) == (told["at_limit"], told["simulations"])
    assert inverse.nrmse_percent < 0.5
    # forward again
    moved = found.simulate(time_s, inverse.command_volt)
    np.testing.assert_allclose(moved, inverse.moved, atol=1e-9)


def test_bad_arrays_are_refused_with_their_name(found):
    time_s, command_volt, _ = bench.run(1.0, 30.0)
    for arguments, words in [
        ((time_s, command_volt[:-1]), ("command_volt", "give one for each time")),
        ((time_s[:1], command_volt[:1]), ("time_s[0]", "give two or more")),
        ((np.square(time_s), command_volt), ("time_s[1]", "give evenly spaced samples")),
        ((time_s, 10.0 * command_volt), ("command_volt", "outside the actuator's range")),
        ((time_s, np.where(time_s > 1.0, np.nan, command_volt)), ("command_volt", "NaN")),
        ((time_s, np.tile(command_volt, (2, 1))), ("command_volt", "one dimension")),
    ]:
        with pytest.raises(rotor_hhc.Error) as refused:
            found.simulate(*arguments)
        assert all(word in str(refused.value) for word in words), str(refused.value)
        assert refused.value.exit_code == 2
    with pytest.raises(ValueError):
        found.simulate(time_s, ["fast"] * len(time_s))


def test_bad_runs_are_told_as_those_of_a_folder():
    named = bench.runs()
    time_s, command_volt, displacement_um = named["sine_1hz_30v"]
    displacement_um = displacement_um.copy()
    displacement_um[7] = np.nan
    named["sine_1hz_30v"] = (time_s, command_volt, displacement_um)
    with pytest.raises(rotor_hhc.Error, match=r"arrays/sine_1hz_30v.csv:9.*displacement_um"):
        rotor_hhc.identify(named)
    with pytest.raises(rotor_hhc.Error, match="arrays/a: .*2 arrays, expected time_s, command_V"):
        rotor_hhc.identify({"a": (time_s, command_volt)})
    # of many runs, the one that fails is named
    for columns, words in [
        ((time_s, command_volt[1:], displacement_um), "command_V.*give one for each time"),
        ((time_s, command_volt, displacement_um[None, :]), "displacement_um.*one dimension"),
        ((time_s, ["fast"] * time_s.size, displacement_um), "command_V.*give real numbers"),
        ((time_s, command_volt, [[1.0], [2.0, 3.0]]), "displacement_um"),
    ]:
        with pytest.raises(rotor_hhc.Error, match=f"arrays/sine_10hz_30v: {words}"):
            rotor_hhc.identify({**bench.runs(), "sine_10hz_30v": columns})
    with pytest.raises(rotor_hhc.Error, match="unknown choice `best-of-all`; known here: .*bouc-wen"):
        rotor_hhc.identify(bench.runs(), model="best-of-all")
    with pytest.raises(rotor_hhc.Error, match="give them there"):
        rotor_hhc.identify("anywhere", title="a title")
    with pytest.raises(rotor_hhc.Error, match="at least one run"):
        rotor_hhc.identify({})


def test_what_the_command_warns_of_is_a_warning():
    named = bench.runs()
    with pytest.warns(rotor_hhc.Caution, match="deg/um was assumed"):
        own = rotor_hhc.identify(named, model="static-preisach")
    assert any("deg/um was assumed" in text for text in own.warnings)
