//! C: compiled without a warning, the same numbers as the model, and the flap where it is wanted.

use crate::common::{
    DEG_PER_UM, Named, Run, amplitude, bench, by_time_step, folder, largest_difference, laws,
    linear, prandtl, read_numbers, run, stages, statics, there_is, wanted, write, write_numbers,
};
use actuator_export::{Target, export};
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::{BenchRecord, Settings, identify};
use std::path::Path;

const STRICT: [&str; 6] = ["-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"];

/// A program that runs all models over a file of numbers: `forward IN OUT` writes the angles of every model,
/// `inverse IN OUT` the voltages, the angles expected and the flags.
fn program(models: &[Named]) -> String {
    let for_each = |text: &str| -> String {
        models.iter().map(|named| text.replace("NAME", named.name)).collect()
    };
    PROGRAM
        .replace("INCLUDES", &for_each("#include \"NAME.h\"\n"))
        .replace("RUNS", &for_each("    run_NAME(forward, n, out);\n"))
        .replace("FUNCTIONS", &for_each(FUNCTION))
}

const PROGRAM: &str = r#"
#include <stdio.h>
#include <string.h>
INCLUDES
static double x[200000], y[600000];
FUNCTIONS
int main(int argc, char **argv)
{
    const int forward = argc > 1 && strcmp(argv[1], "forward") == 0;
    FILE *in = fopen(argv[2], "rb"), *out = fopen(argv[3], "wb");
    const size_t n = fread(x, sizeof x[0], 200000, in);
    fclose(in);
RUNS
    return fclose(out);
}
"#;

const FUNCTION: &str = r"
static void run_NAME(int forward, size_t n, FILE *out)
{
    NAME_state s;
    NAME_inverse_state c;
    size_t i;
    if (forward) {
        for (i = 0; i < n; ++i) {
            y[i] = i == 0 ? NAME_start(&s, x[i]) : NAME_step(&s, x[i]);
        }
        fwrite(y, sizeof y[0], n, out);
        return;
    }
    NAME_inverse_start(&c, NAME_rest_volt(x[0]));
    for (i = 0; i < n; ++i) {
        if (i > 0) {
            NAME_inverse_step(&c, x[i]);
        }
        y[i] = c.volt;
        y[n + i] = c.model.output_deg;
        y[2 * n + i] = c.out_of_reach;
    }
    fwrite(y, sizeof y[0], 3 * n, out);
}
";

/// Exports and compiles models for one time step.
fn compiled(folder: &Path, models: &[Named], time_step_s: f64) {
    std::fs::write(folder.join("program.c"), program(models)).unwrap();
    let mut arguments = vec!["-std=c99"];
    arguments.extend(STRICT);
    let sources: Vec<String> = models.iter().map(|named| format!("{}.c", named.name)).collect();
    for named in models {
        write(folder, named, time_step_s, Target::C);
    }
    arguments.extend(["-o", "program", "program.c"]);
    arguments.extend(sources.iter().map(String::as_str));
    arguments.push("-lm");
    run(folder, "cc", &arguments);
}

fn forward_agrees(label: &str, models: &[Named]) {
    for (group, (time_step_s, runs)) in by_time_step(bench()).into_iter().enumerate() {
        let folder = folder(&format!("c_{label}_{group}"));
        compiled(&folder, models, time_step_s);
        for bench_run in runs {
            write_numbers(&folder.join("in"), &bench_run.volts);
            run(&folder, "./program", &["forward", "in", "out"]);
            let numbers = read_numbers(&folder.join("out"));
            let outputs = numbers.chunks(bench_run.volts.len());
            assert_eq!(outputs.len(), models.len());
            for (Named { name, model }, got) in models.iter().zip(outputs) {
                let expected = model.simulate(&bench_run.volts, time_step_s).unwrap().output_deg;
                let off = largest_difference(got, &expected) / amplitude(&expected);
                println!("{} {name}: {off:.1e} of the amplitude", bench_run.id);
                assert!(off <= 1e-12, "{} {name}: {off}", bench_run.id);
            }
        }
    }
}

#[test]
fn every_law_gives_the_numbers_of_the_model_on_all_bench_commands() {
    forward_agrees("laws", &laws());
}

#[test]
fn every_stage_gives_the_numbers_of_the_model_on_all_bench_commands() {
    forward_agrees("stages", &stages());
}

/// Voltages, expected angles and flags of one model.
struct Inverse {
    volts: Vec<f64>,
    expected_deg: Vec<f64>,
    out_of_reach: Vec<f64>,
}

fn inverse(folder: &Path, models: &[Named], wanted: &[f64]) -> Vec<Inverse> {
    write_numbers(&folder.join("in"), wanted);
    run(folder, "./program", &["inverse", "in", "out"]);
    let numbers = read_numbers(&folder.join("out"));
    let n = wanted.len();
    let of = |part: &[f64]| Inverse {
        volts: part[..n].to_vec(),
        expected_deg: part[n..2 * n].to_vec(),
        out_of_reach: part[2 * n..].to_vec(),
    };
    let found: Vec<Inverse> = numbers.chunks(3 * n).map(of).collect();
    assert_eq!(found.len(), models.len());
    found
}

