"""An identified piezo actuator, voltage in, equivalent flap angle out, and its inverse.

{{about}}

Fixed time step {{time_step_s}} s. Command range {{lowest_volt}} V to {{highest_volt}} V.

    from {{name}} import Actuator

    flap = Actuator({{middle_volt}})             # at rest at a voltage
    deg = flap.step({{middle_volt}} + 1.0)       # flap angle one time step later, deg

    flap.inverse_start(flap.rest_volt(0.0))
    volt = flap.inverse_step(0.1)     # the voltage for 0.1 deg one time step later
    if flap.out_of_reach: ...         # the flap does not follow: it goes to expected_deg

    degs = flap.simulate(volts)       # whole histories, as NumPy arrays
    volts = flap.invert(wanted)

Runs without NumPy; `simulate` and `invert` alone ask for it.
"""

import math

HELD = 1
"""Status: voltage beyond the command range, held there."""
BAD_INPUT = 2
"""Status: not a finite number; the state is left as it was."""
DIVERGED = 4
"""Status: the output is not a finite number any more; start again."""

{{constants}}


def _held(x, low, high):
    """x, but at least low and at most high."""
    return low if x < low else high if x > high else x


{{law}}


{{stages}}class _Chain:
    """The actuator between two samples: amplifier, law, linkage."""

    def __init__(self):
        self.amplifier = [{{amplifier}}]
        self.law = _Law()
        self.linkage = [{{linkage}}]
        self.law_volt = 0.0
        self.output_deg = 0.0
        self.status = 0

    def _admitted(self, volt):
        """The voltage that is taken for a command: commands a little beyond the range pass."""
        taken = _held(volt, LOWEST_VOLT - BEYOND_VOLT, HIGHEST_VOLT + BEYOND_VOLT)
        self.status = 0 if taken == volt else HELD
        return taken

    def start(self, volt):
        """At rest at a voltage, V; returns the flap angle there, deg."""
        bad = not math.isfinite(volt)
        volt = self._admitted(0.5 * (LOWEST_VOLT + HIGHEST_VOLT) if bad else volt)
        for stage in self.amplifier:
            volt = stage.start(volt)
        self.law_volt = volt
        deg = self.law.start(volt)
        for stage in self.linkage:
            deg = stage.start(deg)
        self.output_deg = deg
        if bad:
            self.status = BAD_INPUT
        return deg

    def step(self, volt):
        """One time step on: the voltage at its end, V, to the flap angle there, deg."""
        if not math.isfinite(volt):
            self.status = BAD_INPUT
            return self.output_deg
        volt = self._admitted(volt)
        for stage in self.amplifier:
            volt = stage.step(volt)
        self.law_volt = volt
        deg = self.law.step(volt)
        for stage in self.linkage:
            deg = stage.step(deg)
        self.output_deg = deg
        if not math.isfinite(deg):
            self.status |= DIVERGED
        return deg


def _between(law, wanted_deg, a, off_a, b, off_b):
    """Between two voltages at which the law's next output lies on either side of the wanted one:
    regula falsi, the end that stays twice is counted half (Illinois)."""
    for _ in range(80):
        if abs(off_b) <= TOLERANCE_DEG:
            break
        volt = b - off_b * (b - a) / (off_b - off_a) if off_b != off_a else a
        if not (volt > a) != (volt > b):
            volt = 0.5 * (a + b)
        off = law.probe(volt) - wanted_deg
        if (off < 0.0) != (off_b < 0.0):
            a, off_a = b, off_b
        else:
            off_a *= 0.5
        b, off_b = volt, off
    return b


def _inverse(law, last_volt, wanted_deg):
    """The voltage nearest to the last one at which the law's next output is the wanted one, and
    whether there is one. Searched in growing strides, first in the direction in which the output
    rises or falls towards it. Where there is none, the end of the range that comes nearest."""
    here = _held(last_volt, LOWEST_VOLT, HIGHEST_VOLT)
    off_here = law.probe(here) - wanted_deg
    nearest, off_nearest = here, off_here
    if abs(off_here) <= TOLERANCE_DEG:
        return here, True
    for turn in (0, 1):
        end = HIGHEST_VOLT if (off_here < 0.0) == (turn == 0) else LOWEST_VOLT
        stride = (HIGHEST_VOLT - LOWEST_VOLT) / 256.0
        b, off_b = here, off_here
        while b != end:
            a, off_a = b, off_b
            b = end if abs(end - b) <= stride else b + stride if end > b else b - stride
            stride *= 4.0
            off_b = law.probe(b) - wanted_deg
            if (off_b < 0.0) != (off_a < 0.0) or abs(off_b) <= TOLERANCE_DEG:
                return _between(law, wanted_deg, a, off_a, b, off_b), True
        if abs(off_b) < abs(off_nearest):
            nearest, off_nearest = b, off_b
    return nearest, False


