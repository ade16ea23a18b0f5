/* {{title}}: see {{name}}.h. */

#include "{{name}}.h"

#include <float.h>
#include <math.h>

enum {
    FLAPS = {{NAME}}_FLAPS,
    WIDTH = 2 * {{NAME}}_HARMONICS,
    CONTROLS = {{NAME}}_CONTROLS,
    PAIRS = CONTROLS / 2,
    CHANNELS = {{NAME}}_CHANNELS,
    LOADS = {{NAME}}_LOADS,
    SAMPLES = {{NAME}}_SAMPLES_PER_REV,
    WINDOW = {{NAME}}_WINDOW_REV,
    SETTLING = {{NAME}}_SETTLING_REV * SAMPLES
};

/* Beyond it a nondimensional load is no load; its squares must stay numbers. */
static const double LARGEST_LOAD = 1e100;
/* Beyond half of it no sample is one: a harmonic is at most twice the largest sample. */
static const double LARGEST_SAMPLE = 0.5e100;

{{constants}}

/* Sum of a[k sa] b[k sb]; eight partial sums, so that every bit is that of the program it was written by. */
static double dot(const double *a, int sa, const double *b, int sb, int count)
{
    double sum = 0.0;
    int k = 0, i;
    if (count >= 8) {
        double part[8] = {0.0};
        for (; count - k >= 8; k += 8) {
            for (i = 0; i < 8; ++i) {
                part[i] += a[(k + i) * sa] * b[(k + i) * sb];
            }
        }
        for (i = 0; i < 4; ++i) {
            sum += part[i] + part[i + 4];
        }
    }
    for (; k < count; ++k) {
        sum += a[k * sa] * b[k * sb];
    }
    return sum;
}

/* ---- T ---------------------------------------------------------------------------------------- */

{{t_code}}

/* ---- least of x'Nx/2 + g'x with every pair of x in a disc -------------------------------------- */

/* Iterations at most, and the change of the scaled controls at which they end. */
enum { ITERATIONS = 60 };
static const double TOLERANCE = 1e-10;

/* Without the limits, by Cholesky's factors; whether that keeps them. */
static int solve_freely(double normal[CONTROLS][CONTROLS], const double linear[CONTROLS], double x[CONTROLS])
{
    static const double epsilon = DBL_EPSILON;
    double factor[CONTROLS][CONTROLS];
    int i, j, k;
    for (j = 0; j < CONTROLS; ++j) {
        for (i = j; i < CONTROLS; ++i) {
            double known = 0.0, left;
            for (k = 0; k < j; ++k) {
                known += factor[i][k] * factor[j][k];
            }
            left = normal[i][j] - known;
            if (i == j && left <= epsilon * normal[j][j]) {
                return 0;
            }
            factor[i][j] = i == j ? sqrt(left) : left / factor[j][j];
        }
    }
    for (i = 0; i < CONTROLS; ++i) {
        double sum = -linear[i];
        for (k = 0; k < i; ++k) {
            sum -= factor[i][k] * x[k];
        }
        x[i] = sum / factor[i][i];
    }
    for (i = CONTROLS - 1; i >= 0; --i) {
        const int rest = CONTROLS - 1 - i;
        const double known = rest > 0 ? dot(&factor[i + 1][i], CONTROLS, &x[i + 1], 1, rest) : 0.0;
        x[i] = (x[i] - known) / factor[i][i];
    }
    for (i = 0; i < PAIRS; ++i) {
        if (!(hypot(x[2 * i], x[2 * i + 1]) <= LIMIT_VOLT[i])) {
            return 0;
        }
    }
    return 1;
}

/* Within the limits, by the accelerated projected gradient with restarts
 * (Y. Nesterov 2004; B. O'Donoghue, E. Candes 2015). */
