"""Vibration control of a helicopter rotor with trailing-edge flaps on hysteretic piezo actuators.

Units stand in the names. Rotor units (``m0 Omega^2 R^2``, ``m0 Omega^2 R^3``) where a name has none; ``load_unit`` holds
their size in N and N m. Whatever stops a call raises :class:`Error` with the text of the command ``hhc``; whatever the
command warns of is a :class:`Caution`.
"""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
MODEL_VERSION: str
"""Version of the model: results of equal keys are equal."""

Path = Union[str, PathLike[str]]
Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Inflow = Literal["uniform", "drees", "pitt-peters", "free"]
SectionModel = Literal["quasi-steady", "incompressible", "hariharan-leishman", "calibrated"]

class Error(ValueError):
    """What stops the command ``hhc``, in its words."""

    exit_code: int
    """That of the command: 1 the numerics failed, 2 bad input, 3 a comparison failed."""

class Caution(UserWarning):
    """What the command ``hhc`` warns of, in its words."""

class Actuator:
    """An actuator: what its flap does under a voltage."""

    @staticmethod
    def load(path: Path) -> Actuator:
        """Reads an actuator file, of ``hhc identify``, of :meth:`save` or written by hand."""

    def save(self, path: Path, *, force: bool = False) -> None:
        """Writes the actuator file; another file than that of an actuator is replaced with ``force`` only."""

    def simulate(self, time_s: ArrayLike, command_volt: ArrayLike, *, angle: bool = False) -> Floats:
        """The motion under a command, at rest at its first sample.

        ``time_s`` is evenly spaced. Gives the displacement, um, as its sensor reads it; with ``angle`` the flap angle,
        deg. A model of two other channels has their units instead.
        """

    def invert(self, time_s: ArrayLike, wanted: ArrayLike, *, angle: bool = False) -> Inverse:
        """The voltage under which it moves as wanted: a displacement, um, or with ``angle`` a flap angle, deg.

        What is out of reach stays as error of the answer; it raises nothing.
        """

    @property
    def title(self) -> str:
        """One line about the data it was identified from."""

    @property
    def channels(self) -> tuple[str, str]:
        """Names of input and output with their units."""

    @property
    def range_volt(self) -> tuple[float, float]:
        """Voltages it knows, V: lowest and highest."""

    @property
    def deg_per_um(self) -> float:
        """Flap angle per displacement, deg/um."""

    @property
    def model(self) -> dict[str, Any]:
        """Law, stages and calibration with all parameters."""

    @property
    def runs(self) -> list[dict[str, Any]]:
        """How it fits every run: side of the split, frequency, NRMSE in percent, gain and phase errors."""

    @property
    def summary(self) -> dict[str, Any] | None:
        """What ``hhc identify --format json`` prints: parameters with deviations, models side by side; None of a file."""

    @property
    def warnings(self) -> list[str]:
        """What a reader should know about data and model."""

class Inverse:
    """A voltage under which an actuator moves as wanted, and what is left of the wanted motion."""

    @property
    def command_volt(self) -> Floats:
        """Voltage at every sample, V."""

    @property
    def moved(self) -> Floats:
        """Motion under it, in the unit of the wanted one."""

    @property
    def rms(self) -> float:
        """Rms of the motion less the wanted one, in its unit."""

    @property
    def largest(self) -> float:
        """The largest difference, in its unit."""

    @property
    def nrmse_percent(self) -> float:
        """Rms over the standard deviation of the wanted motion, percent."""

    @property
    def at_limit(self) -> int:
        """Samples whose voltage is an end of the range: the motion is out of reach there."""

    @property
    def simulations(self) -> int:
        """Simulations it took."""

def identify(
    data: Path | Mapping[str, Sequence[ArrayLike]],
    *,
    model: str = "best",
    start: Path | None = None,
    title: str | None = None,
    command_range_volt: tuple[float, float] | None = None,
    flap_deg_per_um: float | None = None,
) -> Actuator:
    """Identifies an actuator.

    ``data``: a folder with ``dataset.ron``, or runs in memory: a dictionary from names to arrays of time (s), command (V)
    and displacement (um). Both are checked alike. ``title``, ``command_range_volt`` (-20 to 150 V if left out) and
    ``flap_deg_per_um`` are for runs in memory; a folder says them itself. ``model`` is a family by its name at
    ``hhc identify --model``; ``start`` an actuator file whose settings are taken up.
    """

class SectionAmplitudes(TypedDict):
    reduced_frequency: Floats
    cn: Complexes
    cm: Complexes
    ch: Complexes
    remarks: list[str]

class SectionHistory(TypedDict):
    s_semichords: Floats
    cn: Floats
    cm: Floats
    ch: Floats
    remarks: list[str]

def section_response(
    reduced_frequency: ArrayLike,
    *,
    motion: Literal["flap", "pitch", "plunge"] = "flap",
    model: SectionModel | str = "calibrated",
    mach: float = 0.0,
    flap_chord: float = 0.2,
    effectiveness: tuple[float, float, float] | None = None,
) -> SectionAmplitudes:
    """Complex amplitudes of normal force, moment about c/4 and hinge moment for a motion of 1 rad (plunge: ``h_dot/U = 1``).

    ``reduced_frequency``: ``omega c / (2 U)``, 0 to 1000. ``effectiveness``: factors of the flap in lift, moment and hinge
    moment.
    """

