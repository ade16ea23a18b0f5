@@ law.probe
/* The law's next output at a voltage, deg. */
static double law_probe(const {{name}}_law *m, double volt)
{
    double ignored;
    return law_off(m, volt, 0.0, &ignored);
}
@@ linear.type
typedef struct {
    double volt;              /* last voltage, V */
} {{name}}_law;
@@ linear.functions
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    (void)m;
    *deg_per_volt = GAIN_DEG_PER_VOLT;
    return GAIN_DEG_PER_VOLT * (volt - BIAS_VOLT) - wanted_deg;
}

static double law_step({{name}}_law *m, double volt)
{
    m->volt = volt;
    return GAIN_DEG_PER_VOLT * (volt - BIAS_VOLT);
}

static double law_start({{name}}_law *m, double volt)
{
    return law_step(m, volt);
}
@@ plays.type
typedef struct {
    double play[{{NAME}}_LEVELS];   /* states of the plays in cells: 0 to {{NAME}}_LEVELS - j */
    double now_deg;           /* output, deg */
} {{name}}_law;
@@ plays.plays
/* A voltage in cells above the lower end of the grid. */
static double cells(double volt)
{
    return held((volt - GRID_LOWEST_VOLT) / CELL_VOLT, 0.0, (double){{NAME}}_LEVELS);
}

/* A play of full width `width` after its input moved to `top`, in cells. */
static double moved(double x, double top, double width)
{
    const double lifted = x < top ? x : top;
    const double floor_ = top - width;
    return lifted > floor_ ? lifted : floor_;
}

/* A row of knots 0, 1, 2... at x, straight between two of them. */
static double at(const double *row, double x)
{
    const int knot = (int)x;
    return row[knot] + (x - knot) * (row[knot + 1] - row[knot]);
}

/* Every play rests centred on the voltage, as far as its range allows. */
static void rest({{name}}_law *m, double top)
{
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        m->play[j] = held(top - 0.5 * j, 0.0, (double)({{NAME}}_LEVELS - j));
    }
}
@@ plays.functions
/* What a row rises by in the cell of x. */
static double rise(const double *row, double x)
{
    const int knot = (int)x;
    return row[knot + 1] - row[knot];
}

/* The output of the plays as they stand. Four sums side by side: a single one would wait for every
 * addition before it. */
static double whole(const {{name}}_law *m)
{
    enum { LEFT = {{NAME}}_LEVELS % 4, WHOLE = {{NAME}}_LEVELS - LEFT };
    double sum[4] = {CONSTANT_DEG, 0.0, 0.0, 0.0};
    int j, lane;
    for (j = WHOLE; j < {{NAME}}_LEVELS; ++j) {
        sum[j - WHOLE] += at(G0_DEG[j], m->play[j]);
    }
    for (j = 0; j < WHOLE; j += 4) {
        for (lane = 0; lane < 4; ++lane) {
            sum[lane] += at(G0_DEG[j + lane], m->play[j + lane]);
        }
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* How far the output at a voltage is from the wanted one, and its slope there: from the last output
 * and the plays that move on the way. These are the first ones: none moves unless all narrower ones
 * do. */
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    const double top = cells(volt);
    double change = 0.0, slope = 0.0;
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        const double was = m->play[j], x = moved(was, top, j);
        if (!(x < was || x > was)) {
            break;
        }
        change += at(G0_DEG[j], x) - at(G0_DEG[j], was);
        slope += rise(G0_DEG[j], x);
    }
    *deg_per_volt = slope / CELL_VOLT;
    return m->now_deg + change - wanted_deg;
}

static double law_start({{name}}_law *m, double volt)
{
    rest(m, cells(volt));
    m->now_deg = whole(m);
    return m->now_deg;
}