static void solve_in_discs(double normal[CONTROLS][CONTROLS], const double linear[CONTROLS], double x[CONTROLS])
{
    double scale[PAIRS], ahead[CONTROLS], slope[CONTROLS], before[CONTROLS];
    double steepest = DBL_MIN, momentum = 1.0;
    int i, j, k, iteration;
    for (i = 0; i < PAIRS; ++i) {
        const double mean = 0.5 * (normal[2 * i][2 * i] + normal[2 * i + 1][2 * i + 1]);
        scale[i] = mean > 0.0 ? 1.0 / sqrt(mean) : 1.0;
    }
    for (i = 0; i < CONTROLS; ++i) {
        double sum = 0.0;
        for (j = 0; j < CONTROLS; ++j) {
            sum += fabs(normal[i][j]) * scale[i / 2] * scale[j / 2];
        }
        steepest = fmax(steepest, sum);
    }
    for (k = 0; k < CONTROLS; ++k) {
        ahead[k] = x[k];
    }
    for (iteration = 0; iteration < ITERATIONS; ++iteration) {
        double changed = 0.0, largest = 0.0, uphill = 0.0, next, carry;
        for (i = 0; i < CONTROLS; ++i) {
            slope[i] = linear[i];
            before[i] = x[i];
        }
        for (j = 0; j < CONTROLS; ++j) {
            for (i = 0; i < CONTROLS; ++i) {
                slope[i] += normal[i][j] * ahead[j];
            }
        }
        for (i = 0; i < PAIRS; ++i) {
            const double step = scale[i] * scale[i] / steepest;
            const double to[2] = {ahead[2 * i] - step * slope[2 * i], ahead[2 * i + 1] - step * slope[2 * i + 1]};
            const double length = hypot(to[0], to[1]);
            const double share = length > LIMIT_VOLT[i] ? LIMIT_VOLT[i] / length : 1.0;
            x[2 * i] = share * to[0];
            x[2 * i + 1] = share * to[1];
        }
        for (k = 0; k < CONTROLS; ++k) {
            const double change = x[k] - before[k];
            uphill += slope[k] * change;
            changed = fmax(changed, fabs(change) / scale[k / 2]);
            largest = fmax(largest, fabs(x[k]) / scale[k / 2]);
        }
        if (changed <= TOLERANCE * largest) {
            break;
        }
        next = uphill > 0.0 ? 1.0 : sqrt(fma(momentum, momentum, 0.25)) + 0.5;
        carry = uphill > 0.0 ? 0.0 : (momentum - 1.0) / next;
        momentum = next;
        for (k = 0; k < CONTROLS; ++k) {
            ahead[k] = x[k] + carry * (x[k] - before[k]);
        }
    }
}

/* ---- relaxed step ----------------------------------------------------------------------------- */

/* J without a flap at the control x + s d over s: a s^2 + 2 b s + c; without x about zero control. */
static void without(const {{name}}_state *s, int dead, double t[LOADS][CONTROLS], const double z[LOADS],
    const double *x, const double d[CONTROLS], double abc[3])
{
    int i, k;
    abc[0] = abc[1] = abc[2] = 0.0;
    for (i = 0; i < LOADS; ++i) {
        const double weight = s->is_load_lost[i] ? 0.0 : LOAD_WEIGHT[i];
        double at = z[i], along = 0.0;
        for (k = 0; k < CONTROLS; ++k) {
            if (k / WIDTH != dead) {
                at += x ? t[i][k] * x[k] : 0.0;
                along += t[i][k] * d[k];
            }
        }
        abc[0] += weight * along * along;
        abc[1] += weight * at * along;
        abc[2] += weight * at * at;
    }
}

/* The largest part of an aim, up to 1, with which J rises by no more than `room` whichever flap stops. */
static double part_that_is_borne(const {{name}}_state *s, double t[LOADS][CONTROLS], const double z[LOADS],
    const double aim[CONTROLS], double room)
{
    double part = 1.0, abc[3], root;
    int dead;
    for (dead = 0; dead < FLAPS; ++dead) {
        without(s, dead, t, z, 0, aim, abc);
        root = sqrt(abc[1] * abc[1] + abc[0] * room);
        if (abc[0] > 0.0) {
            part = fmin(part, abc[1] > 0.0 ? room / (abc[1] + root) : (root - abc[1]) / abc[0]);
        }
    }
    return part;
}

/* Where the step goes: to the optimum, or as near to it as no flap that stops leaves more than DEAD_FLAP_COST times
 * J of zero control: toward the optimum of flaps that each count on themselves alone, then toward zero control. */
