//! The shipped bench through the driver: identification within its bounds, held-out runs apart.

use crate::everyday::bench;
use bench_study::identification::identify_bench;
use bench_study::stored::StoredFit;
use everyday_bench::family::Family;
use everyday_bench::hidden::Deal;
use everyday_bench::set::{Request, set};
use preisach_dyn::identify::{RecordUse, Settings};
use sim_driver::actuator::case_actuators;
use sim_driver::case::{PAPER_CASE, shipped_case};

fn is_near(fit: &StoredFit, hz: f64) -> bool {
    (fit.frequency_hz / hz - 1.0).abs() < 0.05
}

/// Trained runs at most 4 % NRMSE; 15 and 20 Hz, which the model has not seen, at most 10 % and 3 deg;
/// the middle amplitude and the mix at most 15 %. The static model alone is wrong by more than half at
/// 15 Hz, which is why there is a dynamic one.
#[test]
fn identification_meets_its_bounds() {
    let loaded = shipped_case(PAPER_CASE).unwrap();
    let actuators = case_actuators(&loaded).unwrap();
    assert!(actuators.data_title.to_lowercase().contains("synthetic"), "{}", actuators.data_title);
    assert!(actuators.warnings.is_empty(), "{:?}", actuators.warnings);
    assert_eq!(actuators.fits.len(), 19);
    for fit in &actuators.fits {
        let held_out = fit.use_as == RecordUse::HeldOut;
        let unseen_frequency = is_near(fit, 15.0) || is_near(fit, 20.0);
        if unseen_frequency {
            assert!(held_out, "{} is held out", fit.id);
            let phase = fit.phase_error_deg.unwrap().abs();
            assert!(fit.nrmse_percent <= 10.0 && phase <= 3.0, "{fit:?}");
        } else if held_out {
            assert!(fit.nrmse_percent <= 15.0, "{fit:?}");
        } else {
            assert!(fit.nrmse_percent <= 4.0, "{fit:?}");
        }
        if is_near(fit, 15.0) {
            assert!(fit.static_nrmse_percent > 50.0, "{fit:?}");
        }
    }
    let trained = actuators.fits.iter().filter(|f| f.use_as == RecordUse::Train).count();
    assert_eq!(trained, 7, "0.2 Hz runs, and the outer amplitudes at 1 and 10 Hz");
}

/// With the rotor's physical speed 4/rev lies beyond everything the bench has seen, and 2, 3/rev do not.
#[test]
fn extrapolation_is_warned_of() {
    let loaded = shipped_case("paper_mu030_6p383hz.ron").unwrap();
    let actuators = case_actuators(&loaded).unwrap();
    assert_eq!(actuators.warnings.len(), 1, "{:?}", actuators.warnings);
    let warning = &actuators.warnings[0];
    assert!(warning.contains("4/rev = 25.5 Hz is outside the tested range"), "{warning}");
    let line = loaded.index.line("actuator.bench_rev_hz").unwrap();
    assert!(warning.contains(&format!("paper_mu030_6p383hz.ron:{line}:")), "{warning}");
}

/// Its rate maps stop with a gap of 2e-7, all else met: near enough.
#[test]
fn a_program_that_stops_near_its_minimum_is_no_error() {
    let made = set(&Request::new(Family::Duhem, 17_051, Deal::Nulls));
    let found = identify_bench(&bench(&made.reference), &Settings::default(), None).unwrap();
    let trained = found.stored().runs;
    let trained = trained.iter().filter(|fit| fit.use_as == RecordUse::Train);
    let worst = trained.map(|fit| fit.nrmse_percent).fold(0.0, f64::max);
    assert!(worst < 10.0, "{worst} %");
}
