/*
 * {{name}}.h - watches an actuator in service for: {{cause}}.
 *
{{about}}
 *
 * Fixed time step {{time_step}} s. Angles in deg, voltages in V. Compile it with {{name}}_base.c and {{name}}_extended.c.
 * No allocation, no state outside the struct below; one struct for each actuator that is watched.
 *
 *     {{name}}_state m;
 *     {{name}}_start(&m, 65.0);                            the actuator rests at a voltage
 *     if ({{name}}_step(&m, volt, measured_deg)) ...       {{NAME}}_CAUSE or {{NAME}}_OTHER
 */
#ifndef {{NAME}}_H
#define {{NAME}}_H

#include "{{name}}_base.h"
#include "{{name}}_extended.h"

#ifdef __cplusplus
extern "C" {
#endif

#define {{NAME}}_THRESHOLD_DEG {{threshold}} /* RMS residual that a sound actuator does not reach, deg */

/* What is seen. */
enum {
    {{NAME}}_SOUND = 0,   /* the residual is within the threshold */
    {{NAME}}_CAUSE = 1,   /* beyond it, and within it once `amount` of the cause, above 0, is taken off */
    {{NAME}}_OTHER = 2    /* beyond it, with the cause taken off too, or `amount` is 0 or below */
};

typedef struct {
    {{name}}_base_state base;           /* the actuator as it was */
    {{name}}_extended_state extended;   /* the actuator with the cause */
    double weight, rr, re, ee;          /* weight and weighted sums of the products of residual and signature */
    double residual_deg;                /* RMS of what was measured less the base, deg */
    double amount;                      /* of the cause: 0 none, 1 as it was diagnosed */
    double left_deg;                    /* RMS residual with that amount taken off, deg */
    int seen;                           /* see above */
} {{name}}_state;

/* Begins with the actuator at rest at a voltage, V. */
void {{name}}_start({{name}}_state *m, double volt);

/* One time step on: the voltage at its end, V, and the flap angle measured there, deg. What is seen. A measurement that is
 * not a finite number is left out. */
int {{name}}_step({{name}}_state *m, double volt, double measured_deg);

#ifdef __cplusplus
}
#endif

#endif
