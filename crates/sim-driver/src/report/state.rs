//! What the loads of a result rest on, in words: trim, residuals, stability.

use crate::results::{Figures, Residuals};
use rotor_study::{MeanLoads, WakeStatus};

/// The residuals of the trimmed rotor.
pub(crate) fn residuals_text(r: &Residuals) -> String {
    format!("trim {:.1e}, periodicity {:.1e}, inflow {:.1e}", r.trim, r.periodicity, r.inflow)
}

/// What the loads of a result rest on, each line behind its name.
pub(crate) fn state_lines(figures: &Figures) -> Vec<(&'static str, String)> {
    let t = &figures.trim;
    let trim = format!(
        "theta0 {:.4} deg, theta1c {:.4} deg, theta1s {:.4} deg, shaft tilt {:.4} deg, bank {:.4} deg",
        t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg
    );
    let thrust = format!(
        "C_T/sigma {:.5}, induced inflow {:.5}, {} iterations",
        t.ct_sigma, t.induced_inflow, t.iterations
    );
    let mut lines = vec![("Trim", trim), ("", thrust)];
    lines.extend(figures.wake.and_then(wake_note).map(|note| ("Wake", note.to_owned())));
    let loads = figures.mean_loads.as_ref().map(MeanLoads::text);
    lines.extend(loads.into_iter().flat_map(|[hub, shaft]| [("Mean", hub), ("", shaft)]));
    lines.extend(vibration_text(figures).map(|text| ("Vibration", text)));
    lines.push(("Residuals", residuals_text(&figures.residuals)));
    let of = if figures.each_unlike_blade.is_empty() { "" } else { "each like blade " };
    lines.extend(figures.stability.text().map(|text| ("Stability", format!("{of}{text}"))));
    let unlike = figures.each_unlike_blade.iter().filter_map(|line| {
        Some(("", format!("blade {}, dissimilar, {}", line.blade, line.stability.text()?)))
    });
    lines.extend(unlike);
    lines
}

/// The vibration without control in g, and what it is worth.
pub(crate) fn vibration_text(figures: &Figures) -> Option<String> {
    let [fx, fy, fz] = figures.vibration_g?;
    let worth = match figures.wake {
        Some(_) => "",
        None => "; without a free wake no vibration level, which --inflow free gives",
    };
    Some(format!(
        "FX {fx:.4}, FY {fy:.4}, FZ {fz:.4} g at the blade number per rev: hub force over lift{worth}"
    ))
}

/// What a free wake that is not converged means for the numbers shown.
pub(crate) fn wake_note(wake: WakeStatus) -> Option<&'static str> {
    match wake {
        WakeStatus::Converged => None,
        WakeStatus::NotConverged => {
            Some("NOT CONVERGED: the state with the least change; see the warning")
        }
        WakeStatus::Diverged => {
            Some("DIVERGED: no solution, nothing is controlled; see the warning")
        }
    }
}
