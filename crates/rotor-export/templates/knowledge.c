@@ fixed.code
/* dZ/du, held. */
static void sensitivity(double t[LOADS][CONTROLS])
{
    int i, k;
    for (i = 0; i < LOADS; ++i) {
        for (k = 0; k < CONTROLS; ++k) {
            t[i][k] = T[0][i][k];
        }
    }
}
@@ fixed.volt
s->control_volt
@@ fixed.now
sensitivity(t);
@@ scheduled.code
/* dZ/du, linear in the advance ratio between the knots and held beyond their ends. */
static void sensitivity(double t[LOADS][CONTROLS], double advance_ratio)
{
    int above = 0, low, high, i, k;
    double share = 0.0;
    while (above < KNOTS && KNOT_ADVANCE_RATIO[above] < advance_ratio) {
        ++above;
    }
    low = above == 0 ? 0 : above - 1;
    high = above == KNOTS ? KNOTS - 1 : above;
    if (low < high) {
        const double from = KNOT_ADVANCE_RATIO[low];
        share = (advance_ratio - from) / (KNOT_ADVANCE_RATIO[high] - from);
    }
    for (i = 0; i < LOADS; ++i) {
        for (k = 0; k < CONTROLS; ++k) {
            t[i][k] = (1.0 - share) * T[low][i][k] + share * T[high][i][k];
        }
    }
}
@@ scheduled.volt
s->control_volt
@@ scheduled.now
sensitivity(t, advance_ratio);
@@ adaptive.state
    /* estimate of (Z0, T u_full, trend of Z0) of every load, its covariance, the variance of the noise */
    double theta[{{NAME}}_LOADS][{{NAME}}_CONTROLS + 2];
    double covariance[{{NAME}}_CONTROLS + 2][{{NAME}}_CONTROLS + 2];
    double noise_variance;
    /* what the last cycle told: 0 as expected, 1 Z0 was freed, 2 T was freed too */
    int observed;
    double ceiling, pairs;
    long since_jump;
    double last_volt[{{NAME}}_CONTROLS];
    /* the control without its turn to and fro, V; cycles so far */
    double centre_volt[{{NAME}}_CONTROLS];
    unsigned long cycles;
@@ adaptive.code
/* Z = Z0 + T u, theta = (Z0, T u_full, trend), phi = (1, u / u_full, 0), Z0 goes on by its trend: a Kalman filter, update in
 * Joseph's form (W. Johnson, NASA TP-1996, 1982; B. Anderson, J. Moore, Optimal Filtering, 1979). */
enum { TREND = CONTROLS + 1, SIZE = CONTROLS + 2 };

/* Noise that is not told: pairs that its start counts for, memory and pairs until it is relied on. */
static const double NOISE_START_PAIRS = 4.0, NOISE_MEMORY_PAIRS = 50.0, NOISE_LEARNT_PAIRS = 20.0;
/* What is left from pair to pair of the variance that a freed T may have; a jump, in standard deviations. */
static const double CEILING_KEPT = 0.9, JUMP_SIGMAS = 5.0;
/* Pairs after a jump within which another one is not of Z0 alone; one that never was. */
static const long JUMP_PAIRS = 5, NO_JUMP = 2000000000L;

static double square(double x)
{
    return x * x;
}

static void start_estimate({{name}}_state *s)
{
    int i, k;
    for (i = 0; i < LOADS; ++i) {
        s->theta[i][0] = BASELINE[i];
        for (k = 0; k < CONTROLS; ++k) {
            s->theta[i][k + 1] = T[0][i][k] * FULL_SCALE_VOLT;
        }
        s->theta[i][TREND] = 0.0;
    }
    for (i = 0; i < SIZE; ++i) {
        for (k = 0; k < SIZE; ++k) {
            s->covariance[i][k] = i == k ? PRIOR_VARIANCE : 0.0;
        }
    }
    s->covariance[0][0] = s->noise_variance = START_NOISE_VARIANCE;
    s->covariance[TREND][TREND] = 0.0;
    s->observed = 0;
    s->ceiling = PRIOR_VARIANCE;
    s->pairs = 0.0;
    s->since_jump = NO_JUMP;
    for (k = 0; k < CONTROLS; ++k) {
        s->last_volt[k] = s->centre_volt[k] = 0.0;
    }
    s->cycles = 0;
}

