@@ lags.memory
typedef struct {
    double start;             /* input at the start, {{unit}} */
    double input;             /* last input, {{unit}} */
    double deviation[{{NAME}}_{{ID}}_LAGS];   /* of each lag from the input, {{unit}} */
} {{name}}_{{id}};
@@ lags.history
typedef struct {
    double now[{{NAME}}_{{ID}}_LAGS];         /* the lags by backward differences, {{unit}} */
    double before[{{NAME}}_{{ID}}_LAGS];      /* one step earlier, {{unit}} */
} {{name}}_{{id}}_history;
@@ lags.forward
static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    int i;
    m->start = x;
    m->input = x;
    for (i = 0; i < {{NAME}}_{{ID}}_LAGS; ++i) {
        m->deviation[i] = 0.0;
    }
    return x;
}

/* Exact for an input straight between two samples. */
static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double change = x - m->input;
    double sum = {{ID}}_TOTAL * (x - m->start);
    int i;
    m->input = x;
    for (i = 0; i < {{NAME}}_{{ID}}_LAGS; ++i) {
        m->deviation[i] = {{ID}}_DECAY[i] * m->deviation[i] - {{ID}}_RAMP[i] * change;
        sum += {{ID}}_WEIGHT[i] * m->deviation[i];
    }
    return x + sum;
}
@@ lags.inverse
static void {{id}}_history_start({{name}}_{{id}}_history *h, const {{name}}_{{id}} *m)
{
    int i;
    for (i = 0; i < {{NAME}}_{{ID}}_LAGS; ++i) {
        h->now[i] = m->input;
        h->before[i] = m->input;
    }
}

/* The input for an output y. The exact step cannot be undone for good: what it asks for swings from
 * sample to sample. Lags by backward differences of second order can:
 *     x_i = base_i + share_i (u - base_i),   base_i = (4 x_i - x_i before) / 3 */
static double {{id}}_inverse(const {{name}}_{{id}} *m, const {{name}}_{{id}}_history *h, double y)
{
    double sum = y + {{ID}}_TOTAL * m->start;
    int i;
    for (i = 0; i < {{NAME}}_{{ID}}_LAGS; ++i) {
        const double base = (4.0 * h->now[i] - h->before[i]) / 3.0;
        sum -= {{ID}}_WEIGHT[i] * (1.0 - {{ID}}_SHARE[i]) * base;
    }
    return sum / {{ID}}_SLOPE;
}

/* Takes the lags along with the input that really came. */
static void {{id}}_follow({{name}}_{{id}}_history *h, const {{name}}_{{id}} *m)
{
    int i;
    for (i = 0; i < {{NAME}}_{{ID}}_LAGS; ++i) {
        const double base = (4.0 * h->now[i] - h->before[i]) / 3.0;
        h->before[i] = h->now[i];
        h->now[i] = base + {{ID}}_SHARE[i] * (m->input - base);
    }
}
@@ delay.memory
typedef struct {
    double sample[{{NAME}}_{{ID}}_SAMPLES];   /* the inputs under way, {{unit}} */
    int oldest;               /* place of the oldest */
} {{name}}_{{id}};
@@ delay.forward
static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    int i;
    for (i = 0; i < {{NAME}}_{{ID}}_SAMPLES; ++i) {
        m->sample[i] = x;
    }
    m->oldest = 0;
    return x;
}

/* Straight between two samples. */
static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double from = m->sample[m->oldest];
    double to;
    m->sample[m->oldest] = x;
    m->oldest = (m->oldest + 1) % {{NAME}}_{{ID}}_SAMPLES;
    to = m->sample[m->oldest];
    return from + (to - from) * {{ID}}_SHARE;
}
@@ saturation.forward
/* What a knee takes from a command that lies `beyond` its start, V. */
static double {{id}}_lost(double beyond)
{
    return beyond > 0.0 ? beyond * beyond / (4.0 * {{ID}}_KNEE_VOLT) : 0.0;
}

static double {{id}}_step(double x)
{
    const double above = x - ({{ID}}_HIGH_VOLT - {{ID}}_KNEE_VOLT);
    const double below = ({{ID}}_LOW_VOLT + {{ID}}_KNEE_VOLT) - x;
    if (above >= 2.0 * {{ID}}_KNEE_VOLT) {
        return {{ID}}_HIGH_VOLT;
    }
    if (below >= 2.0 * {{ID}}_KNEE_VOLT) {
        return {{ID}}_LOW_VOLT;
    }
    return x - {{id}}_lost(above) + {{id}}_lost(below);
}
@@ saturation.inverse
/* How far beyond the start of a knee a command goes for an output that goes `beyond` it, V. */
static double {{id}}_found(double beyond)
{
    if (!(beyond > 0.0) || !({{ID}}_KNEE_VOLT > 0.0)) {
        return beyond;
    }
    return 2.0 * {{ID}}_KNEE_VOLT
           * (1.0 - sqrt(held(1.0 - beyond / {{ID}}_KNEE_VOLT, 0.0, 1.0)));
}

