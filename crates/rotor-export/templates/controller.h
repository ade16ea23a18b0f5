/* {{title}}
 *
{{about}}
 *
 * C99, also C++. No allocation; all memory is in the state that is handed over.
 * Built without fused operations (-ffp-contract=off) it gives the voltages of the program that wrote it to 1e-12 of their
 * limit.
 * Written by hhc; the numbers are those of one case.
 */
#ifndef {{NAME}}_H
#define {{NAME}}_H

#ifdef __cplusplus
extern "C" {
#endif

enum { {{NAME}}_FLAPS = {{flaps}} };
enum { {{NAME}}_HARMONICS = {{harmonics}} };           /* controlled harmonics of each flap */
enum { {{NAME}}_CONTROLS = {{controls}} };            /* flap by flap, harmonic by harmonic, cosine and sine */
enum { {{NAME}}_CHANNELS = {{channels}} };            /* signals of a sample */
enum { {{NAME}}_LOADS = {{loads}} };               /* cosine and sine of every signal */
enum { {{NAME}}_SAMPLES_PER_REV = {{samples_per_rev}} };
enum { {{NAME}}_SETTLING_REV = {{settling_rev}} };         /* revolutions of a cycle that are not measured */
enum { {{NAME}}_WINDOW_REV = {{window_rev}} };           /* revolutions of a cycle that are */

/* What a call did. */
enum { {{NAME}}_BAD_INPUT = -1 };          /* a number that is none, a load beyond 1e100 or a sample beyond half of that; nothing was changed */
enum { {{NAME}}_TAKEN = 0 };
enum { {{NAME}}_STEPPED = 1 };             /* there is a new control */

typedef struct {
    /* the control that acts, V: per flap, per harmonic, cosine and sine */
    double control_volt[{{NAME}}_CONTROLS];
    /* whether the limit of an amplitude bound in the last step */
    int is_limited;
    /* loads of the last cycle, nondimensional */
    double loads[{{NAME}}_LOADS];
    /* the rest is memory */
    double target_volt[{{NAME}}_CONTROLS];
    double alone_volt[{{NAME}}_CONTROLS];
    double sums[{{NAME}}_WINDOW_REV][{{NAME}}_LOADS];
    int settling, sample, revolution;
    int is_load_lost[{{NAME}}_LOADS];
    int is_flap_lost[{{NAME}}_FLAPS];
{{state}}
} {{name}}_state;

/* Starts at zero control. */
void {{name}}_start({{name}}_state *s);

/* Takes the next sample of the hub loads, {{channel_names}},
 * the first at azimuth 0, {{NAME}}_SAMPLES_PER_REV evenly in a revolution. A sample that is refused is not counted: give
 * another one of the same azimuth, or wait for azimuth 0 and call {{name}}_resync. */
int {{name}}_sample({{name}}_state *s, const double hub[{{NAME}}_CHANNELS], double advance_ratio);

/* Begins a cycle anew at azimuth 0; control and knowledge stay. */
void {{name}}_resync({{name}}_state *s);

/* The same for a whole cycle: the harmonics of the loads, each over its unit, were found elsewhere. */
int {{name}}_cycle({{name}}_state *s, const double loads[{{NAME}}_LOADS], double advance_ratio);

/* Voltage of a flap (from 0) at an azimuth of its blade, rad, without its bias, V. */
double {{name}}_volt(const {{name}}_state *s, int flap, double azimuth_rad);

/* Leaves a flap (from 0) out for good; its voltage goes to 0 within the rate. */
void {{name}}_lose_flap({{name}}_state *s, int flap);

/* Leaves a load (from 0) out of cost and estimate, or takes it in again. */
void {{name}}_lose_load({{name}}_state *s, int load, int is_lost);

#ifdef __cplusplus
}
#endif

#endif
