//! The actuator on data: the model that cross-validation picks, measured reversal curves, a measured
//! friction damper, the inverse.

use std::sync::LazyLock;

use bench_study::curves::identify_curves;
use bench_study::identification::{Comparing, identify_bench, identify_loops};
use preisach_dyn::InverseSettings;
use preisach_dyn::identify::{Family, ModelComparison, RecordFit, RecordUse, Settings};
use rotor_base::{Harmonic, HarmonicSeries};
use sim_driver::files::{DataSet, Folder, SHIPPED_BENCH, read_bench, read_dataset, shipped};
use sim_driver::import::{ColumnOptions, ImportRequest, MOST_SAMPLES, import};

use crate::actuator::{BENCH, identified};
use validation::{Check, Failure, root, row, shared, too_few, worst};

const FORC: &str = "152 measured curves, fixtures/measured/forc";
const PIEZO: &str = "measured piezo stage, fixtures/measured/piezo_stage";
const DAMPER: &str = "measured friction damper, fixtures/measured/friction_damper";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-ACT-30",
        "model picked by cross-validation, 0.2 Hz loop and reversal curves: largest \
         NRMSE",
        "%",
    )
    .against(BENCH)
    .at_most(1.5, || picked(3, |id, _| id.contains("0p2hz") || id.starts_with("forc"), nrmse)),
    row("V-ACT-31", "model picked by cross-validation, held out, 15 and 20 Hz: largest NRMSE", "%")
        .against(BENCH)
        .at_most(8.0, || picked(6, |id, _| is_fast(id), nrmse)),
    row(
        "V-ACT-32",
        "model picked by cross-validation, held out, 15 and 20 Hz: largest phase \
         error",
        "deg",
    )
    .against(BENCH)
    .at_most(2.0, || {
        picked(6, |id, _| is_fast(id), |fit| fit.phase_error_deg.map_or(f64::NAN, f64::abs))
    }),
    row("V-ACT-37", "model picked by cross-validation, trained runs: largest NRMSE", "%")
        .against(BENCH)
        .at_most(4.0, || picked(3, |_, side| side == RecordUse::Train, nrmse)),
    row(
        "V-ACT-38",
        "model picked by cross-validation, held out, middle amplitude and mix of 2, \
         3 and 4/rev: largest NRMSE",
        "%",
    )
    .against(BENCH)
    .at_most(10.0, || picked(3, |id, side| side == RecordUse::HeldOut && is_middle(id), nrmse)),
    row("V-ACT-33", "reversal curves, every fourth held out: worst curve, of the range", "%")
        .against(FORC)
        .at_most(2.0, held_out_curves),
    row(
        "V-ACT-34",
        "identified dynamic model, inverse then forward, 2, 3 and 4/rev: largest \
         error, of the amplitude",
        "%",
    )
    .against("definition")
    .at_most(0.5, inverse),
    row(
        "V-ACT-35",
        "friction damper, trained at 0.25 Hz, stops, 0.5 and 1 Hz held out: rms \
         NRMSE",
        "%",
    )
    .against(DAMPER)
    .at_most(50.0, || damper(Family::PrandtlStop)),
    row("V-ACT-36", "the same, static Preisach: rising plays cannot lead", "%")
        .against(DAMPER)
        .at_least(80.0, || damper(Family::StaticPreisach)),
    row(
        "V-ACT-39",
        "piezo stage, trained on one loop of 1 Hz, inner loops, fade and hold: NRMSE",
        "%",
    )
    .against(PIEZO)
    .at_most(9.0, piezo_stage),
];

/// The table of some families on a data set, made once for all checks.
type Tabled = LazyLock<Result<ModelComparison, Failure>>;

static SHIPPED: Tabled = LazyLock::new(|| {
    let data = read_bench(&shipped(SHIPPED_BENCH))?;
    let found = identify_bench(&data, &Settings::default(), Some(Comparing::all(&|| ())))?;
    Ok(found.comparison.unwrap_or_else(|| unreachable!("just compared")))
});

