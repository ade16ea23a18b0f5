//! A sweep of one's own model: the frequency of a spring and a mass over both, in two parts, merged into one table.
//!
//! ```text
//! cargo run -p case-sweep --example many_springs
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use case_sweep::{
    Failed, Found, NoNumbers, ReadCase, Runner, Shard, Store, merge, plan, read_sweep_file, run,
};
use measured_data::problem::Problems;
use measured_data::{Folder, Source, read_ron, ron_text};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Spring {
    stiffness_n_per_m: f64,
    mass_kg: f64,
}

struct Springs;

impl Runner for Springs {
    type Case = Spring;

    fn version(&self) -> &'static str {
        "springs 1"
    }

    fn read(&self, text: &str) -> Result<ReadCase<Spring>, Problems> {
        let read = read_ron::<Spring>(&Source { name: "spring".into(), text: text.into() });
        let spring = read.problems.into_result(read.value)?;
        let canonical = ron_text(&spring).unwrap_or_default();
        Ok(ReadCase { canonical, inputs: vec![], case: spring })
    }

    fn unit(&self, _: &Spring, field: &str) -> Option<String> {
        match field {
            "stiffness_n_per_m" => Some("N/m".to_owned()),
            "mass_kg" => Some("kg".to_owned()),
            _ => None,
        }
    }

    fn run(&self, spring: Spring) -> Result<Found, NoNumbers> {
        let hz = (spring.stiffness_n_per_m / spring.mass_kg).sqrt() / TAU;
        Ok(Found { columns: vec![("frequency_hz".to_owned(), hz.into())], warnings: vec![] })
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = "(base: \"spring.ron\", axes: [
        (field: \"stiffness_n_per_m\", from: 100, to: 400, count: 4),
        (field: \"mass_kg\", values: [1, 2]),
    ])";
    let source = Source { name: "sweep.ron".into(), text: text.into() };
    let file = read_sweep_file(&source, &Folder::Disk(".".into()))?;
    let base = Springs.read("(stiffness_n_per_m: 100, mass_kg: 1)")?.canonical;
    let plan = plan(&file, base, &Springs)?;
    let folder = tempfile::tempdir()?;
    let store = Store::new(folder.path());
    // as two machines would; none starts from what another found
    for part in ["1/2", "2/2"] {
        run(&plan, (Shard::parse(part)?, Failed::Left), &store, &Springs, &|_| {})?;
    }
    print!("{}", merge(&plan, &store, false)?.csv());
    Ok(())
}
