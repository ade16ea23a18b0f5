//! The controller in C compiled without a warning and flown beside that of Rust: the same samples, the same voltages.

#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]
#![expect(clippy::print_stdout, reason = "tests print the figures they check")]
#![expect(clippy::disallowed_methods, reason = "tests write what they compile")]

use hhc_control::{
    ControlLayout, CycleController, EstimatorSettings, HarmonicAnalyser, LoadWeights, Observed,
    RelaxedController, RelaxedSettings, TMatrix,
};
use rotor_export::{ControllerSpec, TKnowledge, controller_files};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;

const CYCLES: usize = 240;
const SAMPLES: usize = 32;
const CYCLE_REV: [usize; 2] = [1, 2];
const LIMIT_VOLT: f64 = 20.0;
/// A load that is lost for some cycles, a jump of Z0, a flap that is lost.
const LOAD_LOST: (usize, usize, usize) = (3, 60, 80);
/// Cycles from which Z0 is so many times that of the start.
const ONE_JUMP: &[(usize, f64)] = &[(110, 5.0)];
const TWO_JUMPS: &[(usize, f64)] = &[(110, 5.0), (113, 12.0)];
const FLAP_LOST: (usize, usize) = (1, 180);
/// Noise of a load, largest, nondimensional.
const NOISE: f64 = 1e-5;
/// Newton and newton metre of a nondimensional load of 1.
const UNITS: [f64; 6] = [2.5e5, 2.5e5, 2.5e5, 1.2e6, 1.2e6, 1.2e6];
/// Places in a line of what the program writes: controls, limit, loads, noise, what was observed, T.
const CONTROLS: usize = 8;
const LINE: usize = CONTROLS + 1 + 12 + 2 + 12 * CONTROLS;