fn table(of: &'static Tabled) -> Result<&'static ModelComparison, Failure> {
    shared(of)
}

fn nrmse(fit: &RecordFit) -> f64 {
    fit.nrmse_percent()
}

fn is_fast(id: &str) -> bool {
    id.contains("15hz") || id.contains("20hz")
}

fn is_middle(id: &str) -> bool {
    id.ends_with("55v") || id.starts_with("mix")
}

/// The largest figure of the picked model over some of the records.
fn picked(
    needed: usize,
    wanted: fn(&str, RecordUse) -> bool,
    figure: fn(&RecordFit) -> f64,
) -> Result<f64, Failure> {
    let table = table(&SHIPPED)?;
    let missing = too_few("fitted models", 0, 1);
    let fitted = table.best().and_then(|row| row.fitted.as_ref().ok()).ok_or(missing)?;
    let chosen = table.records.iter().zip(&fitted.fits).filter(|((id, side), _)| wanted(id, *side));
    worst("records", needed, chosen.map(|(_, fit)| Ok(figure(fit))))
}

static LOOPS: Tabled = LazyLock::new(|| {
    let folder = root().join("fixtures/measured/friction_damper");
    let DataSet::Loops(data) = read_dataset(&Folder::Disk(folder))? else {
        unreachable!("a data set of loops")
    };
    let found = identify_loops(&data, &Settings::default(), Some(Comparing::all(&|| ())))?;
    Ok(found.comparison.unwrap_or_else(|| unreachable!("just compared")))
});

fn damper(family: Family) -> Result<f64, Failure> {
    let table = table(&LOOPS)?;
    let row = table.rows.iter().find(|row| row.family == family);
    let error = row.and_then(|row| table.error_over(row, RecordUse::HeldOut));
    Ok(error.map_or(f64::NAN, |(rms, _)| 100.0 * rms))
}

/// Trained on the open loop alone: the record driven through an inverse.
fn piezo_stage() -> Result<f64, Failure> {
    let data = read_bench(&Folder::Disk(root().join("fixtures/measured/piezo_stage")))?;
    let found = identify_bench(&data, &Settings::default(), None)?;
    let records = &found.identification.records;
    let held_out = records.iter().find(|record| record.record_use == RecordUse::HeldOut);
    Ok(held_out.map_or(f64::NAN, |record| record.dynamic.nrmse_percent()))
}

/// The measured file imported as `hhc import` does, then identified.
fn held_out_curves() -> Result<f64, Failure> {
    let place = tempfile::tempdir()?;
    let out = place.path().join("forc");
    let request = ImportRequest {
        files: vec![root().join("fixtures/measured/forc/hchb_forc")],
        out: out.clone(),
        source: None,
        kind: None,
        columns: ColumnOptions::default(),
        variable: None,
        range: None,
        sampling_hz: None,
        deg_per_um: None,
        split: false,
        reduce_to_hz: None,
        most_samples: MOST_SAMPLES,
        title: None,
    };
    import(&request)?;
    let DataSet::Curves(curves) = read_dataset(&Folder::Disk(out))? else {
        return Ok(f64::NAN);
    };
    Ok(identify_curves(&curves)?.summary(None).held_out_worst_percent)
}

fn inverse() -> Result<f64, Failure> {
    let model = &identified()?.dynamic;
    let settings = InverseSettings::default();
    let mut wanted = HarmonicSeries::zero(4);
    for (n, cosine, sine) in [(2, 1.0, 0.0), (3, 0.4, 0.8), (4, -0.4, 0.4)] {
        wanted.set_harmonic(n, Harmonic { cosine, sine });
    }
    let rev_hz = 5.0;
    let found = model.periodic_inverse(&wanted, rev_hz, &settings)?;
    let again =
        model.periodic_response(&found.response.voltage_volt, rev_hz, &settings.periodic)?;
    let steps = again.samples_deg.len() as f64;
    let errors = again
        .samples_deg
        .iter()
        .enumerate()
        .map(|(i, y)| (y - wanted.value(std::f64::consts::TAU * i as f64 / steps)).abs());
    Ok(100.0 * errors.fold(0.0, f64::max) / found.amplitude_deg)
}