static double law_step({{name}}_law *m, double volt)
{
    const double top = cells(volt);
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        m->play[j] = moved(m->play[j], top, j);
    }
    m->now_deg = whole(m);
    return m->now_deg;
}
@@ dynamic.type
typedef struct {
    double play[{{NAME}}_LEVELS];   /* states of the plays in cells: 0 to {{NAME}}_LEVELS - j */
    double now_deg;           /* output, deg */
    double before_deg;        /* output one step earlier, deg */
    double g0_deg, g1_s, g2_s2_per_deg;   /* sums of the maps over the plays */
    int moving;               /* 0 at rest, 1 once there is an earlier output */
} {{name}}_law;
@@ dynamic.functions
/* The output one step on, from G0 (deg), G1 (s), G2 (s^2/deg) at its end:
 *     delta = base + weight d,   base = (now delta_n - before delta_{n-1}) scale
 *     G2 d^2 - b d + q = 0,      b = weight - G1,   q = G0 - base
 *     d = 2 q / (b + sign(b) sqrt(b^2 - 4 G2 q)), past the fold d = b / (2 G2) */
static double based(const {{name}}_law *m)
{
    return m->moving ? (NOW * m->now_deg - BEFORE * m->before_deg) * SCALE : m->now_deg;
}

static double weight(const {{name}}_law *m)
{
    return m->moving ? WEIGHT_S : TIME_STEP_S;
}

static double advanced(const {{name}}_law *m, double g0, double g1, double g2)
{
    const double base = based(m);
    const double b = weight(m) - g1;
    const double q = g0 - base;
    const double discriminant = b * b - 4.0 * g2 * q;
    double rate;                                  /* deg/s */
    if (discriminant < 0.0) {
        rate = b / (2.0 * g2);
    } else {
        rate = fabs(q) > 0.0 ? 2.0 * q / (b + copysign(sqrt(discriminant), b)) : 0.0 * q;
    }
    return base + weight(m) * rate;
}

/* What play j adds to G0 + d G1 + d^2 G2 at a knot, deg. */
static double with_rate(int j, int knot, double d)
{
    return G0_DEG[j][knot] + d * (G1_S[j][knot] + d * G2_S2_PER_DEG[j][knot]);
}

/* G0, G1 and G2 of the plays as they stand. */
static void whole({{name}}_law *m)
{
    double g0 = CONSTANT_DEG, g1 = CONSTANT_S, g2 = CONSTANT_S2_PER_DEG;
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        const double x = m->play[j];
        g0 += at(G0_DEG[j], x);
        g1 += at(G1_S[j], x);
        g2 += at(G2_S2_PER_DEG[j], x);
    }
    m->g0_deg = g0;
    m->g1_s = g1;
    m->g2_s2_per_deg = g2;
}

static double law_probe(const {{name}}_law *m, double volt)
{
    const double top = cells(volt);
    double g0 = m->g0_deg, g1 = m->g1_s, g2 = m->g2_s2_per_deg;
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        const double was = m->play[j], x = moved(was, top, j);
        if (!(x < was || x > was)) {
            break;
        }
        g0 += at(G0_DEG[j], x) - at(G0_DEG[j], was);
        g1 += at(G1_S[j], x) - at(G1_S[j], was);
        g2 += at(G2_S2_PER_DEG[j], x) - at(G2_S2_PER_DEG[j], was);
    }
    return advanced(m, g0, g1, g2);
}

/* A wanted output has a known rate d: the law is then a static one, and straight between knots.
 *     G0 + d G1 + d^2 G2 = wanted,   d = (wanted - base) / weight
 * How far the left side at a voltage is from the wanted output, and its slope. Beyond the rate up to
 * which nothing folds the slope is given as 0. The plays that move are the first ones: none moves
 * unless all narrower ones do. */
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    const double base = based(m), d = (wanted_deg - base) / weight(m);
    const double top = cells(volt);
    double change = 0.0, slope = 0.0;
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        const double was = m->play[j], x = moved(was, top, j);
        const int knot = (int)x, knot_was = (int)was;
        const double low = with_rate(j, knot, d), rise = with_rate(j, knot + 1, d) - low;
        if (!(x < was || x > was)) {
            break;
        }
        if (knot == knot_was) {
            change += (x - was) * rise;
        } else {
            const double low_was = with_rate(j, knot_was, d);
            const double rise_was = with_rate(j, knot_was + 1, d) - low_was;
            change += (low - low_was) + ((x - knot) * rise - (was - knot_was) * rise_was);
        }
        slope += rise;
    }
    *deg_per_volt = fabs(d) <= UNFOLDED_DEG_PER_S ? slope / CELL_VOLT : 0.0;
    return m->g0_deg + d * (m->g1_s + d * m->g2_s2_per_deg) + change - wanted_deg;
}