static void bear_a_dead_flap({{name}}_state *s, double t[LOADS][CONTROLS], const double z[LOADS],
    double normal[CONTROLS][CONTROLS], const double linear[CONTROLS], double aim[CONTROLS])
{
    double at_rest = 0.0, limit, room, part = 0.0, free_volt[CONTROLS], way[CONTROLS], abc[3];
    int i, k, dead;
    for (k = 0; k < CONTROLS; ++k) {
        aim[k] = s->target_volt[k];
    }
    for (i = 0; i < LOADS; ++i) {
        at_rest += (s->is_load_lost[i] ? 0.0 : LOAD_WEIGHT[i]) * z[i] * z[i];
    }
    limit = DEAD_FLAP_COST * at_rest;
    room = limit - at_rest;
    if (!isfinite(room) || part_that_is_borne(s, t, z, aim, room) >= 1.0) {
        return;
    }
    for (i = 0; i < CONTROLS; ++i) {
        for (k = 0; k < CONTROLS; ++k) {
            normal[i][k] *= i / WIDTH == k / WIDTH ? 1.0 : 0.0;
        }
    }
    if (solve_freely(normal, linear, free_volt)) {
        for (k = 0; k < CONTROLS; ++k) {
            s->alone_volt[k] = free_volt[k];
        }
    } else {
        solve_in_discs(normal, linear, s->alone_volt);
    }
    for (k = 0; k < CONTROLS; ++k) {
        way[k] = s->alone_volt[k] - s->target_volt[k];
    }
    for (dead = 0; dead < FLAPS; ++dead) {
        double over;
        without(s, dead, t, z, s->target_volt, way, abc);
        over = abc[2] - limit;
        if (over > 0.0) {
            const double of_it = over / (sqrt(fmax(abc[1] * abc[1] - abc[0] * over, 0.0)) - abc[1]);
            part = fmax(part, abc[1] < 0.0 ? fmin(of_it, 1.0) : 1.0);
        }
    }
    for (k = 0; k < CONTROLS; ++k) {
        aim[k] += part * way[k];
    }
    part = part_that_is_borne(s, t, z, aim, room);
    for (k = 0; k < CONTROLS; ++k) {
        aim[k] *= part;
    }
}

/* J = E(Z'WZ)/q + rho u'u + du'S du, each flap acting with the chance q = FLAP_SURVIVAL;
 * u <- u + min(g, c) (aim - u), c by the rate; the aim is argmin J in the discs unless a flap that stops bars it. */
static void step({{name}}_state *s, double volt[CONTROLS], double t[LOADS][CONTROLS], const double outputs[LOADS])
{
    double normal[CONTROLS][CONTROLS], linear[CONTROLS], z[LOADS], weighted[LOADS][CONTROLS];
    double free_volt[CONTROLS], fastest[2] = {0.0, 0.0}, share[2], aim[CONTROLS];
    int i, j, k, flap;
    for (i = 0; i < LOADS; ++i) {
        z[i] = s->is_load_lost[i] ? 0.0 : outputs[i];
        for (k = 0; k < CONTROLS; ++k) {
            weighted[i][k] = t[i][k] * (s->is_load_lost[i] ? 0.0 : LOAD_WEIGHT[i]);
            z[i] -= s->is_flap_lost[k / WIDTH] ? 0.0 : t[i][k] * volt[k];
        }
    }
    for (j = 0; j < CONTROLS; ++j) {
        linear[j] = dot(&weighted[0][j], CONTROLS, z, 1, LOADS);
        for (k = 0; k < CONTROLS; ++k) {
            normal[j][k] = (j / WIDTH == k / WIDTH ? 1.0 : FLAP_SURVIVAL)
                * dot(&t[0][j], CONTROLS, &weighted[0][k], CONTROLS, LOADS);
        }
        normal[j][j] += EFFORT_WEIGHT + RATE_WEIGHT;
        linear[j] -= RATE_WEIGHT * volt[j];
    }
    for (flap = 0; flap < FLAPS; ++flap) {
        for (k = flap * WIDTH; s->is_flap_lost[flap] && k < (flap + 1) * WIDTH; ++k) {
            for (j = 0; j < CONTROLS; ++j) {
                normal[k][j] = normal[j][k] = 0.0;
            }
            normal[k][k] = 1.0;
            linear[k] = 0.0;
        }
    }
    s->is_limited = !solve_freely(normal, linear, free_volt);
    if (s->is_limited) {
        solve_in_discs(normal, linear, s->target_volt);
    } else {
        for (k = 0; k < CONTROLS; ++k) {
            s->target_volt[k] = free_volt[k];
        }
    }
    bear_a_dead_flap(s, t, z, normal, linear, aim);
    for (i = 0; i < PAIRS; ++i) {
        const double *to = &aim[2 * i], *from = &volt[2 * i];
        double *largest = &fastest[s->is_flap_lost[2 * i / WIDTH] != 0];
        *largest = fmax(*largest, hypot(to[0] - from[0], to[1] - from[1]));
    }
    /* flaps that are lost go to 0 apart: the others do not wait for them */
    for (i = 0; i < 2; ++i) {
        share[i] = fmin(GAIN, RATE_LIMIT_VOLT / fmax(fastest[i], DBL_MIN));
    }
    for (k = 0; k < CONTROLS; ++k) {
        volt[k] += share[s->is_flap_lost[k / WIDTH] != 0] * (aim[k] - volt[k]);
    }
}