/* Turns every harmonic to one side or the other, by signs that are orthogonal over the cycles and have no mean, at no more than
 * the rate. */
static void dither({{name}}_state *s)
{
    int i, k;
    for (i = 0; i < PAIRS; ++i) {
        const double *centre = &s->centre_volt[2 * i];
        double *acting = &s->control_volt[2 * i];
        unsigned long signs = s->cycles & (unsigned long)(i + 1);
        double sine = DITHER_SIN, to[2], share;
        for (; signs != 0; signs >>= 1) {
            sine = (signs & 1UL) != 0 ? -sine : sine;
        }
        to[0] = DITHER_COS * centre[0] - sine * centre[1];
        to[1] = DITHER_COS * centre[1] + sine * centre[0];
        share = fmin(RATE_LIMIT_VOLT / fmax(hypot(to[0] - acting[0], to[1] - acting[1]), DBL_MIN), 1.0);
        for (k = 0; k < 2; ++k) {
            acting[k] = DITHER_SIN > 0.0 ? acting[k] + share * (to[k] - acting[k]) : centre[k];
        }
    }
    ++s->cycles;
}

/* Lets Z0 go on by its trend. */
static void follow_trend({{name}}_state *s)
{
    int i, k;
    if (!(TREND_DRIFT > 0.0)) {
        return;
    }
    for (i = 0; i < LOADS; ++i) {
        s->theta[i][0] += s->theta[i][TREND];
    }
    for (k = 0; k < SIZE; ++k) {
        s->covariance[0][k] += s->covariance[TREND][k];
    }
    for (k = 0; k < SIZE; ++k) {
        s->covariance[k][0] += s->covariance[k][TREND];
    }
    s->covariance[TREND][TREND] += square(TREND_DRIFT) * MEAN_SQUARE_LOAD;
}

/* Adds the random walks: P += Q. */
static void predict({{name}}_state *s)
{
    double moved = 0.0, walk;
    int i, k;
    for (k = 0; k < CONTROLS; ++k) {
        moved += square((s->control_volt[k] - s->last_volt[k]) / FULL_SCALE_VOLT);
        s->last_volt[k] = s->control_volt[k];
    }
    follow_trend(s);
    s->covariance[0][0] += square(BASELINE_DRIFT) * MEAN_SQUARE_LOAD;
    walk = DRIFT / UNCERTAINTY * sqrt(moved);
    s->ceiling = PRIOR_VARIANCE + CEILING_KEPT * (s->ceiling - PRIOR_VARIANCE);
    for (k = 1; k <= CONTROLS; ++k) {
        double excess;
        s->covariance[k][k] += PRIOR_VARIANCE * walk * walk;
        excess = s->covariance[k][k] > s->ceiling ? sqrt(s->ceiling / s->covariance[k][k]) : 1.0;
        for (i = 0; i < SIZE; ++i) {
            s->covariance[k][i] *= excess;
        }
        for (i = 0; i < SIZE; ++i) {
            s->covariance[i][k] *= excess;
        }
    }
}

/* y = P phi; the variance of an innovation. */
static double told({{name}}_state *s, const double phi[SIZE], double y[SIZE])
{
    int i, k;
    for (i = 0; i < SIZE; ++i) {
        y[i] = 0.0;
        for (k = 0; k < SIZE; ++k) {
            y[i] += s->covariance[i][k] * phi[k];
        }
    }
    return s->noise_variance + fmax(dot(phi, 1, y, 1, SIZE), 0.0);
}

/* Lets Z0, and T too, be learnt anew. */
static void set_free({{name}}_state *s, int also_t)
{
    int k;
    for (k = 0; k < SIZE; ++k) {
        s->covariance[0][k] = s->covariance[k][0] = 0.0;
    }
    s->covariance[0][0] = MEAN_SQUARE_LOAD;
    if (also_t) {
        s->ceiling = fmax(PRIOR_VARIANCE, PRIOR_VARIANCE / square(UNCERTAINTY));
        for (k = 1; k <= CONTROLS; ++k) {
            s->covariance[k][k] += fmax(s->ceiling - s->covariance[k][k], 0.0);
        }
    }
}