/* The command for a voltage y; beyond the limits that for the limit. */
static double {{id}}_inverse(double y, int *reached)
{
    const double middle = 0.5 * ({{ID}}_LOW_VOLT + {{ID}}_HIGH_VOLT);
    const double volt = held(y, {{ID}}_LOW_VOLT, {{ID}}_HIGH_VOLT);
    const double high = {{ID}}_HIGH_VOLT - {{ID}}_KNEE_VOLT;
    const double low = {{ID}}_LOW_VOLT + {{ID}}_KNEE_VOLT;
    if (volt < y || volt > y) {
        *reached = 0;
    }
    return volt > middle ? high + {{id}}_found(volt - high) : low - {{id}}_found(low - volt);
}
@@ current_limit.memory
typedef struct {
    double input;             /* last input, V */
    double output;            /* last output, V */
} {{name}}_{{id}};
@@ current_limit.forward
static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    m->input = x;
    m->output = x;
    return x;
}

/* Follows the input as fast as it may and then stays with it; exact for an input straight between
 * two samples, which may run through the output within the step. */
static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double gap = m->input - m->output;
    const double change = x - m->input;
    const double toward = copysign({{ID}}_MOST_VOLT, gap);
    const double met = gap / (toward - change);
    if (gap * change < 0.0 && fabs(change) > {{ID}}_MOST_VOLT && met < 1.0) {
        m->output = m->output + toward * (2.0 * met - 1.0);
    } else if (fabs(x - m->output) <= {{ID}}_MOST_VOLT) {
        m->output = x;
    } else {
        m->output = m->output + copysign({{ID}}_MOST_VOLT, x - m->output);
    }
    m->input = x;
    return m->output;
}
@@ current_limit.inverse
/* The command for a voltage y is y: where that is too fast, nothing is faster. */
static double {{id}}_inverse(const {{name}}_{{id}} *m, double y, int *reached)
{
    if (fabs(y - m->output) > {{ID}}_MOST_VOLT) {
        *reached = 0;
    }
    return y;
}
@@ accommodation.memory
typedef struct {
    double input;             /* last input, deg */
    double late;              /* part of the way that has not settled yet, deg */
} {{name}}_{{id}};
@@ accommodation.forward
/* The late part after the input has changed in one direction. */
static double {{id}}_settled(double late, double change)
{
    const double goal = copysign({{ID}}_TRAVEL_DEG, change);
    if (!(fabs(change) > 0.0)) {
        return late;
    }
    return goal + (late - goal) * exp(-fabs(change) / {{ID}}_TRAVEL_DEG);
}

static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    m->input = x;
    m->late = 0.0;
    return x;
}

static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    m->late = {{id}}_settled(m->late, x - m->input);
    m->input = x;
    return x - {{ID}}_SHARE * m->late;
}
@@ accommodation.inverse
/* The input for an output y: Newton's method, which comes to the change from above. It begins with
 * its step from no change, which needs no exponential. */
static double {{id}}_inverse(const {{name}}_{{id}} *m, double y)
{
    const double wanted = y - (m->input - {{ID}}_SHARE * m->late);
    const double way = fabs(wanted);
    const double sign = copysign(1.0, wanted);
    const double ahead = {{ID}}_SHARE * ({{ID}}_TRAVEL_DEG - sign * m->late);
    double d = fmin(way / (1.0 - ahead / {{ID}}_TRAVEL_DEG), way + ahead);
    int i;
    if (!(way > 0.0)) {
        return m->input;
    }
    for (i = 0; i < 50; ++i) {
        const double left = exp(-d / {{ID}}_TRAVEL_DEG);
        const double step = (d - ahead * (1.0 - left) - way)
                            / (1.0 - ahead / {{ID}}_TRAVEL_DEG * left);
        d -= step;
        if (!(step > 1e-8 * way)) {     /* the next one would be below its square */
            break;
        }
    }
    return m->input + sign * d;
}
@@ resonance.memory
typedef struct {
    double input;             /* last input, deg */
    double deviation;         /* output less input, deg */
    double rate;              /* rate of the output, deg/s */
} {{name}}_{{id}};
@@ resonance.history
typedef struct {
    double wanted[3];         /* the last outputs wanted, the newest first, deg */
} {{name}}_{{id}}_history;
@@ resonance.forward
static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    m->input = x;
    m->deviation = 0.0;
    m->rate = 0.0;
    return x;
}

