"""A diagnosis against the command."""

import json

import pytest

import rotor_hhc
from conftest import FIXTURES, QUICK

BENCH = FIXTURES / "bench/everyday_synthetic"


def test_findings_are_those_of_the_command(hhc):
    actuator = rotor_hhc.identify(BENCH / "reference", model="static-preisach")
    actuator.save(hhc.folder / "actuator.ron")
    ran = hhc("diagnose", "actuator.ron", "--data", BENCH / "a", "-o", "out")
    assert ran.returncode == 0, ran.stderr
    found = rotor_hhc.diagnose(BENCH / "a", actuator, cache=hhc.folder / "own")
    assert found.findings == json.loads((hhc.folder / "out/findings.json").read_text())
    assert found.text.strip() == ran.stdout.strip()
    extended = rotor_hhc.Actuator.load(hhc.folder / "out/extended.ron")
    assert found.extended.model == extended.model


def test_points_of_test_need_a_case(hhc, tmp_path):
    points = tmp_path / "points"
    points.mkdir()
    (points / "dataset.ron").write_text(
        '(kind: RotorSweep, title: "t", runs: [(id: "a", file: "a.csv", role: Measured)])'
    )
    (points / "a.csv").write_text("advance_ratio,theta0_deg\n0.1,8\n0.2,9\n0.3,10\n")
    with pytest.raises(rotor_hhc.Error, match="give its path"):
        rotor_hhc.diagnose(points)
    with pytest.raises(rotor_hhc.Error) as refused:
        rotor_hhc.diagnose(tmp_path / "none", QUICK)
    said = hhc("diagnose", QUICK, "--data", tmp_path / "none", "-o", "out").stderr.strip().removeprefix("error: ")
    assert str(refused.value) == said
