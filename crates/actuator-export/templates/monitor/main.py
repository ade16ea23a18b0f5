"""Watches an actuator in service for: {{cause}}.

{{about}}

Fixed time step {{time_step}} s. Angles in deg, voltages in V. {{name}}_base.py and {{name}}_extended.py lie beside it.

    from {{name}} import Monitor

    monitor = Monitor(65.0)                       # the actuator rests at a voltage
    if monitor.step(volt, measured_deg): ...      # CAUSE or OTHER
    seen = monitor.watch(volts, measured)         # whole histories, as NumPy arrays
"""

import math

import {{name}}_base
import {{name}}_extended

THRESHOLD_DEG = {{threshold}}
"""RMS residual that a sound actuator does not reach, deg."""
SOUND = 0
"""The residual is within the threshold."""
CAUSE = 1
"""The residual is beyond it, and within it once `amount` of the cause, above 0, is taken off."""
OTHER = 2
"""The residual is beyond it, with the cause taken off too, or `amount` is 0 or below."""

_KEPT = {{kept}}


class Monitor:
    """The actuator as it was, the same with the cause, and what was measured."""

    def __init__(self, volt):
        """Begins with the actuator at rest at a voltage, V."""
        self._base = {{name}}_base.Actuator(volt)
        self._extended = {{name}}_extended.Actuator(volt)
        self._weight = self._rr = self._re = self._ee = 0.0
        self.residual_deg = 0.0
        """RMS of what was measured less the base, deg."""
        self.amount = 0.0
        """Amount of the cause: 0 none, 1 as it was diagnosed."""
        self.left_deg = 0.0
        """RMS residual with that amount taken off, deg."""
        self.seen = SOUND

    def step(self, volt, measured_deg):
        """One time step on: the voltage at its end, V, and the flap angle measured there, deg. What is seen. A
        measurement that is not a finite number is left out."""
        base = self._base.step(volt)
        r = measured_deg - base
        e = self._extended.step(volt) - base
        if not (math.isfinite(r) and math.isfinite(e)):
            return self.seen
        self._weight = _KEPT * self._weight + (1.0 - _KEPT)
        self._rr = _KEPT * self._rr + (1.0 - _KEPT) * (r * r)
        self._re = _KEPT * self._re + (1.0 - _KEPT) * (r * e)
        self._ee = _KEPT * self._ee + (1.0 - _KEPT) * (e * e)
        self.amount = self._re / self._ee if self._ee > 0.0 else 0.0
        left = self._rr - self.amount * self._re
        self.residual_deg = math.sqrt(self._rr / self._weight)
        self.left_deg = math.sqrt(max(left, 0.0) / self._weight)
        if self.residual_deg <= THRESHOLD_DEG:
            self.seen = SOUND
        else:
            is_cause = self.left_deg <= THRESHOLD_DEG and self.amount > 0.0
            self.seen = CAUSE if is_cause else OTHER
        return self.seen

    def watch(self, volts, measured):
        """What is seen at every sample of a voltage history, V, and measured flap angles, deg, from here on: columns
        residual_deg, amount, left_deg, seen."""
        import numpy

        volts = numpy.asarray(volts, dtype=float).ravel()
        measured = numpy.asarray(measured, dtype=float).ravel()
        if volts.size != measured.size:
            raise ValueError(f"{volts.size} voltages and {measured.size} angles; give one angle for each voltage")
        rows = numpy.empty((volts.size, 4))
        for i, (volt, deg) in enumerate(zip(volts.tolist(), measured.tolist())):
            self.step(volt, deg)
            rows[i] = self.residual_deg, self.amount, self.left_deg, self.seen
        return rows
