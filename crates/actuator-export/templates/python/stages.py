@@ stage
class _Stage:
    """A stage around the law: one sample of a signal to the next, and back."""

    reached = True

    def __init__(self, **numbers):
        self.__dict__.update(numbers)

    def start(self, x):
        """Settled at an input; the output there."""
        return self.step(x)

    def inverse_start(self):
        """What the inverse remembers, settled at the present input."""

    def inverse(self, y):
        """The input for a wanted output."""
        return y

    def follow(self):
        """Takes what the inverse remembers along with the input that really came."""
@@ lags.class
class _Lags(_Stage):
    """y = u + total (u - u_start) + sum_i weight_i d_i, d_i the deviation of lag i from the input;
    exact for an input straight between two samples."""

    def start(self, x):
        self.origin = self.input = x
        self.deviation = [0.0] * len(self.weight)
        return x

    def step(self, x):
        change = x - self.input
        total = self.total * (x - self.origin)
        self.input = x
        for i, weight in enumerate(self.weight):
            self.deviation[i] = self.decay[i] * self.deviation[i] - self.ramp[i] * change
            total += weight * self.deviation[i]
        return x + total

    def inverse_start(self):
        self.now = [self.input] * len(self.weight)
        self.before = list(self.now)

    def _bases(self):
        return [(4.0 * now - before) / 3.0 for now, before in zip(self.now, self.before)]

    def inverse(self, y):
        """The exact step cannot be undone for good: what it asks for swings from sample to sample.
        Lags by backward differences of second order can:
        x_i = base_i + share_i (u - base_i), base_i = (4 x_i - x_i before) / 3."""
        total = y + self.total * self.origin
        for base, weight, share in zip(self._bases(), self.weight, self.share):
            total -= weight * (1.0 - share) * base
        return total / self.slope

    def follow(self):
        bases = self._bases()
        self.before = self.now
        self.now = [b + share * (self.input - b) for b, share in zip(bases, self.share)]
@@ delay.class
class _Delay(_Stage):
    """y(t) = u(t - delay), straight between two samples. The inverse cannot undo it."""

    def start(self, x):
        self.sample = [x] * self.samples
        self.oldest = 0
        return x

    def step(self, x):
        first = self.sample[self.oldest]
        self.sample[self.oldest] = x
        self.oldest = (self.oldest + 1) % self.samples
        return first + (self.sample[self.oldest] - first) * self.share
@@ saturation.class
class _Saturation(_Stage):
    """Voltage limits, with a knee before them."""

    def _lost(self, beyond):
        """What a knee takes from a command that lies `beyond` its start, V."""
        return beyond * beyond / (4.0 * self.knee_volt) if beyond > 0.0 else 0.0

    def step(self, x):
        above = x - (self.high_volt - self.knee_volt)
        below = (self.low_volt + self.knee_volt) - x
        if above >= 2.0 * self.knee_volt:
            return self.high_volt
        if below >= 2.0 * self.knee_volt:
            return self.low_volt
        return x - self._lost(above) + self._lost(below)

    def _found(self, beyond):
        """How far beyond the start of a knee a command goes for an output `beyond` it, V."""
        if beyond <= 0.0 or self.knee_volt <= 0.0:
            return beyond
        left = _held(1.0 - beyond / self.knee_volt, 0.0, 1.0)
        return 2.0 * self.knee_volt * (1.0 - math.sqrt(left))

    def inverse(self, y):
        volt = _held(y, self.low_volt, self.high_volt)
        self.reached = volt == y
        high = self.high_volt - self.knee_volt
        low = self.low_volt + self.knee_volt
        if volt > 0.5 * (self.low_volt + self.high_volt):
            return high + self._found(volt - high)
        return low - self._found(low - volt)
@@ current_limit.class
class _CurrentLimit(_Stage):
    """Follows the input as fast as it may and then stays with it; exact for an input straight
    between two samples, which may run through the output within the step."""

    def start(self, x):
        self.input = self.output = x
        return x

    def step(self, x):
        gap = self.input - self.output
        change = x - self.input
        toward = math.copysign(self.most_volt, gap)
        met = gap / (toward - change) if toward != change else math.inf
        if gap * change < 0.0 and abs(change) > self.most_volt and met < 1.0:
            self.output = self.output + toward * (2.0 * met - 1.0)
        elif abs(x - self.output) <= self.most_volt:
            self.output = x
        else:
            self.output = self.output + math.copysign(self.most_volt, x - self.output)
        self.input = x
        return self.output

    def inverse(self, y):
        """Where the output is too fast, no input is faster."""
        self.reached = abs(y - self.output) <= self.most_volt
        return y