/* Exact for an input straight between two samples: the motion about that which follows the ramp. */
static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double slope = (x - m->input) / TIME_STEP_S;
    const double behind = {{ID}}_LEAD_S * slope;
    const double place = m->deviation + behind;
    const double rate = m->rate - slope;
    m->deviation = {{ID}}_PLACE_OF_PLACE * place + {{ID}}_PLACE_OF_RATE * rate - behind;
    m->rate = {{ID}}_RATE_OF_PLACE * place + {{ID}}_RATE_OF_RATE * rate + slope;
    m->input = x;
    return x + m->deviation;
}
@@ resonance.inverse
static void {{id}}_history_start({{name}}_{{id}}_history *h, const {{name}}_{{id}} *m)
{
    h->wanted[0] = m->input;
    h->wanted[1] = m->input;
    h->wanted[2] = m->input;
}

/* The input for an output y, from the differential equation: x = y + 2 zeta / w y' + y'' / w^2, both
 * derivatives by backward differences of second order. */
static double {{id}}_inverse({{name}}_{{id}}_history *h, double y)
{
    const double *w = h->wanted;
    const double first = 3.0 * y - 4.0 * w[0] + w[1];
    const double second = 2.0 * y - 5.0 * w[0] + 4.0 * w[1] - w[2];
    h->wanted[2] = h->wanted[1];
    h->wanted[1] = h->wanted[0];
    h->wanted[0] = y;
    return y + {{ID}}_FIRST * first + {{ID}}_SECOND * second;
}
@@ backlash.memory
typedef struct {
    double output;            /* deg */
    double input;             /* deg */
} {{name}}_{{id}};
@@ backlash.forward
static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    m->output = x;
    m->input = x;
    return x;
}

static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double low = x - {{ID}}_HALF_WIDTH_DEG;
    const double high = x + {{ID}}_HALF_WIDTH_DEG;
    m->output = held(m->output, low, high);
    m->input = x;
    return m->output;
}
@@ backlash.inverse
/* The input for an output y: one half-width ahead of it. */
static double {{id}}_inverse(const {{name}}_{{id}} *m, double y)
{
    if (y > m->output) {
        return y + {{ID}}_HALF_WIDTH_DEG;
    }
    return y < m->output ? y - {{ID}}_HALF_WIDTH_DEG : m->input;
}
@@ friction.memory
typedef struct {
    double input;             /* last input, deg */
    double stretch;           /* of the linkage, deg */
} {{name}}_{{id}};
@@ friction.forward
/* The stretch after the output has changed in one direction. */
static double {{id}}_stretched(double stretch, double change)
{
    const double goal = copysign({{ID}}_LIMIT_DEG, change);
    if (!(fabs(change) > 0.0)) {
        return stretch;
    }
    return goal + (stretch - goal) * exp(-fabs(change) / ({{ID}}_LIMIT_DEG / {{ID}}_STIFFNESS));
}

/* The change of the output that goes with one of the input: Newton's method from zero, which stays
 * on one side. */
static double {{id}}_followed(double stretch, double change)
{
    const double wanted = fabs(change);
    const double sign = copysign(1.0, change);
    double d = 0.0;
    int i;
    for (i = 0; i < 60; ++i) {
        const double after = {{id}}_stretched(stretch, copysign(d, change));
        const double taken = (after - stretch) * sign;
        const double left = 1.0 - after * sign / {{ID}}_LIMIT_DEG;
        const double step = (wanted - d - taken) / (1.0 + {{ID}}_STIFFNESS * left);
        d += step;
        if (step <= 8.8817841970012523e-16 * wanted) {
            break;
        }
    }
    return copysign(held(d, 0.0, wanted), change);
}

static double {{id}}_start({{name}}_{{id}} *m, double x)
{
    m->input = x;
    m->stretch = 0.0;
    return x;
}

static double {{id}}_step({{name}}_{{id}} *m, double x)
{
    const double change = x - m->input;
    m->input = x;
    if (fabs(change) > 0.0) {
        m->stretch += change - {{id}}_followed(m->stretch, change);
    }
    return x - m->stretch;
}
@@ friction.inverse
/* The input for an output y: the output and the stretch that its change leads to. */
static double {{id}}_inverse(const {{name}}_{{id}} *m, double y)
{
    return y + {{id}}_stretched(m->stretch, y - (m->input - m->stretch));
}
@@ load.forward
static double {{id}}_step(double x)
{
    return x * {{ID}}_SHARE;
}
@@ load.inverse
/* The free angle for an angle y under the spring. */
static double {{id}}_inverse(double y)
{
    return y / {{ID}}_SHARE;
}
