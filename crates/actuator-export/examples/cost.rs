//! What a sample of the generated C costs: `cargo run --release -p actuator-export --example cost`.
//!
//! Bar: 200 ns for a forward step at 40 levels. Needs `cc`.
#![expect(clippy::disallowed_methods, reason = "an example writes what it compiles")]
#![expect(clippy::print_stdout, reason = "an example reports")]

use actuator_export::{Target, export, timing_program};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, LinkageStage,
    LogCreep, PlayMap, PreisachError, PreisachGrid, RateForm, StaticPreisach, TimeOrder,
    VoltageRange,
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

fn models() -> Result<Vec<(&'static str, ActuatorModel)>, PreisachError> {
    let grid = PreisachGrid::new(RANGE, LEVELS)?;
    let g0_deg = map(&grid, 0.02)?;
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    let plain = |law| ActuatorModel::new(law, RANGE, calibration);
    let statics = plain(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, g0_deg.clone())?));
    let dynamic = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg,
        g1_s: PlayMap { constant: -0.02, ..map(&grid, 1e-6)? },
        g2_s2_per_deg: map(&grid, 1e-9)?,
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 500.0,
        time_order: TimeOrder::Second,
    })?;
    let creep = vec![LinkageStage::LogCreep(LogCreep::new(0.015))];
    Ok(vec![
        ("linear", ActuatorModel::linear(RANGE, 10.0, 0.04)),
        ("static_preisach", statics.clone()),
        ("static_with_creep", ActuatorModel { linkage: creep, ..statics }),
        ("dynamic_preisach", plain(ActuatorLaw::DynamicPreisach(dynamic))),
    ])
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("actuator-export-cost-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    println!("ns per sample at {LEVELS} levels, cc -O2, one core; bar {BAR_NS} ns forward");
    println!("{:<20}{:>10}{:>12}{:>10}", "actuator", "forward", "of the bar", "inverse");
    for (name, model) in models()? {
        for (file, text) in export(&model, name, TIME_STEP_S, Target::C)? {
            std::fs::write(folder.join(file), text)?;
        }
        std::fs::write(folder.join("main.c"), timing_program(&model, name, TIME_STEP_S))?;
        let source = format!("{name}.c");
        let arguments = ["-std=c99", "-O2", "-o", "main", "main.c", &source, "-lm"];
        let compiled = Command::new("cc").args(arguments).current_dir(&folder).status()?;
        if !compiled.success() {
            return Err(format!("cc failed on {source}").into());
        }
        let printed = String::from_utf8(Command::new(folder.join("main")).output()?.stdout)?;
        let ns: Vec<f64> = printed.split_whitespace().map_while(|n| n.parse().ok()).collect();
        println!("{name:<20}{:>10.1}{:>12.2}{:>10.1}", ns[0], ns[0] / BAR_NS, ns[1]);
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}
