/*
 * {{name}}.h - an identified piezo actuator, voltage in, equivalent flap angle out, and its inverse.
 *
{{about}}
 *
 * Fixed time step {{time_step_s}} s. Command range {{lowest_volt}} V to {{highest_volt}} V.
 * No allocation, no state outside the structs below; one struct for each actuator that is simulated.
 *
 *     {{name}}_state flap;
 *     double deg = {{name}}_start(&flap, {{middle_volt}});          at rest at a voltage
 *     deg = {{name}}_step(&flap, {{middle_volt}} + 1.0);            one time step later
 *
 *     {{name}}_inverse_state compensator;
 *     {{name}}_inverse_start(&compensator, {{name}}_rest_volt(0.0));
 *     double volt = {{name}}_inverse_step(&compensator, 0.1);       the voltage for 0.1 deg
 *     compensator.out_of_reach        is 1 where the flap does not follow: it goes to model.output_deg
 */
#ifndef {{NAME}}_H
#define {{NAME}}_H

#ifdef __cplusplus
extern "C" {
#endif

#define {{NAME}}_TIME_STEP_S {{time_step}} /* s */
#define {{NAME}}_LOWEST_VOLT ({{lowest}}) /* V */
#define {{NAME}}_HIGHEST_VOLT ({{highest}}) /* V */

/* What can be wrong with a sample; the sum of these in `status`, 0 if nothing. */
enum {
    {{NAME}}_HELD = 1,        /* voltage beyond the command range, held there */
    {{NAME}}_BAD_INPUT = 2,   /* not a finite number: the state is left as it was */
    {{NAME}}_DIVERGED = 4     /* the output is not a finite number any more: start again */
};

{{types}}

/* The actuator between two samples. */
typedef struct {
{{state}}
    double law_volt;          /* voltage the law saw last, V */
    double output_deg;        /* flap angle, deg */
    int status;               /* of the last sample, see above */
} {{name}}_state;

/* The inverse compensator between two samples: a model of its own, and what it found last. */
typedef struct {
    {{name}}_state model;     /* moves as the flap is expected to move */
{{inverse_state}}
    double deg_per_volt;      /* slope of the law at the last sample; 0 before one is known */
    double volt;              /* last command, V */
    int out_of_reach;         /* 1 where the flap cannot follow: then model.output_deg is where it goes */
} {{name}}_inverse_state;

/* The actuator at rest at a voltage, V; returns the flap angle there, deg. */
double {{name}}_start({{name}}_state *s, double volt);

/* One time step on: the voltage at its end, V, to the flap angle there, deg. */
double {{name}}_step({{name}}_state *s, double volt);

/* The voltage, V, at which the actuator rests at a flap angle, deg, as near as the range allows. */
double {{name}}_rest_volt(double wanted_deg);

/* The compensator, its model at rest at a voltage, V; returns the flap angle there, deg. */
double {{name}}_inverse_start({{name}}_inverse_state *s, double volt);

/* One time step on: the flap angle wanted at its end, deg, to the voltage to command, V. */
double {{name}}_inverse_step({{name}}_inverse_state *s, double wanted_deg);

#ifdef __cplusplus
}
#endif

#endif
