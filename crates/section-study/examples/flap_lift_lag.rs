//! How much of a flap's quasi-steady lift is left at the reduced frequencies of vibration control, and how late it comes.
//!
//! ```text
//! cargo run --release -p section-study --example flap_lift_lag
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use flap_aero::{AeroError, AttachedFlowModel, FlapEffectiveness, Motion};
use section_study::{SectionChoice, section_response};

fn main() -> Result<(), AeroError> {
    let section = SectionChoice {
        model: AttachedFlowModel::Calibrated,
        mach: 0.5,
        flap_chord: 0.2,
        effectiveness: FlapEffectiveness::default(),
    };
    let steady = section_response(&section, Motion::Flap, 1e-6)?.cn;
    println!("     k   lift left, percent   lag, deg");
    for k in [0.02, 0.05, 0.1, 0.2, 0.4] {
        let [re, im] = section_response(&section, Motion::Flap, k)?.cn;
        let left = 100.0 * re.hypot(im) / steady[0].hypot(steady[1]);
        println!("{k:6.2}   {left:18.1}   {:8.1}", -im.atan2(re).to_degrees());
    }
    let remarks = section_response(&section, Motion::Flap, 0.4)?.remarks;
    println!("{}", remarks.join("\n"));
    Ok(())
}
