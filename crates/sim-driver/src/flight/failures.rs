//! What control reaches under failures, as a table.

use report_page::Section;
use rotor_flight::{FailureLine, FailureStudy};

/// For people.
pub(super) fn section(study: &FailureStudy) -> Section {
    let row = |line: &FailureLine| {
        vec![
            line.failure.name(),
            line.control.name().to_owned(),
            format!("{:.3}", line.cost_ratio),
            line.worst_ratio.map_or_else(|| "-".to_owned(), |worst| format!("{worst:.2}")),
            format!("{:.4}", line.once_per_rev_ratio),
            format!("{:.4}", line.other_ratio),
            format!("{:.1}", line.largest_volt),
        ]
    };
    let header = ["fails", "control", "J/J0", "worst", "1/rev", "others", "largest, V"];
    Section {
        title: "Failures".to_owned(),
        text: format!(
            "Flap {} of one blade, or the cell of {}. The rotor is nonlinear, each blade for itself, in the inflow and at the controls of its trim; flaps follow their voltages without hysteresis. J/J0 is at the blade number per rev after 30 cycles, worst of any under control; 1/rev and others: J of the loads that blades alike cancel, over the same J0.",
            study.flap, study.load
        ),
        header: header.map(str::to_owned).into(),
        rows: study.lines.iter().map(row).collect(),
    }
}