/// A number between -1 and 1 without a pattern.
fn draw(seed: usize) -> f64 {
    let x = (12.9898 * seed as f64 + 78.233).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// T at a speed, 1/V: 12 loads, two flaps at 3 and 4 per rev.
fn t_at(advance_ratio: f64) -> TMatrix {
    let element = |control: usize, load: usize| {
        1e-5 * (draw(31 * control + load) + 3.0 * advance_ratio * draw(7000 + 31 * control + load))
    };
    let column = |control| (0..12).map(|load| element(control, load)).collect();
    TMatrix::from_columns(&(0..CONTROLS).map(column).collect::<Vec<Vec<f64>>>()).unwrap()
}

fn baseline() -> Vec<f64> {
    (0..12).map(|load| 1e-4 * draw(90_000 + load)).collect()
}

fn spec(knowledge: TKnowledge) -> ControllerSpec {
    let layout = ControlLayout::new(2, vec![3, 4]).unwrap();
    let weights = (0..12).map(|k| if k < 6 { 1.0 } else { 0.5 }).collect();
    let settings = RelaxedSettings {
        load_weights: LoadWeights::Diagonal(weights),
        effort_weight: 1e-12,
        rate_weight: 1e-12,
        flap_survival: 0.9,
        dead_flap_cost: 1.02,
        gain: 0.5,
        amplitude_limit_volt: vec![LIMIT_VOLT, 15.0, f64::INFINITY, LIMIT_VOLT],
        rate_limit_volt: 8.0,
    };
    let names = ["FX, N", "FY, N", "FZ, N", "MX, N m", "MY, N m", "MZ, N m"];
    ControllerSpec {
        title: "Test of a controller".to_owned(),
        layout,
        settings,
        knowledge,
        channels: names.iter().zip(UNITS).map(|(name, unit)| ((*name).to_owned(), unit)).collect(),
        load_harmonic: 4,
        samples_per_rev: SAMPLES,
        cycle_rev: CYCLE_REV,
    }
}

fn adaptive(noise_share: Option<f64>) -> TKnowledge {
    // one of the two has a trend of Z0 and turns its control to and fro
    let (trend_drift, dither_rad) = if noise_share.is_some() { (0.0, 0.0) } else { (0.01, 0.1) };
    let settings = EstimatorSettings {
        noise_share,
        trend_drift,
        dither_rad,
        ..EstimatorSettings::in_flight(85.0)
    };
    TKnowledge::Adaptive {
        settings,
        t0: t_at(0.15).turned(1.2, 0.2).unwrap(),
        baseline: baseline(),
    }
}

fn scheduled() -> TKnowledge {
    let advance_ratios = vec![0.18, 0.22, 0.27];
    let t = advance_ratios.iter().map(|&advance_ratio| t_at(advance_ratio)).collect();
    TKnowledge::Scheduled { advance_ratios, t }
}

/// The controller of Rust that a specification describes.
enum Pilot {
    Given(Box<RelaxedController>, TKnowledge),
    Estimated(Box<CycleController>),
}

impl Pilot {
    fn new(spec: &ControllerSpec) -> Self {
        let relaxed = RelaxedController::new(&spec.layout, 12, spec.settings.clone()).unwrap();
        match &spec.knowledge {
            TKnowledge::Adaptive { settings, t0, baseline } => {
                let cycle = CycleController::new(relaxed, settings, t0, baseline).unwrap();
                Self::Estimated(Box::new(cycle))
            }
            known => Self::Given(Box::new(relaxed), known.clone()),
        }
    }

    fn controller(&self) -> &RelaxedController {
        match self {
            Self::Given(relaxed, _) => relaxed,
            Self::Estimated(cycle) => cycle.controller(),
        }
    }

    /// The control that acts.
    fn control_volt(&self) -> &[f64] {
        match self {
            Self::Given(relaxed, _) => relaxed.control_volt(),
            Self::Estimated(cycle) => cycle.control_volt(),
        }
    }

    fn events(&mut self, cycle: usize) {
        let (load, lost, found) = LOAD_LOST;
        if cycle == lost || cycle == found {
            match self {
                Self::Given(relaxed, _) => relaxed.set_load_lost(load, cycle == lost).unwrap(),
                Self::Estimated(own) => own.set_load_lost(load, cycle == lost).unwrap(),
            }
        }
        if cycle == FLAP_LOST.1 {
            match self {
                Self::Given(relaxed, _) => relaxed.set_flap_lost(FLAP_LOST.0, true).unwrap(),
                Self::Estimated(own) => own.lose_flap(FLAP_LOST.0).unwrap(),
            }
        }
    }

    /// The line of a cycle as the program writes it.
    fn step(&mut self, advance_ratio: f64, loads: &[f64]) -> Vec<f64> {
        let mut noise_and_t = vec![0.0; 2 + 12 * CONTROLS];
        match self {
            Self::Given(relaxed, TKnowledge::Scheduled { advance_ratios, t }) => {
                // between the knots by a formula of its own
                let inside = advance_ratio.clamp(advance_ratios[0], advance_ratios[2]);
                let low = usize::from(inside > advance_ratios[1]);
                let span = advance_ratios[low + 1] - advance_ratios[low];
                let share = (inside - advance_ratios[low]) / span;
                let mean: Vec<Vec<f64>> = (t[low].as_matrix() * (1.0 - share)
                    + t[low + 1].as_matrix() * share)
                    .column_iter()
                    .map(|column| column.iter().copied().collect())
                    .collect();
                relaxed.step(&TMatrix::from_columns(&mean).unwrap(), loads).unwrap();
            }
            Self::Given(relaxed, TKnowledge::Fixed(t)) => {
                relaxed.step(t, loads).unwrap();
            }
            Self::Given(..) => unreachable!(),
            Self::Estimated(cycle) => {
                cycle.step(loads).unwrap();
                let t = cycle.estimator().t().as_matrix();
                noise_and_t[0] = cycle.estimator().noise();
                noise_and_t[1] = match cycle.observed() {
                    Observed::AsExpected => 0.0,
                    Observed::BaselineJump => 1.0,
                    Observed::SensitivityJump => 2.0,
                };
                for (index, value) in noise_and_t[2..].iter_mut().enumerate() {
                    *value = t[(index / CONTROLS, index % CONTROLS)];
                }
            }
        }
        let mut line = self.control_volt().to_vec();
        line.push(f64::from(u8::from(self.controller().is_limited())));
        line.extend(loads);
        line.extend(noise_and_t);
        line
    }
}

/// Flies the controller of Rust: the samples, advance ratio first, and a line for every cycle.
fn flown(spec: &ControllerSpec, jumps: &[(usize, f64)]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut pilot = Pilot::new(spec);
    let mut analyser = HarmonicAnalyser::new(6, SAMPLES, CYCLE_REV[1], &[4]).unwrap();
    let (mut samples, mut lines) = (Vec::new(), Vec::new());
    for cycle in 0..CYCLES {
        pilot.events(cycle);
        let advance_ratio = 0.15 + 0.15 * (cycle as f64 / 120.0).min(1.0);
        let mut control = pilot.control_volt().to_vec();
        if cycle >= FLAP_LOST.1 {
            control[FLAP_LOST.0 * 4..].fill(0.0);
        }
        let moved = t_at(advance_ratio).loads_for(&control).unwrap();
        let jump = jumps.iter().rfind(|(at, _)| cycle >= *at).map_or(1.0, |(_, size)| *size);
        let z: Vec<f64> =
            baseline().iter().zip(moved).map(|(rest, moved)| jump * rest + moved).collect();
        let mut found = Vec::new();
        analyser.reset();
        for k in 0..(CYCLE_REV[0] + CYCLE_REV[1]) * SAMPLES {
            let psi = TAU * k as f64 / SAMPLES as f64;
            let hub: [f64; 6] = std::array::from_fn(|c| {
                let four = z[2 * c] * (4.0 * psi).cos() + z[2 * c + 1] * (4.0 * psi).sin();
                let others = 1e-3 * (0.3 + (3.0 * psi).cos() - 2.0 * psi.sin());
                UNITS[c] * (four + others + NOISE * draw(cycle * 100_000 + k * 10 + c))
            });
            samples.push(advance_ratio);
            samples.extend(hub);
            if k >= CYCLE_REV[0] * SAMPLES {
                let hub: Vec<f64> = hub.iter().zip(UNITS).map(|(load, unit)| load / unit).collect();
                found = analyser.push(&hub).unwrap().map(<[f64]>::to_vec).unwrap_or(found);
            }
        }
        lines.push(pilot.step(advance_ratio, &found));
    }
    (samples, lines)
}

/// Flies the generated controller over the samples of the file `in` and writes the lines to `out`.
const PROGRAM: &str = r#"
#include <math.h>
#include <stdio.h>
#include "NAME.h"

int main(void)
{
    NAME_state s;
    double sample[1 + UPPER_CHANNELS], line[LINE];
    int cycle = 0, i, k, rest = SAMPLES_PER_CYCLE;
    FILE *in = fopen("in", "rb"), *out = fopen("out", "wb");
    NAME_start(&s);
    if (NAME_sample(&s, (const double[6]){NAN, 0, 0, 0, 0, 0}, 0.1) != UPPER_BAD_INPUT) return 2;
    if (NAME_sample(&s, (const double[6]){0, 0, 0, 0, 0, 0}, NAN) != UPPER_BAD_INPUT) return 3;
    /* samples that are lost would turn the loads: a cycle begins anew */
    for (i = 0; i < SAMPLES_PER_CYCLE - 3; ++i) {
        if (NAME_sample(&s, (const double[6]){9, 9, 9, 9, 9, 9}, 0.1) != UPPER_TAKEN) return 6;
    }
    if (NAME_sample(&s, (const double[6]){INFINITY, 0, 0, 0, 0, 0}, 0.1) != UPPER_BAD_INPUT) return 7;
    NAME_resync(&s);
    for (i = 0; i < UPPER_LOADS; ++i) line[i] = 1e101;
    if (NAME_cycle(&s, line, 0.1) != UPPER_BAD_INPUT) return 8;
    /* a sample too large to be one is not counted: the one given in its place ends the cycle */
    for (i = 0; i < SAMPLES_PER_CYCLE; ++i) {
        const int is_last = i + 1 == SAMPLES_PER_CYCLE;
        if (is_last && NAME_sample(&s, (const double[6]){1e108, 0, 0, 0, 0, 0}, 0.1) != UPPER_BAD_INPUT) return 9;
        k = NAME_sample(&s, (const double[6]){9, 9, 9, 9, 9, 9}, 0.1);
        if (k != (is_last ? UPPER_STEPPED : UPPER_TAKEN)) return 10;
    }
    /* the largest harmonic that samples within the bound can have is a load */
    NAME_start(&s);
    for (i = 0; i < SAMPLES_PER_CYCLE; ++i) {
        const double side = cos(4.0 * 6.283185307179586 * i / 32.0) < 0.0 ? -4.9e99 : 4.9e99;
        k = NAME_sample(&s, (const double[6]){2.5e5 * side, 0, 0, 0, 0, 0}, 0.1);
        if (k == UPPER_BAD_INPUT) return 11;
    }
    NAME_start(&s);
    while (fread(sample, sizeof sample, 1, in) == 1) {
        if (rest == SAMPLES_PER_CYCLE) {
            EVENTS
        }
        if (NAME_sample(&s, sample + 1, sample[0]) == UPPER_STEPPED) {
            double *to = line;
            for (k = 0; k < UPPER_CONTROLS; ++k) *to++ = s.control_volt[k];
            *to++ = s.is_limited;
            for (k = 0; k < UPPER_LOADS; ++k) *to++ = s.loads[k];
            for (i = 0; i < 2 + UPPER_LOADS * UPPER_CONTROLS; ++i) to[i] = 0.0;
            ESTIMATE
            if (rest != 1) return 4;
            fwrite(line, sizeof line, 1, out);
            ++cycle;
        }
        rest = rest == 1 ? SAMPLES_PER_CYCLE : rest - 1;
    }
    if (!(fabs(NAME_volt(&s, 0, 0.3) - s.control_volt[0] * cos(3.0 * 0.3) - s.control_volt[1] * sin(3.0 * 0.3)
            - s.control_volt[2] * cos(4.0 * 0.3) - s.control_volt[3] * sin(4.0 * 0.3)) < 1e-12)) return 5;
    return fclose(out);
}
"#;

fn program(name: &str, is_estimated: bool) -> String {
    let (load, lost, found) = LOAD_LOST;
    let (flap, at) = FLAP_LOST;
    let events = format!(
        "if (cycle == {lost}) NAME_lose_load(&s, {load}, 1);
            if (cycle == {found}) NAME_lose_load(&s, {load}, 0);
            if (cycle == {at}) NAME_lose_flap(&s, {flap});"
    );
    let estimate = "to[0] = sqrt(s.noise_variance);
            to[1] = s.observed;
            for (i = 0; i < UPPER_LOADS; ++i)
                for (k = 0; k < UPPER_CONTROLS; ++k)
                    to[2 + i * UPPER_CONTROLS + k] = s.theta[i][k + 1] / 85.0;";
    let samples = (CYCLE_REV[0] + CYCLE_REV[1]) * SAMPLES;
    PROGRAM
        .replace("EVENTS", &events)
        .replace("ESTIMATE", if is_estimated { estimate } else { "" })
        .replace("SAMPLES_PER_CYCLE", &samples.to_string())
        .replace("LINE", &LINE.to_string())
        .replace("UPPER", &name.to_uppercase())
        .replace("NAME_", &format!("{name}_"))
        .replace("NAME.h", &format!("{name}.h"))
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rotor-export").join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn run(folder: &Path, program: &str, arguments: &[&str]) {
    let output = Command::new(program).args(arguments).current_dir(folder).output().unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{program} {arguments:?}: {:?}\n{complaint}", output.status);
}

/// Compiles a controller, flies it over the samples and reads its lines.
fn in_c(spec: &ControllerSpec, name: &str, samples: &[f64]) -> Vec<Vec<f64>> {
    let folder = folder(name);
    for (file, text) in controller_files(spec, name).unwrap() {
        std::fs::write(folder.join(file), text).unwrap();
    }
    let is_estimated = matches!(spec.knowledge, TKnowledge::Adaptive { .. });
    let text = program(name, is_estimated);
    std::fs::write(folder.join("program.c"), text).unwrap();
    let strict = ["-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"];
    let source = format!("{name}.c");
    let mut arguments = vec!["-std=c99"];
    arguments.extend(strict);
    arguments.extend(["-o", "program", "program.c", &source, "-lm"]);
    run(&folder, "cc", &arguments);
    // it is C++ too
    let plus = ["-x", "c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-pedantic", "-c"];
    run(&folder, "c++", &[&plus[..], &[&source, "-o", "plus.o"]].concat());
    let bytes: Vec<u8> = samples.iter().flat_map(|value| value.to_le_bytes()).collect();
    std::fs::write(folder.join("in"), bytes).unwrap();
    run(&folder, "./program", &[]);
    let bytes = std::fs::read(folder.join("out")).unwrap();
    let (numbers, _) = bytes.as_chunks::<8>();
    let numbers: Vec<f64> = numbers.iter().map(|number| f64::from_le_bytes(*number)).collect();
    numbers.chunks(LINE).map(<[f64]>::to_vec).collect()
}

fn largest(lines: &[Vec<f64>], others: &[Vec<f64>], columns: std::ops::Range<usize>) -> f64 {
    let pairs = lines.iter().zip(others).flat_map(|(a, b)| {
        let own = a[columns.clone()].iter().zip(&b[columns.clone()]);
        own.map(|(a, b)| (a - b).abs())
    });
    pairs.fold(0.0, f64::max)
}

fn flies_alike(knowledge: TKnowledge, name: &str, jumps: &[(usize, f64)]) -> Vec<Vec<f64>> {
    let spec = spec(knowledge);
    let (samples, expected) = flown(&spec, jumps);
    let found = in_c(&spec, name, &samples);
    assert_eq!(found.len(), CYCLES);
    let (limit, loads) = (CONTROLS, CONTROLS + 1..CONTROLS + 13);
    let size = |columns: std::ops::Range<usize>| {
        let zero = vec![vec![0.0; LINE]; CYCLES];
        largest(&expected, &zero, columns).max(f64::MIN_POSITIVE)
    };
    let t = CONTROLS + 15..LINE;
    let off = [
        largest(&found, &expected, 0..CONTROLS) / LIMIT_VOLT,
        largest(&found, &expected, loads.clone()) / size(loads),
        largest(&found, &expected, CONTROLS + 13..CONTROLS + 15),
        largest(&found, &expected, t.clone()) / size(t),
    ];
    let told = off.map(|off| format!("{off:.1e}")).join(", ");
    println!("{name}: voltage, loads, noise and T differ by {told}");
    assert!(off.iter().all(|off| *off <= 1e-12), "{name}: {off:?}");
    let limited = |lines: &[Vec<f64>]| lines.iter().filter(|line| line[limit] > 0.5).count();
    assert_eq!(largest(&found, &expected, limit..limit + 1).to_bits(), 0);
    let count = limited(&expected);
    println!("{name}: a limit binds in {count} of {CYCLES} cycles");
    assert!(count > 20 && count < CYCLES - 20, "with limits and without: {count}");
    expected
}

#[test]
fn a_fixed_t_gives_the_voltages_of_rust() {
    flies_alike(TKnowledge::Fixed(t_at(0.15)), "pilot_fixed", ONE_JUMP);
}

#[test]
fn a_scheduled_t_gives_the_voltages_of_rust() {
    let own = flies_alike(scheduled(), "pilot_scheduled", ONE_JUMP);
    // and others than the T of one speed
    let (_, fixed) = flown(&spec(TKnowledge::Fixed(t_at(0.18))), ONE_JUMP);
    assert!(largest(&own, &fixed, 0..CONTROLS) > 0.1);
}

#[test]
fn an_estimated_t_gives_the_voltages_of_rust() {
    let own = flies_alike(adaptive(None), "pilot_adaptive", ONE_JUMP);
    assert!(observed(&own, 1.0) > 0, "the jump of Z0 is seen");
    let t = CONTROLS + 15..LINE;
    let learnt = largest(&own[..1], &own[CYCLES - 1..], t);
    assert!(learnt > 1e-6, "T is learnt: {learnt}");
}

#[test]
fn an_estimated_t_with_its_noise_told_gives_the_voltages_of_rust() {
    flies_alike(adaptive(Some(0.01)), "pilot_told", ONE_JUMP);
}

/// Cycles of which a code of what was observed stands in the lines.
fn observed(lines: &[Vec<f64>], code: f64) -> usize {
    lines.iter().filter(|line| (line[CONTROLS + 14] - code).abs() < 0.5).count()
}

/// A second jump soon after the first frees T too: in C as in Rust, and T then goes another way than after one jump.
#[test]
fn a_jump_that_frees_t_gives_the_voltages_of_rust() {
    for (knowledge, name) in
        [(adaptive(None), "pilot_freed"), (adaptive(Some(0.01)), "pilot_freed_told")]
    {
        let own = flies_alike(knowledge, name, TWO_JUMPS);
        assert!(observed(&own, 1.0) > 0 && observed(&own, 2.0) > 0, "{name}: T is freed");
    }
}

#[test]
fn what_no_controller_takes_is_refused() {
    let refused = |spec: &ControllerSpec, name: &str, part: &str| {
        let told = controller_files(spec, name).unwrap_err().to_string();
        assert!(told.contains(part), "{told}");
    };
    let good = spec(scheduled());
    refused(&good, "2 pilots", "2 pilots");
    refused(
        &ControllerSpec { samples_per_rev: 8, ..good.clone() },
        "pilot",
        "samples per revolution",
    );
    refused(&ControllerSpec { cycle_rev: [1, 0], ..good.clone() }, "pilot", "window");
    let few = ControllerSpec { channels: good.channels[..5].to_vec(), ..good.clone() };
    refused(&few, "pilot", "weights");
    let still = ControllerSpec { channels: vec![("FX".to_owned(), 0.0); 6], ..good.clone() };
    refused(&still, "pilot", "unit of a load");
    let knowledge = TKnowledge::Scheduled { advance_ratios: vec![0.3, 0.2], t: vec![t_at(0.2); 2] };
    refused(&ControllerSpec { knowledge, ..good.clone() }, "pilot", "that rise");
    let narrow = TMatrix::from_columns(&[vec![1.0; 12]]).unwrap();
    let knowledge = TKnowledge::Fixed(narrow);
    refused(&ControllerSpec { knowledge, ..good }, "pilot", "controls of the T matrix");
}
