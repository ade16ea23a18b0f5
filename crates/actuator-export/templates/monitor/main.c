/*
 * {{name}}.c - see {{name}}.h.
 *
 * Compile with -ffp-contract=off to get the numbers of the source model to the last digits.
 */
#include "{{name}}.h"

#include <math.h>

static const double KEPT = {{kept}};   /* what a time step leaves of the weight of older samples */

void {{name}}_start({{name}}_state *m, double volt)
{
    {{name}}_base_start(&m->base, volt);
    {{name}}_extended_start(&m->extended, volt);
    m->weight = m->rr = m->re = m->ee = 0.0;
    m->residual_deg = m->amount = m->left_deg = 0.0;
    m->seen = {{NAME}}_SOUND;
}

int {{name}}_step({{name}}_state *m, double volt, double measured_deg)
{
    const double base = {{name}}_base_step(&m->base, volt);
    const double r = measured_deg - base;
    const double e = {{name}}_extended_step(&m->extended, volt) - base;
    double left;
    if (!isfinite(r) || !isfinite(e)) {
        return m->seen;
    }
    m->weight = KEPT * m->weight + (1.0 - KEPT);
    m->rr = KEPT * m->rr + (1.0 - KEPT) * (r * r);
    m->re = KEPT * m->re + (1.0 - KEPT) * (r * e);
    m->ee = KEPT * m->ee + (1.0 - KEPT) * (e * e);
    m->amount = m->ee > 0.0 ? m->re / m->ee : 0.0;
    left = m->rr - m->amount * m->re;
    m->residual_deg = sqrt(m->rr / m->weight);
    m->left_deg = sqrt((left > 0.0 ? left : 0.0) / m->weight);
    m->seen = m->residual_deg <= {{NAME}}_THRESHOLD_DEG ? {{NAME}}_SOUND
              : m->left_deg <= {{NAME}}_THRESHOLD_DEG && m->amount > 0.0 ? {{NAME}}_CAUSE
                                                                         : {{NAME}}_OTHER;
    return m->seen;
}