def section_history(
    step_semichords: float,
    incidence_rad: ArrayLike,
    flap_rad: ArrayLike,
    *,
    pitching: bool = True,
    model: SectionModel | str = "calibrated",
    mach: float = 0.0,
    flap_chord: float = 0.2,
    effectiveness: tuple[float, float, float] | None = None,
) -> SectionHistory:
    """Loads under histories of incidence and flap angle, attached flow.

    A sample every ``step_semichords`` of travel (``2 U t / c``); before the first one both angles were held. With
    ``pitching`` the incidence changes by pitching about c/4, else by plunging. The error falls with the square of the step.
    """

class Modes(TypedDict):
    kind: list[str]
    per_rev: Floats
    hz: Floats
    energy: Floats
    stations_r: Floats
    shape: Complexes
    rotor_speed_rad_s: float
    steady_tip: dict[str, float] | None
    fan: list[dict[str, Any]]
    warnings: list[str]

def modes(
    case: Path | None = None,
    *,
    pitch_deg: float = 0.0,
    gyroscopic: bool = True,
    undeformed: bool = False,
    speeds: ArrayLike | None = None,
    stations_r: ArrayLike | None = None,
) -> Modes:
    """Rotating modes of the blade of a case; of the paper's without one.

    ``energy[mode]``: shares of flap, lag, torsion, axial motion. ``shape[mode, station]``: lag and flap over R and twist in
    rad, real part in phase, imaginary part a quarter of a cycle ahead, of unit modal mass. ``speeds``: further rotor speeds
    over the nominal one, in ``fan``.
    """

class Trim(TypedDict):
    controls: dict[str, float]
    residuals: dict[str, float]
    wake: str | None
    loads: list[str]
    hub_mean: Floats
    hub_nb_per_rev: Floats
    blades: int
    load_unit: Floats
    warnings: list[str]

def trim(
    case: Path | None = None, *, inflow: Inflow | str | None = None, advance_ratio: float | None = None
) -> Trim:
    """Trims a case with its flaps at rest.

    ``hub_nb_per_rev[load]``: cosine and sine at the blade number per rev, rotor units; times ``load_unit`` in N and N m.
    Hub axes X aft, Y starboard, Z up. ``wake``: how a free wake ended, None without one.
    """

class TMatrix(TypedDict):
    T: Floats
    loads: list[str]
    controls: list[str]
    baseline: Floats
    load_unit: Floats
    conditions: dict[str, float]
    notes: list[str]
    warnings: list[str]

def t_matrix(
    case: Path | None = None,
    harmonics: int | Sequence[int] | None = None,
    *,
    inflow: Inflow | str | None = None,
    advance_ratio: float | None = None,
) -> TMatrix:
    """``T[load, control]``: change of the hub loads (rotor units) per V at the trim of a case, for harmonics per rev.

    Without harmonics the first set of the case. The same numbers as ``hhc export --to json`` of a case without a flight.
    """

class Study:
    """A case that was run."""

    @property
    def figures(self) -> dict[str, Any]:
        """What ``hhc run --format json`` prints: trim, loads, stability, control, costs."""

    @property
    def control(self) -> list[dict[str, Any]]:
        """The control table: an entry for each set of harmonics and actuator, with J before and after."""

    @property
    def result(self) -> dict[str, Any]:
        """What is stored, every number once: ``result`` of ``result.json``."""

    @property
    def key(self) -> str:
        """Equal keys are equal results."""

    @property
    def warnings(self) -> list[str]:
        """What a reader should know before using the numbers."""

    def save(self, folder: Path) -> None:
        """Writes ``result.json`` into a folder; ``hhc report FOLDER`` makes report and tables of it."""

def run(
    case: Path | None = None, *, inflow: Inflow | str | None = None, advance_ratio: float | None = None
) -> Study:
    """Trims a case and controls its vibration with every actuator it names, as ``hhc run`` does.

    An actuator file stands for the paper's case with that actuator.
    """

class Diagnosis:
    """What was found: what is missing, how sure that is, and the model with it."""

    @property
    def findings(self) -> dict[str, Any]:
        """What ``findings.json`` of ``hhc diagnose`` holds: verdict, causes, parameters, gain, next experiment."""

    @property
    def text(self) -> str:
        """What ``hhc diagnose`` prints."""

    @property
    def extended(self) -> Actuator | None:
        """The actuator with what was found; None of points of test."""

    @property
    def warnings(self) -> list[str]:
        """What a reader should know about the data."""

def diagnose(
    data: Path,
    model: Actuator | Path | None = None,
    *,
    reference: Path | None = None,
    only: Sequence[str] = (),
    cache: Path | None = None,
) -> Diagnosis:
    """Says what the simulation of a bench, of loops or of points of test lacks.

    ``model``: an actuator, its file, or a case; points of test need the case. ``reference``: folder of runs with nothing
    missing. ``only``: causes to take for true. ``cache``: folder that keeps what surrogates leave.
    """