@@ accommodation.class
class _Accommodation(_Stage):
    """y = x - share e, de = (1 - sgn(dx) e / travel) dx: a share that settles with the way."""

    def start(self, x):
        self.input = x
        self.late = 0.0
        return x

    def step(self, x):
        change = x - self.input
        if change != 0.0:
            goal = math.copysign(self.travel_deg, change)
            self.late = goal + (self.late - goal) * math.exp(-abs(change) / self.travel_deg)
        self.input = x
        return x - self.share * self.late

    def inverse(self, y):
        """Newton's method, which comes to the change from above."""
        wanted = y - (self.input - self.share * self.late)
        way = abs(wanted)
        sign = math.copysign(1.0, wanted)
        ahead = self.share * (self.travel_deg - sign * self.late)
        if way == 0.0:
            return self.input
        d = way + ahead
        for _ in range(50):
            left = math.exp(-d / self.travel_deg)
            under = 1.0 - ahead / self.travel_deg * left
            step = (d - ahead * (1.0 - left) - way) / under if under > 0.0 else 0.0
            d -= step
            if not step > 1e-16 * way:
                break
        return self.input + sign * d
@@ resonance.class
class _Resonance(_Stage):
    """y'' + 2 zeta w y' + w^2 y = w^2 x, exact for an input straight between two samples: the motion
    about that which follows the ramp."""

    def start(self, x):
        self.input = x
        self.deviation = self.rate = 0.0
        return x

    def step(self, x):
        slope = (x - self.input) / TIME_STEP_S
        behind = self.lead_s * slope
        place = self.deviation + behind
        rate = self.rate - slope
        self.deviation = self.place_of_place * place + self.place_of_rate * rate - behind
        self.rate = self.rate_of_place * place + self.rate_of_rate * rate + slope
        self.input = x
        return x + self.deviation

    def inverse_start(self):
        self.wanted = (self.input, self.input, self.input)

    def inverse(self, y):
        """x = y + 2 zeta / w y' + y'' / w^2, by backward differences of second order."""
        w0, w1, w2 = self.wanted
        first = 3.0 * y - 4.0 * w0 + w1
        second = 2.0 * y - 5.0 * w0 + 4.0 * w1 - w2
        self.wanted = (y, w0, w1)
        return y + self.first * first + self.second * second
@@ backlash.class
class _Backlash(_Stage):
    """Lost motion: y <- max(x - half, min(x + half, y))."""

    def start(self, x):
        self.input = self.output = x
        return x

    def step(self, x):
        self.output = _held(self.output, x - self.half_width_deg, x + self.half_width_deg)
        self.input = x
        return self.output

    def inverse(self, y):
        """One half-width ahead of the output."""
        if y > self.output:
            return y + self.half_width_deg
        return y - self.half_width_deg if y < self.output else self.input
@@ friction.class
class _Friction(_Stage):
    """x = y + e, de = stiffness (1 - sgn(dy) e / limit) dy: dry friction against the linkage."""

    def _stretched(self, stretch, change):
        """The stretch after the output has changed in one direction."""
        if change == 0.0:
            return stretch
        goal = math.copysign(self.limit_deg, change)
        way = self.limit_deg / self.stiffness
        return goal + (stretch - goal) * math.exp(-abs(change) / way)

    def _followed(self, change):
        """The change of the output that goes with one of the input: Newton's method from zero,
        which stays on one side."""
        wanted = abs(change)
        sign = math.copysign(1.0, change)
        d = 0.0
        for _ in range(60):
            after = self._stretched(self.stretch, math.copysign(d, change))
            taken = (after - self.stretch) * sign
            left = 1.0 - after * sign / self.limit_deg
            step = (wanted - d - taken) / (1.0 + self.stiffness * left)
            d += step
            if step <= 8.8817841970012523e-16 * wanted:
                break
        return math.copysign(_held(d, 0.0, wanted), change)

    def start(self, x):
        self.input = x
        self.stretch = 0.0
        return x

    def step(self, x):
        change = x - self.input
        self.input = x
        if change != 0.0:
            self.stretch += change - self._followed(change)
        return x - self.stretch

    def inverse(self, y):
        """The output and the stretch that its change leads to."""
        return y + self._stretched(self.stretch, y - (self.input - self.stretch))
@@ load.class
class _Load(_Stage):
    """A load spring, no external load."""

    def step(self, x):
        return x * self.share

    def inverse(self, y):
        return y / self.share