static double law_start({{name}}_law *m, double volt)
{
    rest(m, cells(volt));
    whole(m);
    m->now_deg = m->g0_deg;
    m->before_deg = m->g0_deg;
    m->moving = 0;
    return m->now_deg;
}

static double law_step({{name}}_law *m, double volt)
{
    const double top = cells(volt);
    double deg;
    int j;
    for (j = 0; j < {{NAME}}_LEVELS; ++j) {
        m->play[j] = moved(m->play[j], top, j);
    }
    whole(m);
    deg = advanced(m, m->g0_deg, m->g1_s, m->g2_s2_per_deg);
    m->before_deg = m->now_deg;
    m->now_deg = deg;
    m->moving = 1;
    return deg;
}
@@ prandtl.type
typedef struct {
    double play[{{NAME}}_PLAYS];    /* outputs of the plays, V */
    double volt;              /* last voltage, V */
    double growth_volt;       /* growth of the half-widths over a step, V */
    double z_deg;             /* output before the curve, deg */
} {{name}}_law;
@@ prandtl.envelope
/* The output curve, deg: offset + z (1 + quadratic zeta + cubic zeta^2), zeta = z / reference. */
static double curve(double z)
{
    const double zeta = z / REFERENCE_DEG;
    return OFFSET_DEG + z * (1.0 + zeta * (QUADRATIC + zeta * CUBIC));
}

static double curve_slope(double z)
{
    const double zeta = z / REFERENCE_DEG;
    return 1.0 + zeta * (2.0 * QUADRATIC + zeta * 3.0 * CUBIC);
}
@@ prandtl.flat
/* The output curve of a law without any slope, deg. */
static double curve(double z)
{
    return OFFSET_DEG + 0.0 * z;
}

static double curve_slope(double z)
{
    return 0.0 * z;
}
@@ prandtl.functions
/* A play of half-width `half` after its input moved to `volt`, V. */
static double moved(double play, double volt, double half)
{
    const double lowered = play < volt + half ? play : volt + half;
    return lowered > volt - half ? lowered : volt - half;
}

/* How far the output at a voltage, the half-widths grown by growth_volt, is from the wanted one, and
 * its slope there: from the last output and the plays that move on the way. These are the narrowest:
 * none moves unless all narrower ones do. */
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    double z = m->z_deg + GAIN_DEG_PER_VOLT * (volt - m->volt), slope = GAIN_DEG_PER_VOLT;
    int i;
    for (i = 0; i < {{NAME}}_PLAYS; ++i) {
        const double was = m->play[i];
        const double play = moved(was, volt, THRESHOLD_VOLT[i] + m->growth_volt);
        if (!(play < was || play > was)) {
            break;
        }
        z += WEIGHT_DEG_PER_VOLT[i] * (play - was);
        slope += WEIGHT_DEG_PER_VOLT[i];
    }
    *deg_per_volt = slope * curve_slope(z);
    return curve(z) - wanted_deg;
}

static double law_move({{name}}_law *m, double volt, double growth_volt)
{
    /* four sums side by side: a single one would wait for every addition before it */
    double a = GAIN_DEG_PER_VOLT * (volt - MIDDLE_VOLT), b = 0.0, c = 0.0, d = 0.0;
    int i;
    for (i = 0; i < {{NAME}}_PLAYS; ++i) {
        const double was = m->play[i], play = moved(was, volt, THRESHOLD_VOLT[i] + growth_volt);
        if (!(play < was || play > was)) {
            break;
        }
        m->play[i] = play;
    }
    for (i = 0; i + 3 < {{NAME}}_PLAYS; i += 4) {
        a += WEIGHT_DEG_PER_VOLT[i] * (m->play[i] - MIDDLE_VOLT);
        b += WEIGHT_DEG_PER_VOLT[i + 1] * (m->play[i + 1] - MIDDLE_VOLT);
        c += WEIGHT_DEG_PER_VOLT[i + 2] * (m->play[i + 2] - MIDDLE_VOLT);
        d += WEIGHT_DEG_PER_VOLT[i + 3] * (m->play[i + 3] - MIDDLE_VOLT);
    }
    for (; i < {{NAME}}_PLAYS; ++i) {
        a += WEIGHT_DEG_PER_VOLT[i] * (m->play[i] - MIDDLE_VOLT);
    }
    m->volt = volt;
    m->growth_volt = growth_volt;
    m->z_deg = (a + b) + (c + d);
    return curve(m->z_deg);
}

