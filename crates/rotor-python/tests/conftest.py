"""The command beside the package: what one prints the other gives."""

import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
FIXTURES = ROOT / "fixtures"
QUICK = ROOT / "crates/sim-driver/tests/command/quick.ron"


class Command:
    """`hhc` in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder
        self.program = os.environ.get("HHC")
        assert self.program, "set HHC to the path of the program hhc, such as target/release/hhc"

    def __call__(self, *arguments):
        given = [self.program, *map(str, arguments)]
        return subprocess.run(given, cwd=self.folder, capture_output=True, text=True, check=False)

    def json(self, *arguments):
        """What it prints with `--format json`."""
        ran = self(*arguments, "--format", "json")
        assert ran.returncode == 0, ran.stderr
        return json.loads(ran.stdout)


@pytest.fixture
def hhc(tmp_path):
    return Command(tmp_path)