/// The inverse by C, forward by the model itself: the largest error over the amplitude.
fn error_of(model: &ActuatorModel, found: &Inverse, wanted: &[f64], step_s: f64) -> f64 {
    let got = model.simulate(&found.volts, step_s).unwrap().output_deg;
    assert!(largest_difference(&got, &found.expected_deg) <= 1e-11, "it knows where the flap goes");
    largest_difference(&got, wanted) / amplitude(wanted)
}

const STEP_S: f64 = 5e-4;

#[test]
fn the_inverse_of_every_law_moves_the_flap_as_wanted() {
    let folder = folder("c_inverse_laws");
    let models = laws();
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(2.5, 0.5, STEP_S);
    for (Named { name, model }, found) in models.iter().zip(inverse(&folder, &models, &wanted)) {
        let off = error_of(model, &found, &wanted, STEP_S);
        println!("{name}: {off:.1e} of the amplitude");
        // half-widths that grow with the rate have no exact inverse
        let bar = if *name == "prandtl_rate" { 5e-3 } else { 1e-10 };
        assert!(off <= bar, "{name}: {off}");
        assert!(found.out_of_reach.iter().all(|flag| *flag < 0.5), "{name}");
    }
}

/// What the inverse leaves where half-widths grow with the rate: small while growth times frequency is.
#[test]
fn the_guess_of_the_rate_errs_with_the_growth() {
    let folder = folder("c_growth");
    let growths = [("growth_a", 2.5e-4, 2e-3), ("growth_b", 1e-3, 5e-3), ("growth_c", 4e-3, 0.05)];
    let models = growths.map(|(name, growth_s, _)| Named { name, model: prandtl(growth_s) });
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(2.5, 0.5, STEP_S);
    let found = inverse(&folder, &models, &wanted);
    for ((Named { name, model }, found), (_, growth_s, bar)) in
        models.iter().zip(found).zip(growths)
    {
        let off = error_of(model, &found, &wanted, STEP_S);
        println!("{name}: growth {growth_s} s: {off:.1e} of the amplitude");
        assert!(off <= bar, "{name}: {off}");
    }
}

#[test]
fn the_inverse_undoes_the_stages_too() {
    let folder = folder("c_inverse_stages");
    let models = stages();
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(1.5, 0.5, STEP_S);
    for (Named { name, model }, found) in models.iter().zip(inverse(&folder, &models, &wanted)) {
        let off = error_of(model, &found, &wanted, STEP_S);
        println!("{name}: {off:.1e} of the amplitude");
        if *name == "with_delay" {
            // it comes late and is right otherwise
            let got = model.simulate(&found.volts, STEP_S).unwrap().output_deg;
            let late = largest_difference(&got[4..], &wanted[..wanted.len() - 4]);
            assert!(late / amplitude(&wanted) < 0.05 && off > 0.1, "{late} {off}");
        } else {
            assert!(off <= 5e-3, "{name}: {off}");
            assert!(found.out_of_reach.iter().all(|flag| *flag < 0.5), "{name}");
        }
    }
}

/// A wanted motion of twice the stroke: held at the limits, said so, and right again where it can be.
#[test]
fn out_of_reach_is_said_and_forgotten() {
    let folder = folder("c_out_of_reach");
    let models: Vec<Named> =
        laws().into_iter().filter(|named| named.name != "prandtl_rate").collect();
    compiled(&folder, &models, STEP_S);
    let mut wanted = wanted(2.5, 0.5, STEP_S);
    let half = wanted.len() / 2;
    for value in &mut wanted[half - 200..half - 100] {
        *value += 30.0;
    }
    for (Named { name, model }, found) in models.iter().zip(inverse(&folder, &models, &wanted)) {
        let range = model.range_volt;
        assert!(found.volts.iter().all(|volt| range.excess_volt(*volt) == 0.0), "{name}");
        let flagged: Vec<usize> =
            (0..wanted.len()).filter(|&i| found.out_of_reach[i] > 0.5).collect();
        assert!(flagged.len() >= 100 && flagged[0] == half - 200, "{name}: {flagged:?}");
        let got = model.simulate(&found.volts, STEP_S).unwrap().output_deg;
        let reached = (0..wanted.len()).filter(|i| !flagged.contains(i));
        let worst = reached.fold(0.0, |m, i| f64::max(m, (got[i] - wanted[i]).abs()));
        println!("{name}: {} samples out of reach, {worst:.1e} deg elsewhere", flagged.len());
        assert!(worst < 1e-9 && flagged.len() < 400, "{name}: {worst}, {}", flagged.len());
    }
}