/* ---- what is called --------------------------------------------------------------------------- */

void {{name}}_start({{name}}_state *s)
{
    int i, k;
    for (k = 0; k < CONTROLS; ++k) {
        s->control_volt[k] = s->target_volt[k] = s->alone_volt[k] = 0.0;
    }
    for (i = 0; i < LOADS; ++i) {
        s->is_load_lost[i] = 0;
        s->loads[i] = 0.0;
    }
    for (i = 0; i < FLAPS; ++i) {
        s->is_flap_lost[i] = 0;
    }
    s->is_limited = 0;
    {{name}}_resync(s);
    {{t_start}}
}

void {{name}}_resync({{name}}_state *s)
{
    s->settling = SETTLING;
    s->sample = s->revolution = 0;
}

int {{name}}_cycle({{name}}_state *s, const double loads[LOADS], double advance_ratio)
{
    double t[LOADS][CONTROLS], z[LOADS];
    int i;
    for (i = 0; i < LOADS; ++i) {
        if (!s->is_load_lost[i] && !(fabs(loads[i]) <= LARGEST_LOAD)) {
            return {{NAME}}_BAD_INPUT;
        }
        z[i] = s->is_load_lost[i] ? 0.0 : loads[i];
    }
    if (!isfinite(advance_ratio)) {
        return {{NAME}}_BAD_INPUT;
    }
    for (i = 0; i < LOADS; ++i) {
        s->loads[i] = loads[i];
    }
    {{t_now}}
    step(s, {{t_volt}}, t, z);
    {{t_after}}
    return {{NAME}}_STEPPED;
}

int {{name}}_sample({{name}}_state *s, const double hub[CHANNELS], double advance_ratio)
{
    double loads[LOADS], *sums = s->sums[s->revolution];
    int c, k, rev;
    for (c = 0; c < CHANNELS; ++c) {
        if (!(fabs(hub[c] / LOAD_UNIT[c]) <= LARGEST_SAMPLE) && !(s->is_load_lost[2 * c] && s->is_load_lost[2 * c + 1])) {
            return {{NAME}}_BAD_INPUT;
        }
    }
    if (!isfinite(advance_ratio)) {
        return {{NAME}}_BAD_INPUT;
    }
    if (s->settling > 0) {
        --s->settling;
        return {{NAME}}_TAKEN;
    }
    for (c = 0; c < CHANNELS; ++c) {
        const double load = hub[c] / LOAD_UNIT[c];
        const double value = fabs(load) <= LARGEST_SAMPLE ? load : 0.0;
        for (k = 0; k < 2; ++k) {
            sums[2 * c + k] = (s->sample == 0 ? 0.0 : sums[2 * c + k]) + WAVE[s->sample][k] * value;
        }
    }
    if (++s->sample < SAMPLES) {
        return {{NAME}}_TAKEN;
    }
    s->sample = 0;
    if (++s->revolution < WINDOW) {
        return {{NAME}}_TAKEN;
    }
    s->revolution = 0;
    s->settling = SETTLING;
    for (k = 0; k < LOADS; ++k) {
        double sum = 0.0;
        for (rev = 0; rev < WINDOW; ++rev) {
            sum += s->sums[rev][k];
        }
        loads[k] = 1.0 / WINDOW * sum;
    }
    return {{name}}_cycle(s, loads, advance_ratio);
}

double {{name}}_volt(const {{name}}_state *s, int flap, double azimuth_rad)
{
    double volt = 0.0;
    int h;
    if (flap < 0 || flap >= FLAPS || !isfinite(azimuth_rad)) {
        return 0.0;
    }
    for (h = 0; h < {{NAME}}_HARMONICS; ++h) {
        const double *u = &s->control_volt[flap * WIDTH + 2 * h];
        volt += u[0] * cos(HARMONIC[h] * azimuth_rad) + u[1] * sin(HARMONIC[h] * azimuth_rad);
    }
    return volt;
}

void {{name}}_lose_flap({{name}}_state *s, int flap)
{
    if (flap < 0 || flap >= FLAPS || s->is_flap_lost[flap]) {
        return;
    }
    s->is_flap_lost[flap] = 1;
    {{t_lose_flap}}
}

void {{name}}_lose_load({{name}}_state *s, int load, int is_lost)
{
    if (load >= 0 && load < LOADS) {
        s->is_load_lost[load] = is_lost != 0;
    }
}
