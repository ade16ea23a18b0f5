@@ law
class _Law:
    """Law: {{title}}.

{{equation}}
    """

{{methods}}
@@ inverse
    def inverse_start(self):
        """Nothing but the model itself is remembered."""

    def inverse(self, last_volt, wanted_deg):
        """The voltage for a wanted output, and whether it is reached."""
        return _inverse(self, last_volt, wanted_deg)
@@ linear.functions
    def start(self, volt):
        return self.probe(volt)

    def step(self, volt):
        return self.probe(volt)

    def probe(self, volt):
        """The output at the next voltage, which changes nothing."""
        return GAIN_DEG_PER_VOLT * (volt - BIAS_VOLT)
@@ plays.plays
    @staticmethod
    def _cells(volt):
        """A voltage in cells above the lower end of the grid."""
        return _held((volt - GRID_LOWEST_VOLT) / CELL_VOLT, 0.0, float(LEVELS))

    def _moved(self, volt):
        """The plays after a voltage: max(u - r, min(u + r, w)), play j being j cells wide."""
        top = self._cells(volt)
        plays = []
        for width, x in enumerate(self.play):
            if x > top:
                x = top
            floor = top - width
            plays.append(x if x > floor else floor)
        return plays

    def _rest(self, volt):
        """Every play centred on the voltage, as far as its range allows."""
        top = self._cells(volt)
        self.play = [_held(top - 0.5 * j, 0.0, float(LEVELS - j)) for j in range(LEVELS)]

    @staticmethod
    def _at(row, x):
        """A row of knots 0, 1, 2... at x, straight between two of them."""
        knot = int(x)
        if knot + 1 == len(row):
            return row[knot]
        return row[knot] + (x - knot) * (row[knot + 1] - row[knot])
@@ plays.functions
    def start(self, volt):
        self._rest(volt)
        return self.probe(volt)

    def step(self, volt):
        self.play = self._moved(volt)
        # four sums, as the source model has them
        terms = [self._at(row, x) for row, x in zip(G0_DEG, self.play)]
        sums = [CONSTANT_DEG, 0.0, 0.0, 0.0]
        whole = LEVELS - LEVELS % 4
        for lane, term in enumerate(terms[whole:]):
            sums[lane] += term
        for j in range(whole):
            sums[j % 4] += terms[j]
        return (sums[0] + sums[1]) + (sums[2] + sums[3])

    def probe(self, volt):
        """The output at the next voltage, which changes nothing."""
        total = CONSTANT_DEG
        for row, x in zip(G0_DEG, self._moved(volt)):
            total += self._at(row, x)
        return total
@@ dynamic.functions
    def start(self, volt):
        self._rest(volt)
        deg = CONSTANT_DEG
        for row, x in zip(G0_DEG, self.play):
            deg += self._at(row, x)
        self.now_deg = self.before_deg = deg
        self.moving = False
        return deg

    def step(self, volt):
        self.play = self._moved(volt)
        deg = self._advanced(self.play)
        self.before_deg, self.now_deg = self.now_deg, deg
        self.moving = True
        return deg

    def probe(self, volt):
        """The output at the next voltage, which changes nothing."""
        return self._advanced(self._moved(volt))

    def _advanced(self, plays):
        """The output one step on.

        delta = base + weight d,   base = (now delta_n - before delta_{n-1}) scale
        G2 d^2 - b d + q = 0,      b = weight - G1,   q = G0 - base
        d = 2 q / (b + sign(b) sqrt(b^2 - 4 G2 q)), past the fold d = b / (2 G2)
        """
        g0, g1, g2 = CONSTANT_DEG, CONSTANT_S, CONSTANT_S2_PER_DEG
        for row0, row1, row2, x in zip(G0_DEG, G1_S, G2_S2_PER_DEG, plays):
            g0 += self._at(row0, x)
            g1 += self._at(row1, x)
            g2 += self._at(row2, x)
        if self.moving:
            base = (NOW * self.now_deg - BEFORE * self.before_deg) * SCALE
            weight = WEIGHT_S
        else:
            base, weight = self.now_deg, TIME_STEP_S
        b = weight - g1
        q = g0 - base
        discriminant = b * b - 4.0 * g2 * q
        if discriminant < 0.0:
            rate = b / (2.0 * g2)
        elif q == 0.0:
            rate = 0.0
        else:
            under = b + math.copysign(math.sqrt(discriminant), b)
            rate = 2.0 * q / under if under != 0.0 else math.nan
        return base + weight * rate
@@ prandtl.envelope
    @staticmethod
    def _curve(z):
        """The output curve, deg: offset + z (1 + quadratic zeta + cubic zeta^2)."""
        zeta = z / REFERENCE_DEG
        return OFFSET_DEG + z * (1.0 + zeta * (QUADRATIC + zeta * CUBIC))
@@ prandtl.flat
    @staticmethod
    def _curve(z):
        """The output curve of a law without any slope, deg."""
        return OFFSET_DEG + 0.0 * z
@@ prandtl.functions
    def start(self, volt):
        self.play = [volt] * PLAYS
        return self._move(volt, 0.0)

    def step(self, volt):
        return self._move(volt, self._growth(volt))

    def probe(self, volt):
        """The output at the next voltage, the half-widths grown as last; changes nothing."""
        return self._output(self._moved(volt, self.growth_volt), volt)

    def _growth(self, volt):
        """Growth of the half-widths on the way to a voltage, V."""
        return GROWTH_S * (abs(volt - self.volt) / TIME_STEP_S)

    def _moved(self, volt, growth_volt):
        """The plays after a voltage: max(u - r, min(u + r, w))."""
        plays = []
        for w, threshold in zip(self.play, THRESHOLD_VOLT):
            half = threshold + growth_volt
            plays.append(max(min(w, volt + half), volt - half))
        return plays

    def _output(self, plays, volt):
        z = GAIN_DEG_PER_VOLT * (volt - MIDDLE_VOLT)
        for w, weight in zip(plays, WEIGHT_DEG_PER_VOLT):
            z += weight * (w - MIDDLE_VOLT)
        return self._curve(z)

    def _move(self, volt, growth_volt):
        self.play = self._moved(volt, growth_volt)
        self.volt = volt
        self.growth_volt = growth_volt
        return self._output(self.play, volt)