#[test]
fn bad_samples_are_told_and_leave_the_state() {
    let folder = folder("c_bad_samples");
    let named = Named { name: "flap", model: statics(9) };
    write(&folder, &named, 1e-3, Target::C);
    let text = r#"
#include <math.h>
#include "flap.h"

int main(void)
{
    flap_state s;
    flap_inverse_state c;
    double deg;
    flap_start(&s, 65.0);
    deg = flap_step(&s, 80.0);
    if (s.status != 0) return 1;
    if (flap_step(&s, NAN) < deg || s.status != FLAP_BAD_INPUT) return 2;
    if (flap_step(&s, 400.0) <= deg || s.status != FLAP_HELD) return 3;
    flap_inverse_start(&c, 65.0);
    if (flap_inverse_step(&c, NAN) != 65.0) return 4;
    if (!c.out_of_reach) return 5;
    flap_inverse_step(&c, c.model.output_deg + 0.1);
    if (c.out_of_reach || c.volt <= 65.0) return 6;
    flap_start(&s, NAN);
    return s.status == FLAP_BAD_INPUT ? 0 : 7;
}
"#;
    std::fs::write(folder.join("main.c"), text).unwrap();
    run(&folder, "cc", &["-std=c99", "-o", "main", "main.c", "flap.c", "-lm"]);
    run(&folder, "./main", &[]);
}

#[test]
fn it_is_c_plus_plus_too_and_allocates_nothing() {
    let folder = folder("c_plus_plus");
    for named in laws().iter().chain(&stages()) {
        for (file, text) in export(&named.model, named.name, 1e-3, Target::C).unwrap() {
            for word in ["malloc", "calloc", "free(", "{{", "}}", "\t", " \n"] {
                let braces = word.starts_with(['{', '}']) && text.contains("[4] = {");
                assert!(braces || !text.contains(word), "{file}: {word:?}");
            }
            let longest = text.lines().map(str::len).max().unwrap();
            assert!(longest <= 120, "{file}: {longest}");
        }
        if there_is("c++", &["--version"]) {
            write(&folder, named, 1e-3, Target::C);
            let mut arguments = vec!["-x", "c++", "-std=c++11", "-c"];
            arguments.extend(STRICT);
            let source = format!("{}.c", named.name);
            arguments.push(&source);
            run(&folder, "c++", &arguments);
        }
    }
}

/// Every remainder of the four sums.
#[test]
fn the_smallest_grids_compile_and_agree() {
    let names = ["levels_1", "levels_2", "levels_3", "levels_4", "levels_5"];
    let models: Vec<Named> =
        (1..).zip(names).map(|(levels, name)| Named { name, model: statics(levels) }).collect();
    let folder = folder("c_small");
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(2.5, 0.5, STEP_S);
    for (Named { name, model }, found) in models.iter().zip(inverse(&folder, &models, &wanted)) {
        let off = error_of(model, &found, &wanted, STEP_S);
        assert!(off <= 1e-10, "{name}: {off}");
    }
}

/// A negative gain, a law without slope, plays none: what an actuator file may hold.
#[test]
fn odd_models_compile_and_are_inverted_as_far_as_they_can() {
    use preisach_dyn::{ActuatorLaw, PrandtlIshlinskii};
    let mut falling = linear();
    let ActuatorLaw::Linear(law) = &mut falling.law else { panic!("law") };
    law.gain_deg_per_volt = -0.1;
    let mut level = prandtl(0.0);
    let ActuatorLaw::PrandtlIshlinskii(law) = &level.law else { panic!("law") };
    let mut parameters = law.parameters().clone();
    parameters.plays.clear();
    parameters.gain_deg_per_volt = 0.0;
    level.law = ActuatorLaw::PrandtlIshlinskii(PrandtlIshlinskii::new(parameters).unwrap());
    let models = [Named { name: "falling", model: falling }, Named { name: "level", model: level }];
    let folder = folder("c_odd");
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(2.5, 0.5, STEP_S);
    let found = inverse(&folder, &models, &wanted);
    assert!(error_of(&models[0].model, &found[0], &wanted, STEP_S) < 1e-11);
    assert!(found[1].out_of_reach.iter().skip(1).all(|flag| *flag > 0.5));
}

/// The shipped bench identified, exported, and driven with the commands it was identified from.
#[test]
fn an_identified_actuator_is_exported_as_it_is() {
    let record = |run: &Run| BenchRecord {
        id: run.id.clone(),
        time_step_s: run.time_step_s,
        voltage_volt: run.volts.clone(),
        output_deg: run.output_deg.clone(),
        ..BenchRecord::default()
    };
    let records: Vec<BenchRecord> = bench().iter().map(record).collect();
    let settings = Settings { deg_per_um: DEG_PER_UM, ..Settings::default() };
    let identified = identify(&records, &settings).unwrap();
    let models = [
        Named { name: "identified", model: identified.dynamic },
        Named { name: "identified_static", model: identified.static_only },
    ];
    forward_agrees("identified", &models);
    let folder = folder("c_identified_inverse");
    compiled(&folder, &models, STEP_S);
    let wanted = wanted(2.0, 0.0, STEP_S);
    for (Named { name, model }, found) in models.iter().zip(inverse(&folder, &models, &wanted)) {
        let off = error_of(model, &found, &wanted, STEP_S);
        println!("{name}: inverse {off:.1e} of the amplitude");
        assert!(off <= 1e-9, "{name}: {off}");
    }
}