static void update({{name}}_state *s, const double phi[SIZE], const double innovation[LOADS])
{
    double y[SIZE], gain[SIZE];
    const double variance = told(s, phi, y);
    int i, k;
    for (k = 0; k < SIZE; ++k) {
        gain[k] = y[k] / variance;
        for (i = 0; i < LOADS; ++i) {
            s->theta[i][k] += innovation[i] * gain[k];
        }
    }
    for (i = 0; i < SIZE; ++i) {
        for (k = 0; k < SIZE; ++k) {
            s->covariance[i][k] -= gain[i] * y[k];
        }
    }
    told(s, phi, y);
    for (i = 0; i < SIZE; ++i) {
        for (k = 0; k < SIZE; ++k) {
            s->covariance[i][k] -= (y[i] - s->noise_variance * gain[i]) * gain[k];
        }
    }
    for (i = 0; i < SIZE; ++i) {
        for (k = 0; k < i; ++k) {
            s->covariance[i][k] = s->covariance[k][i] = 0.5 * (s->covariance[i][k] + s->covariance[k][i]);
        }
    }
}

/* Takes in the pair of the control that acts and its loads; gives T and the loads of the estimate
 * at the control without its turn to and fro. */
static void observe({{name}}_state *s, double t[LOADS][CONTROLS], double z[LOADS])
{
    double phi[SIZE], innovation[LOADS], y[SIZE], known = 0.0, squares, variance, limit, noise;
    const double r = s->noise_variance;
    int i, k, is_jump;
    predict(s);
    phi[0] = 1.0;
    for (k = 0; k < CONTROLS; ++k) {
        phi[k + 1] = s->is_flap_lost[k / WIDTH] ? 0.0 : s->control_volt[k] / FULL_SCALE_VOLT;
    }
    phi[TREND] = 0.0;
    for (i = 0; i < LOADS; ++i) {
        innovation[i] = s->is_load_lost[i] ? 0.0 : z[i];
        for (k = 0; k < SIZE && !s->is_load_lost[i]; ++k) {
            innovation[i] -= s->theta[i][k] * phi[k];
        }
        known += s->is_load_lost[i] ? 0.0 : 1.0;
    }
    squares = dot(innovation, 1, innovation, 1, LOADS);
    known = fmax(known, 1.0);
    variance = told(s, phi, y);
    limit = known + JUMP_SIGMAS * sqrt(2.0 * known);
    is_jump = TESTS_JUMPS && squares > limit * variance;
    squares = is_jump ? limit * variance : squares;
    noise = r * (r * squares / known / variance + (variance - r)) / variance;
    s->observed = !is_jump ? 0
        : s->since_jump < JUMP_PAIRS && (NOISE_IS_TOLD || s->pairs >= NOISE_LEARNT_PAIRS) ? 2 : 1;
    if (is_jump) {
        set_free(s, s->observed == 2);
    }
    s->since_jump = is_jump ? 0 : s->since_jump < NO_JUMP ? s->since_jump + 1 : NO_JUMP;
    update(s, phi, innovation);
    if (!NOISE_IS_TOLD) {
        s->pairs += 1.0;
        s->noise_variance = fmax(r + (noise - r) / fmin(NOISE_START_PAIRS + s->pairs, NOISE_MEMORY_PAIRS), NOISE_FLOOR);
    }
    for (i = 0; i < LOADS; ++i) {
        z[i] = 0.0;
        for (k = 0; k < CONTROLS; ++k) {
            t[i][k] = 1.0 / FULL_SCALE_VOLT * s->theta[i][k + 1];
            z[i] += t[i][k] * s->centre_volt[k];
        }
        z[i] += s->theta[i][0];
    }
}

/* Takes the controls of a flap for dead: Z0 goes on from where the loads are. */
static void forget_flap({{name}}_state *s, int flap)
{
    int c, i, k;
    for (c = flap * WIDTH; c < (flap + 1) * WIDTH; ++c) {
        for (i = 0; i < LOADS; ++i) {
            s->theta[i][0] += 1.0 / FULL_SCALE_VOLT * (s->theta[i][c + 1] * s->last_volt[c]);
            s->theta[i][c + 1] = 0.0;
        }
        for (k = 0; k < SIZE; ++k) {
            s->covariance[c + 1][k] = s->covariance[k][c + 1] = 0.0;
        }
    }
}
@@ adaptive.start
start_estimate(s);
@@ adaptive.volt
s->centre_volt
@@ adaptive.after
dither(s);
@@ adaptive.now
observe(s, t, z);
@@ adaptive.lose_flap
forget_flap(s, flap);