static double law_start({{name}}_law *m, double volt)
{
    int i;
    for (i = 0; i < {{NAME}}_PLAYS; ++i) {
        m->play[i] = volt;
    }
    return law_move(m, volt, 0.0);
}

/* Growth of the half-widths on the way to a voltage, V. */
static double growth(const {{name}}_law *m, double volt)
{
    return GROWTH_S * (fabs(volt - m->volt) / TIME_STEP_S);
}

static double law_step({{name}}_law *m, double volt)
{
    return law_move(m, volt, growth(m, volt));
}
@@ prandtl.inverse_state
    {{name}}_law slow;        /* the law without rate, on its own way: tells the rate to come */
    double slow_deg_per_volt; /* its slope at the last sample */
@@ prandtl.inverse_start
    law_start(&s->slow, s->model.law_volt);
    s->slow_deg_per_volt = 0.0;
@@ prandtl.inverse
        {
            /* the half-widths of the next sample follow from the rate of an inverse without rate:
             * the equation for the true rate has no stable solution that goes forward in time */
            {{name}}_law law = s->model.law;
            int ignored;
            const double slow_volt =
                law_inverse(&s->slow, s->slow.volt, deg, &s->slow_deg_per_volt, &ignored);
            law.growth_volt = growth(&s->slow, slow_volt);
            law_move(&s->slow, slow_volt, 0.0);
            volt = law_inverse(&law, law.volt, deg, &s->deg_per_volt, &reached);
        }
@@ stops.type
typedef struct {
    double play[{{NAME}}_STOPS];    /* the input less the stretch of each stop, V */
    double volt;              /* last voltage, V */
} {{name}}_law;
@@ stops.functions
/* A play of half-width `half` after its input moved to `volt`, V. */
static double moved(double play, double volt, double half)
{
    const double lowered = play < volt + half ? play : volt + half;
    return lowered > volt - half ? lowered : volt - half;
}

/* Elastic and viscous part, deg. */
static double smooth(double volt, double rate_volt_per_s)
{
    const double elastic = STIFFNESS_DEG_PER_VOLT * (volt - MIDDLE_VOLT);
    return OFFSET_DEG + elastic + VISCOSITY_DEG_S_PER_VOLT * rate_volt_per_s;
}

/* How far the output at a voltage is from the wanted one, and its slope there. */
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    double deg = smooth(volt, (volt - m->volt) / TIME_STEP_S);
    int i;
    *deg_per_volt = STIFFNESS_DEG_PER_VOLT + VISCOSITY_DEG_S_PER_VOLT / TIME_STEP_S;
    for (i = 0; i < {{NAME}}_STOPS; ++i) {
        const double was = m->play[i], play = moved(was, volt, THRESHOLD_VOLT[i]);
        deg += STOP_DEG_PER_VOLT[i] * (volt - play);
        if (!(play < was || play > was)) {
            *deg_per_volt += STOP_DEG_PER_VOLT[i];
        }
    }
    return deg - wanted_deg;
}

static double law_step({{name}}_law *m, double volt)
{
    double ignored;
    const double deg = law_off(m, volt, 0.0, &ignored);
    int i;
    for (i = 0; i < {{NAME}}_STOPS; ++i) {
        m->play[i] = moved(m->play[i], volt, THRESHOLD_VOLT[i]);
    }
    m->volt = volt;
    return deg;
}

static double law_start({{name}}_law *m, double volt)
{
    int i;
    for (i = 0; i < {{NAME}}_STOPS; ++i) {
        m->play[i] = volt;
    }
    m->volt = volt;
    return smooth(volt, 0.0);
}
@@ bouc_wen.type
typedef struct {
    double w;                 /* hysteretic variable, -1 to 1 */
    double volt;              /* last voltage, V */
} {{name}}_law;
@@ bouc_wen.exponent_1
/* dw/dx: 1 + k |w| below zero, 1 - w above. */
static double slope(double w)
{
    return w < 0.0 ? 1.0 - K * w : 1.0 - w;
}

