/* Times the step functions of {{name}}: ns per sample, forward and inverse, each of the best of some rounds. */
#include <math.h>
#include <stdio.h>
#include <time.h>
#include "{{name}}.h"

enum { SAMPLES = 4000, ROUNDS = 40 };
static double volts[SAMPLES], degs[SAMPLES];

int main(void)
{
    static {{name}}_state s;
    static {{name}}_inverse_state c;
    double best[2] = {1e9, 1e9}, sum = 0.0;
    int i, round;
    for (i = 0; i < SAMPLES; ++i) {
        const double t = {{time_step_s}} * i;
        volts[i] = {{middle_volt}} + {{reach_volt}} * (cos(62.8 * t) + sin(94.2 * t) + 0.75 * cos(125.7 * t));
    }
    for (round = 0; round < ROUNDS; ++round) {
        clock_t start = clock();
        double ns;
        degs[0] = {{name}}_start(&s, volts[0]);
        for (i = 1; i < SAMPLES; ++i) {
            degs[i] = {{name}}_step(&s, volts[i]);
        }
        ns = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC / SAMPLES;
        best[0] = ns < best[0] ? ns : best[0];
        start = clock();
        {{name}}_inverse_start(&c, volts[0]);
        for (i = 1; i < SAMPLES; ++i) {
            sum += {{name}}_inverse_step(&c, degs[i]);
        }
        ns = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC / SAMPLES;
        best[1] = ns < best[1] ? ns : best[1];
    }
    /* the sum keeps the compiler from leaving the steps out */
    printf("%.17g %.17g %d\n", best[0], best[1], sum > 0.0);
    return 0;
}
