//! What a sample of the generated C costs: `cargo run --release -p actuator-export --example cost`.
//!
//! Bar: 200 ns for a forward step at 40 levels. Needs `cc`.
#![expect(clippy::disallowed_methods, reason = "an example writes what it compiles")]
#![expect(clippy::print_stdout, reason = "an example reports")]

use actuator_export::{Target, export};
use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, BoucWen, BoucWenParameters, Calibration,
    DynamicParameters, DynamicPreisach, Envelope, LinkageStage, LogCreep, PlayMap,
    PrandtlIshlinskii, PrandtlParameters, PrandtlStop, PreisachError, PreisachGrid, RateForm,
    Relaxation, RelaxationElement, StaticPreisach, StopParameters, TimeOrder, VoltageRange,
    WeightedPlay, WeightedStop,
};
use std::error::Error;
use std::process::Command;

const LEVELS: usize = 40;
const TIME_STEP_S: f64 = 2.5e-4;
const BAR_NS: f64 = 200.0;
const RANGE: VoltageRange = VoltageRange::amplified_stack();

fn map(grid: &PreisachGrid, size: f64) -> Result<PlayMap, PreisachError> {
    let rises: Vec<Vec<f64>> = (0..grid.levels())
        .map(|j| (0..grid.levels() - j).map(|k| size * (1.5 + ((j * k) as f64).sin())).collect())
        .collect();
    PlayMap::from_rises(grid, 0.0, &rises)
}

fn plain(law: ActuatorLaw) -> ActuatorModel {
    ActuatorModel::new(law, RANGE, Calibration { deg_per_um: 0.04, zero_um: 0.0 })
}

fn models() -> Result<Vec<(&'static str, ActuatorModel)>, PreisachError> {
    let grid = PreisachGrid::new(RANGE, LEVELS)?;
    let g0_deg = map(&grid, 0.02)?;
    let statics = plain(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, g0_deg.clone())?));
    let mut g1_s = map(&grid, 1e-6)?;
    g1_s.constant = -0.02;
    let dynamic = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg,
        g1_s,
        g2_s2_per_deg: map(&grid, 1e-9)?,
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 500.0,
        time_order: TimeOrder::Second,
    })?;
    let volts = || (1..=12_u32).map(|i| 4.0 * f64::from(i));
    let play = |threshold_volt| WeightedPlay { threshold_volt, weight_deg_per_volt: 0.01 };
    let prandtl = PrandtlIshlinskii::new(PrandtlParameters {
        range_volt: RANGE,
        gain_deg_per_volt: 0.05,
        plays: volts().map(play).collect(),
        threshold_growth_s: 2e-4,
        envelope: Envelope::default(),
    })?;
    let stop = |threshold_volt| WeightedStop { threshold_volt, stiffness_deg_per_volt: 0.01 };
    let stops = PrandtlStop::new(StopParameters {
        range_volt: RANGE,
        stiffness_deg_per_volt: 0.05,
        stops: volts().map(stop).collect(),
        viscosity_deg_s_per_volt: 1e-4,
        offset_deg: 0.0,
    })?;
    let bouc_wen = |exponent| {
        BoucWen::new(BoucWenParameters {
            range_volt: RANGE,
            gain_deg_per_volt: 0.12,
            half_height_deg: 0.9,
            rise_volt: 30.0,
            sigma: 0.8,
            exponent,
            envelope: Envelope::default(),
        })
    };
    let element = |share, time_constant_s| RelaxationElement { share, time_constant_s };
    let elements = vec![element(0.3, 2e-3), element(0.3, 0.01), element(0.2, 0.05)];
    let late = Accommodation { share: 0.05, travel_um: 60.0 };
    let chain = ActuatorModel {
        linkage: vec![
            LinkageStage::Accommodation(late),
            LinkageStage::Relaxation(Relaxation { elements }),
            LinkageStage::LogCreep(LogCreep::new(0.015)),
        ],
        ..statics.clone()
    };
    Ok(vec![
        ("linear", ActuatorModel::linear(RANGE, 10.0, 0.04)),
        ("static_preisach", statics),
        ("dynamic_preisach", plain(ActuatorLaw::DynamicPreisach(dynamic))),
        ("static_with_linkage", chain),
        ("prandtl_ishlinskii", plain(ActuatorLaw::PrandtlIshlinskii(prandtl))),
        ("bouc_wen_n2", plain(ActuatorLaw::BoucWen(bouc_wen(2.0)?))),
        ("bouc_wen_n1p6", plain(ActuatorLaw::BoucWen(bouc_wen(1.6)?))),
        ("prandtl_stops", plain(ActuatorLaw::PrandtlStop(stops))),
    ])
}

/// A program that times the forward and the inverse steps of one export: ns per sample of the best of some rounds.
const PROGRAM: &str = r#"
#include <math.h>
#include <stdio.h>
#include <time.h>
#include "NAME.h"

enum { SAMPLES = 4000, ROUNDS = 60 };
static double volts[SAMPLES], degs[SAMPLES];

int main(void)
{
    NAME_state s;
    NAME_inverse_state c;
    double best[2] = {1e9, 1e9}, sum = 0.0;
    int i, round;
    for (i = 0; i < SAMPLES; ++i) {
        const double t = 2.5e-4 * i;
        volts[i] = 65.0 + 12.0 * cos(62.8 * t) + 12.0 * sin(94.2 * t) + 9.0 * cos(125.7 * t);
    }
    for (round = 0; round < ROUNDS; ++round) {
        clock_t start = clock();
        double ns;
        NAME_start(&s, volts[0]);
        for (i = 0; i < SAMPLES; ++i) {
            degs[i] = NAME_step(&s, volts[i]);
        }
        ns = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC / SAMPLES;
        best[0] = ns < best[0] ? ns : best[0];
        start = clock();
        NAME_inverse_start(&c, volts[0]);
        for (i = 0; i < SAMPLES; ++i) {
            sum += NAME_inverse_step(&c, degs[i]);
        }
        ns = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC / SAMPLES;
        best[1] = ns < best[1] ? ns : best[1];
    }
    printf("%.17g %.17g %d\n", best[0], best[1], sum > 0.0);
    return 0;
}
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join("actuator-export-cost");
    std::fs::create_dir_all(&folder)?;
    println!("ns per sample at {LEVELS} levels, cc -O2, one core; bar {BAR_NS} ns forward");
    println!("{:<22}{:>10}{:>12}{:>10}", "actuator", "forward", "of the bar", "inverse");
    for (name, model) in models()? {
        for (file, text) in export(&model, name, TIME_STEP_S, Target::C)? {
            std::fs::write(folder.join(file), text)?;
        }
        std::fs::write(folder.join("main.c"), PROGRAM.replace("NAME", name))?;
        let source = format!("{name}.c");
        let arguments = ["-std=c99", "-O2", "-o", "main", "main.c", &source, "-lm"];
        let compiled = Command::new("cc").args(arguments).current_dir(&folder).status()?;
        if !compiled.success() {
            return Err(format!("cc failed on {source}").into());
        }
        let output = Command::new(folder.join("main")).output()?;
        let printed = String::from_utf8(output.stdout)?;
        let numbers: Vec<f64> = printed.split_whitespace().map_while(|n| n.parse().ok()).collect();
        let [forward, inverse, _] = numbers[..] else {
            return Err(format!("{name} printed {printed}").into());
        };
        println!("{name:<22}{forward:>10.1}{:>12.2}{inverse:>10.1}", forward / BAR_NS);
    }
    Ok(())
}