@@ prandtl.inverse
    def inverse_start(self):
        """The law without rate, on its own way: tells the rate to come."""
        self.slow = _Law()
        self.slow.start(self.volt)

    def inverse(self, last_volt, wanted_deg):
        """The voltage for a wanted output, and whether it is reached.

        The half-widths of the next sample follow from the rate of an inverse without rate: the
        equation for the true rate has no stable solution that goes forward in time.
        """
        slow_volt, _ = _inverse(self.slow, self.slow.volt, wanted_deg)
        self.growth_volt = self.slow._growth(slow_volt)
        self.slow._move(slow_volt, 0.0)
        return _inverse(self, last_volt, wanted_deg)
@@ stops.functions
    def start(self, volt):
        self.play = [volt] * STOPS
        self.volt = volt
        return self._smooth(volt, 0.0)

    def step(self, volt):
        deg = self.probe(volt)
        self.play = self._moved(volt)
        self.volt = volt
        return deg

    def probe(self, volt):
        """The output at the next voltage, which changes nothing."""
        deg = self._smooth(volt, (volt - self.volt) / TIME_STEP_S)
        for w, stiffness in zip(self._moved(volt), STOP_DEG_PER_VOLT):
            deg += stiffness * (volt - w)
        return deg

    def _moved(self, volt):
        """The input less the stretch of each stop: max(u - r, min(u + r, p))."""
        return [max(min(p, volt + r), volt - r) for p, r in zip(self.play, THRESHOLD_VOLT)]

    @staticmethod
    def _smooth(volt, rate_volt_per_s):
        """Elastic and viscous part, deg."""
        elastic = STIFFNESS_DEG_PER_VOLT * (volt - MIDDLE_VOLT)
        return OFFSET_DEG + elastic + VISCOSITY_DEG_S_PER_VOLT * rate_volt_per_s
@@ bouc_wen.exponent_1
    @staticmethod
    def _above(w, x):
        """w >= 0 after its argument has risen by x."""
        return w - (1.0 - w) * math.expm1(-x)

    def _risen(self, w, length):
        """w after its argument has risen: dw/dx = 1 + k |w| below zero, 1 - w above."""
        if w >= 0.0:
            return self._above(w, length)
        to_zero = math.log1p(-K * w) / K if K > 0.0 else -w
        if length >= to_zero:
            return self._above(0.0, length - to_zero)
        return w - (1.0 / K - w) * math.expm1(-K * length) if K > 0.0 else w + length
@@ bouc_wen.exponent_2
    @staticmethod
    def _above(w, x):
        """w >= 0 after its argument has risen by x."""
        t = math.tanh(x)
        return (w + t) / (1.0 + w * t)

    def _risen(self, w, length):
        """w after its argument has risen: dw/dx = 1 + k w^2 below zero, 1 - w^2 above."""
        if w >= 0.0:
            return self._above(w, length)
        root = math.sqrt(K)
        to_zero = math.atan(-root * w) / root if K > 0.0 else -w
        if length >= to_zero:
            return self._above(0.0, length - to_zero)
        if not K > 0.0:
            return w + length
        t = math.tan(root * length) / root
        return (w + t) / (1.0 - K * w * t)
@@ bouc_wen.exponent_n
    @staticmethod
    def _slope(w):
        """dw/dx: 1 + k |w|^n below zero, 1 - w^n above."""
        power = min(abs(w), 1.0) ** EXPONENT
        return 1.0 + K * power if w < 0.0 else 1.0 - power

    def _risen(self, w, length):
        """w after its argument has risen: classical Runge-Kutta in equal steps."""
        way = min(length, 40.0)  # past 40 lengths of the slowest part the loop is its own limit
        steps = int(_held(math.ceil(16.0 * way * (1.0 + K) * EXPONENT), 1, 100000))
        h = way / steps
        for _ in range(steps):
            a = self._slope(w)
            b = self._slope(w + 0.5 * h * a)
            c = self._slope(w + 0.5 * h * b)
            d = self._slope(w + h * c)
            w += h / 6.0 * (a + 2.0 * (b + c) + d)
        return w
@@ bouc_wen.functions
    def start(self, volt):
        self.w = 0.0
        self.volt = volt
        return self._output(0.0, volt)

    def step(self, volt):
        self.w = self._hysteretic(volt)
        self.volt = volt
        return self._output(self.w, volt)

    def probe(self, volt):
        """The output at the next voltage, which changes nothing."""
        return self._output(self._hysteretic(volt), volt)

    def _hysteretic(self, volt):
        """The hysteretic variable, -1 to 1, after a voltage."""
        change = volt - self.volt
        sign = math.copysign(1.0, change)
        length = abs(change) / RISE_VOLT
        if length == 0.0:
            return self.w
        return sign * _held(self._risen(sign * self.w, length), -1.0, 1.0)

    def _output(self, w, volt):
        """The output of a hysteretic variable at a voltage, deg."""
        return self._curve(GAIN_DEG_PER_VOLT * (volt - MIDDLE_VOLT) - HALF_HEIGHT_DEG * w)