class Actuator:
    """An actuator, and beside it an inverse compensator with a model of its own."""

    def __init__(self, volt=0.5 * (LOWEST_VOLT + HIGHEST_VOLT)):
        self._flap = _Chain()
        self._model = _Chain()
        self._volt = volt
        self.start(volt)
        self.inverse_start(volt)

    @property
    def output_deg(self):
        """Flap angle, deg."""
        return self._flap.output_deg

    @property
    def status(self):
        """What was wrong with the last sample: a sum of HELD, BAD_INPUT, DIVERGED; 0 if nothing."""
        return self._flap.status

    @property
    def expected_deg(self):
        """Flap angle that the compensator expects of its last command, deg."""
        return self._model.output_deg

    def start(self, volt):
        """The actuator at rest at a voltage, V; returns the flap angle there, deg."""
        return self._flap.start(volt)

    def step(self, volt):
        """One time step on: the voltage at its end, V, to the flap angle there, deg."""
        return self._flap.step(volt)

    @staticmethod
    def rest_volt(wanted_deg):
        """The voltage, V, at which the actuator rests at a flap angle, deg, as near as the range
        allows."""
        chain = _Chain()
        low, high = LOWEST_VOLT, HIGHEST_VOLT
        rises = chain.start(low) <= chain.start(high)
        for _ in range(60):
            middle = 0.5 * (low + high)
            if (chain.start(middle) < wanted_deg) == rises:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)

    def inverse_start(self, volt):
        """The compensator, its model at rest at a voltage, V; returns the flap angle there, deg."""
        middle = 0.5 * (LOWEST_VOLT + HIGHEST_VOLT)
        self._volt = _held(volt, LOWEST_VOLT, HIGHEST_VOLT) if math.isfinite(volt) else middle
        self.out_of_reach = False
        deg = self._model.start(self._volt)
        for part in self._model.amplifier + [self._model.law] + self._model.linkage:
            part.inverse_start()
        return deg

    def inverse_step(self, wanted_deg):
        """One time step on: the flap angle wanted at its end, deg, to the voltage to command, V."""
        model = self._model
        reached = math.isfinite(wanted_deg)
        if reached:
            # from the flap back to the command, stage by stage
            deg = wanted_deg
            for stage in reversed(model.linkage):
                deg = stage.inverse(deg)
            volt, reached = model.law.inverse(model.law_volt, deg)
            for stage in reversed(model.amplifier):
                volt = stage.inverse(volt)
                reached = reached and stage.reached
            self._volt = _held(volt, LOWEST_VOLT, HIGHEST_VOLT)
            reached = reached and self._volt == volt
        # and forward again: the memory is that of the command given
        model.step(self._volt)
        for stage in model.amplifier + model.linkage:
            stage.follow()
        self.out_of_reach = not reached
        return self._volt

    def simulate(self, volts):
        """The flap angles, deg, at every sample of a voltage history, V, from rest at its first."""
        import numpy

        volts = numpy.asarray(volts, dtype=float)
        degs = numpy.empty(volts.size)
        for i, volt in enumerate(volts.ravel().tolist()):
            degs[i] = self.start(volt) if i == 0 else self.step(volt)
        return degs

    def invert(self, wanted):
        """The voltages, V, for every sample of wanted flap angles, deg, from rest at the first;
        `out_of_reach` afterwards tells at which samples the flap does not follow."""
        import numpy

        wanted = numpy.asarray(wanted, dtype=float)
        volts = numpy.empty(wanted.size)
        out = numpy.zeros(wanted.size, dtype=bool)
        for i, deg in enumerate(wanted.ravel().tolist()):
            if i == 0:
                expected = self.inverse_start(self.rest_volt(deg))
                volts[i], out[i] = self._volt, not abs(expected - deg) <= REST_TOLERANCE_DEG
            else:
                volts[i], out[i] = self.inverse_step(deg), self.out_of_reach
        self.out_of_reach = out
        return volts
