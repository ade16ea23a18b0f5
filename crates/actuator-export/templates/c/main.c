/*
 * {{name}}.c - see {{name}}.h. Angles in deg, voltages in V, times in s.
 *
 * Compile with -ffp-contract=off to get the numbers of the source model to the last digits.
 */
#include "{{name}}.h"

#include <math.h>

{{common_constants}}

/* x, but at least low and at most high. */
static double held(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* ------------------------------------------------------------------------------------ the law */

{{law}}

{{stages}}
/* ------------------------------------------------------------------------------------ forward */

/* The voltage that is taken for a command: commands a little beyond the range pass. */
static double admitted({{name}}_state *s, double volt)
{
    const double taken = held(volt, LOWEST_VOLT - BEYOND_VOLT, HIGHEST_VOLT + BEYOND_VOLT);
    s->status = taken < volt || taken > volt ? {{NAME}}_HELD : 0;
    return taken;
}

double {{name}}_start({{name}}_state *s, double volt)
{
    const int bad = !isfinite(volt);
    double deg;
    volt = admitted(s, bad ? 0.5 * (LOWEST_VOLT + HIGHEST_VOLT) : volt);
{{amplifier_start}}
    s->law_volt = volt;
    deg = law_start(&s->law, volt);
{{linkage_start}}
    s->output_deg = deg;
    if (bad) {
        s->status = {{NAME}}_BAD_INPUT;
    }
    return deg;
}

double {{name}}_step({{name}}_state *s, double volt)
{
    double deg;
    if (!isfinite(volt)) {
        s->status = {{NAME}}_BAD_INPUT;
        return s->output_deg;
    }
    volt = admitted(s, volt);
{{amplifier_step}}
    s->law_volt = volt;
    deg = law_step(&s->law, volt);
{{linkage_step}}
    s->output_deg = deg;
    if (!isfinite(deg)) {
        s->status |= {{NAME}}_DIVERGED;
    }
    return deg;
}

double {{name}}_rest_volt(double wanted_deg)
{
    {{name}}_state s;
    double low = LOWEST_VOLT, high = HIGHEST_VOLT;
    const int rises = {{name}}_start(&s, low) <= {{name}}_start(&s, high);
    int i;
    for (i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (({{name}}_start(&s, middle) < wanted_deg) == rises) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

/* ------------------------------------------------------------------------------------ inverse */

/* Between two voltages at which the law's next output lies on either side of the wanted one:
 * regula falsi, the end that stays twice is counted half (Illinois). */
static double between(const {{name}}_law *m, double wanted_deg, double a, double off_a, double b,
                      double off_b)
{
    int i;
    for (i = 0; i < 80 && fabs(off_b) > TOLERANCE_DEG; ++i) {
        double volt = b - off_b * (b - a) / (off_b - off_a), off;
        if (!((volt > a) != (volt > b))) {
            volt = 0.5 * (a + b);
        }
        off = law_probe(m, volt) - wanted_deg;
        if ((off < 0.0) != (off_b < 0.0)) {
            a = b;
            off_a = off_b;
        } else {
            off_a *= 0.5;
        }
        b = volt;
        off_b = off;
    }
    return b;
}

/* The same, searched in growing strides, first in the direction in which the output rises or falls
 * towards it. Where there is none, the end of the range that comes nearest. */
static double law_search(const {{name}}_law *m, double here, double wanted_deg, int *reached)
{
    const double off_here = law_probe(m, here) - wanted_deg;
    double nearest = here, off_nearest = off_here;
    int turn;
    if (fabs(off_here) <= TOLERANCE_DEG) {
        return here;
    }
    for (turn = 0; turn < 2; ++turn) {
        const double end = (off_here < 0.0) == (turn == 0) ? HIGHEST_VOLT : LOWEST_VOLT;
        double stride = (HIGHEST_VOLT - LOWEST_VOLT) / 256.0;
        double b = here, off_b = off_here;
        while (fabs(end - b) > 0.0) {
            const double a = b, off_a = off_b;
            b = fabs(end - b) <= stride ? end : end > b ? b + stride : b - stride;
            stride *= 4.0;
            off_b = law_probe(m, b) - wanted_deg;
            if ((off_b < 0.0) != (off_a < 0.0) || fabs(off_b) <= TOLERANCE_DEG) {
                return between(m, wanted_deg, a, off_a, b, off_b);
            }
        }
        if (fabs(off_b) < fabs(off_nearest)) {
            nearest = b;
            off_nearest = off_b;
        }
    }
    *reached = 0;
    return nearest;
}

/* The voltage nearest to the last one at which the law's next output is the wanted one. The slope of
 * the last sample is most often that of the next: Newton's method from there needs a probe or two.
 * A law that does not rise towards the wanted output nearby is searched. */
static double law_inverse(const {{name}}_law *m, double last_volt, double wanted_deg,
                          double *deg_per_volt, int *reached)
{
    const double here = held(last_volt, LOWEST_VOLT, HIGHEST_VOLT);
    const double near = (HIGHEST_VOLT - LOWEST_VOLT) / 16.0;
    double volt = here, slope, off = law_off(m, here, wanted_deg, &slope);
    const int rises = off < 0.0;
    int i;
    slope = *deg_per_volt;
    for (i = 0; i < 6 && slope > 0.0; ++i) {
        volt -= off / slope;
        if (!(volt >= LOWEST_VOLT && volt <= HIGHEST_VOLT && fabs(volt - here) <= near
              && (volt > here) == rises)) {
            break;
        }
        off = law_off(m, volt, wanted_deg, &slope);
        if (fabs(off) <= TOLERANCE_DEG && slope > 0.0) {
            *deg_per_volt = slope;
            return volt;
        }
    }
    volt = law_search(m, here, wanted_deg, reached);
    law_off(m, volt, wanted_deg, deg_per_volt);
    return volt;
}

double {{name}}_inverse_start({{name}}_inverse_state *s, double volt)
{
    s->volt = isfinite(volt) ? held(volt, LOWEST_VOLT, HIGHEST_VOLT)
                             : 0.5 * (LOWEST_VOLT + HIGHEST_VOLT);
    {{name}}_start(&s->model, s->volt);
    s->out_of_reach = 0;
    s->deg_per_volt = 0.0;
{{inverse_start}}
    return s->model.output_deg;
}

double {{name}}_inverse_step({{name}}_inverse_state *s, double wanted_deg)
{
    const int wanted = isfinite(wanted_deg);
    int reached = wanted;
    if (wanted) {
        /* from the flap back to the command, stage by stage */
        double deg = wanted_deg, volt;
{{inverse}}
        s->volt = held(volt, LOWEST_VOLT, HIGHEST_VOLT);
        if (s->volt < volt || s->volt > volt) {
            reached = 0;
        }
    }
    /* and forward again: the memory is that of the command given */
    {{name}}_step(&s->model, s->volt);
{{follow}}
    s->out_of_reach = !reached;
    return s->volt;
}