/* w >= 0 after its argument has risen by x. */
static double above(double w, double x)
{
    return w - (1.0 - w) * expm1(-x);
}

/* w after its argument has risen by `length`: dw/dx = 1 + k |w| below zero, 1 - w above. */
static double risen(double w, double length)
{
    double to_zero;
    if (w >= 0.0) {
        return above(w, length);
    }
    to_zero = K > 0.0 ? log1p(-K * w) / K : -w;
    if (length >= to_zero) {
        return above(0.0, length - to_zero);
    }
    return K > 0.0 ? w - (1.0 / K - w) * expm1(-K * length) : w + length;
}
@@ bouc_wen.exponent_2
/* dw/dx: 1 + k w^2 below zero, 1 - w^2 above. */
static double slope(double w)
{
    return w < 0.0 ? 1.0 + K * w * w : 1.0 - w * w;
}

/* w >= 0 after its argument has risen by x. */
static double above(double w, double x)
{
    const double t = tanh(x);
    return (w + t) / (1.0 + w * t);
}

/* w after its argument has risen by `length`: dw/dx = 1 + k w^2 below zero, 1 - w^2 above. */
static double risen(double w, double length)
{
    const double root = sqrt(K);
    double to_zero, t;
    if (w >= 0.0) {
        return above(w, length);
    }
    to_zero = K > 0.0 ? atan(-root * w) / root : -w;
    if (length >= to_zero) {
        return above(0.0, length - to_zero);
    }
    if (!(K > 0.0)) {
        return w + length;
    }
    t = tan(root * length) / root;
    return (w + t) / (1.0 - K * w * t);
}
@@ bouc_wen.exponent_n
/* dw/dx: 1 + k |w|^n below zero, 1 - w^n above. */
static double slope(double w)
{
    const double size = fabs(w);
    const double power = pow(size < 1.0 ? size : 1.0, EXPONENT);
    return w < 0.0 ? 1.0 + K * power : 1.0 - power;
}

/* w after its argument has risen by `length`: classical Runge-Kutta in equal steps. */
static double risen(double w, double length)
{
    /* past 40 lengths of the slowest part the loop is its own limit */
    const double way = length < 40.0 ? length : 40.0;
    const double steps = held(ceil(16.0 * way * (1.0 + K) * EXPONENT), 1.0, 1e5);
    const double h = way / steps;
    double done;
    for (done = 0.0; done < steps; done += 1.0) {
        const double a = slope(w);
        const double b = slope(w + 0.5 * h * a);
        const double c = slope(w + 0.5 * h * b);
        const double d = slope(w + h * c);
        w += h / 6.0 * (a + 2.0 * (b + c) + d);
    }
    return w;
}
@@ bouc_wen.functions
/* The hysteretic variable after a change of the voltage, V. */
static double hysteretic(double w, double change_volt)
{
    const double sign = copysign(1.0, change_volt);
    const double length = fabs(change_volt) / RISE_VOLT;
    return length > 0.0 ? sign * held(risen(sign * w, length), -1.0, 1.0) : w;
}

/* The output of a hysteretic variable at a voltage before the curve, deg. */
static double output(double w, double volt)
{
    return GAIN_DEG_PER_VOLT * (volt - MIDDLE_VOLT) - HALF_HEIGHT_DEG * w;
}

/* How far the output at a voltage is from the wanted one, and its slope there. */
static double law_off(const {{name}}_law *m, double volt, double wanted_deg, double *deg_per_volt)
{
    const double change_volt = volt - m->volt, w = hysteretic(m->w, change_volt);
    const double z = output(w, volt), rise = slope(copysign(1.0, change_volt) * w) / RISE_VOLT;
    *deg_per_volt = (GAIN_DEG_PER_VOLT - HALF_HEIGHT_DEG * rise) * curve_slope(z);
    return curve(z) - wanted_deg;
}

static double law_start({{name}}_law *m, double volt)
{
    m->w = 0.0;
    m->volt = volt;
    return curve(output(0.0, volt));
}

static double law_step({{name}}_law *m, double volt)
{
    m->w = hysteretic(m->w, volt - m->volt);
    m->volt = volt;
    return curve(output(m->w, volt));
}
