//! Trims coupled with the free wake.

use std::f64::consts::TAU;
use std::sync::{Arc, LazyLock};

use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Discretisation, ResponseError, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{
    BladeLines, CirculationMap, CoreModel, FarField, FlightState, FreeWake, FreeWakeSettings,
    WakeError, WakeRotor, momentum_inflow,
};
use trim::{
    TrimError, TrimSettings, TrimTarget, Vehicle, WakeOutcome, WakeTrim, WakeTrimSettings,
    trim_in_free_wake,
};
use validation::{Check, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-WAKE-48",
        "coupled trim of the paper's rotor, default wake, mu 0.15, 0.20, 0.25, \
         0.35: largest change of the inflow in the last update, or displacement of \
         the wake, over its tolerance",
        "-",
    )
    .against("the metrics of the coupling")
    .at_most(1.0, || {
        let changes = [0.15, 0.2, 0.25, 0.35].map(|mu| {
            let settings = WakeTrimSettings::default();
            Ok(normalised_residual(&coupled(mu, &settings)?, &settings))
        });
        worst("advance ratios", 4, changes)
    })
    .machine_dependent(),
    row(
        "V-WAKE-49",
        "wake of constant circulation, mu 0.20, after 40 sweeps: displacement where \
         vortices move each other by cores of 0.02 R, over that by mutual cores of \
         0.05 R",
        "-",
    )
    .against("what the mutual core is for: one wake wanders, the other rests")
    .between(1e4, f64::INFINITY, || Ok(last_displacement(0.0)? / last_displacement(0.05)?))
    .machine_dependent(),
    row(
        "V-WAKE-50",
        "the same at mu 0.30, where both settle: 4/rev thrust with mutual cores of \
         0.05 R against own cores, relative change",
        "-",
    )
    .against(
        "the mutual core acts between free vortices, the blades feel their own \
         cores",
    )
    .at_most(0.05, || {
        let own = coupled_at_030(|s| s.wake.core.mutual_radius = 0.0)?;
        Ok((thrust_4(&own) / thrust_4(known(&DEFAULT)?) - 1.0).abs())
    })
    .machine_dependent(),
    row(
        "V-WAKE-51",
        "the same, its far field in single precision: inflow over the disk, \
         largest difference",
        "tip speed",
    )
    .against("the same in double precision")
    .at_most(1e-8, || {
        let (single, double) = (known(&DEFAULT)?, known(&DOUBLE)?);
        let [a, b] = [single, double].map(|w| w.trim.rotor.inflow.parameters());
        Ok(a.iter().zip(&b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs())))
    })
    .machine_dependent(),
    row("V-WAKE-52", "the same: 4/rev thrust, relative difference", "-")
        .against("the same")
        .at_most(1e-6, || Ok((thrust_4(known(&DEFAULT)?) / thrust_4(known(&DOUBLE)?) - 1.0).abs()))
        .machine_dependent(),
    row(
        "V-WAKE-54",
        "the same with steps of 15 and of 7.5 deg (12 Gauss points per time \
         element) in place of 10: mean inflow, larger relative change",
        "-",
    )
    .against("converged; `cargo xtask wake-refinement` has the whole table")
    .at_most(0.01, || {
        let mean = mean_inflow(known(&DEFAULT)?)?;
        let coarse = mean_inflow(&coupled_at_030(|s| s.wake.azimuths = 24)?)?;
        Ok((coarse / mean - 1.0).abs().max((mean_inflow(known(&FINE)?)? / mean - 1.0).abs()))
    })
    .machine_dependent(),
    row(
        "V-WAKE-55",
        "the same with steps of 7.5 deg: 4/rev vertical force with its phase, \
         relative change",
        "-",
    )
    .against("the same")
    .at_most(0.05, || {
        let ([c, s], [c_fine, s_fine]) = (vertical_4(known(&DEFAULT)?), vertical_4(known(&FINE)?));
        Ok((c - c_fine).hypot(s - s_fine) / c_fine.hypot(s_fine))
    })
    .machine_dependent(),
    row(
        "V-WAKE-56",
        "the same with the near core x 0.5 and x 2: mean inflow, larger relative \
         change",
        "-",
    )
    .against(
        "the core of what passes other blades leaves the mean alone (a core wider \
         than the panels in the sheet of the own blade: -0.20)",
    )
    .at_most(0.01, || {
        let mean = mean_inflow(known(&DEFAULT)?)?;
        let thin = mean_inflow(&coupled_at_030(|s| s.wake.core.near_radius *= 0.5)?)?;
        let wide = mean_inflow(&coupled_at_030(|s| s.wake.core.near_radius *= 2.0)?)?;
        Ok((thin / mean - 1.0).abs().max((wide / mean - 1.0).abs()))
    })
    .machine_dependent(),
    row(
        "V-WAKE-53",
        "the same rotor trimmed in hover, axial wake: 4/rev thrust over the mean",
        "-",
    )
    .against("a wake that turns with its rotor shakes nothing")
    .at_most(1e-9, || {
        let wake =
            FreeWakeSettings { azimuths: 12, ..FreeWakeSettings::hover(CoreModel::Vatistas) };
        let settings = WakeTrimSettings { wake, ..Default::default() };
        let target =
            TrimTarget::WindTunnel { ct_sigma: 0.07, shaft_tilt_rad: 0.0, hub_moments: [0.0; 2] };
        let hover = trimmed(0.0, &settings, &target)?;
        Ok(thrust_4(&hover) / hover.trim.rotor.hub.mean()[2])
    })
    .machine_dependent(),
];

fn last_displacement(mutual_radius: f64) -> Result<f64, WakeError> {
    const SWEEPS: usize = 40;
    let rotor = WakeRotor::cosine(4, 0.2, 8)?;
    let mut settings = FreeWakeSettings::default();
    settings.core.mutual_radius = mutual_radius;
    let (azimuths, flight) =
        (settings.azimuths, FlightState { advance_ratio: 0.2, shaft_tilt_rad: 0.048 });
    let circulation = CirculationMap::constant(azimuths, 8, TAU * 0.0049 / 4.0)?;
    let lines = BladeLines::flat(&rotor, azimuths);
    let mut wake = FreeWake::undistorted(rotor, settings, flight, 0.012, lines)?;
    for _ in 1..SWEEPS {
        wake.sweep(&circulation)?;
    }
    wake.sweep(&circulation)
}

fn coupled(mu: f64, settings: &WakeTrimSettings) -> Result<WakeTrim, TrimError> {
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    trimmed(mu, settings, &target)
}

fn trimmed(
    mu: f64,
    settings: &WakeTrimSettings,
    target: &TrimTarget,
) -> Result<WakeTrim, TrimError> {
    trimmed_in(Discretisation::default(), mu, settings, target)
}

fn trimmed_in(
    discretisation: Discretisation,
    mu: f64,
    settings: &WakeTrimSettings,
    target: &TrimTarget,
) -> Result<WakeTrim, TrimError> {
    let blade = BladeProperties::new(BladeSpec::table_1()).map_err(ResponseError::from)?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, discretisation)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default())?;
    trim_in_free_wake(&mut solver, settings, mu, target, &TrimSettings::default())
}

fn coupled_at_030(change: fn(&mut WakeTrimSettings)) -> Result<WakeTrim, TrimError> {
    let mut settings = WakeTrimSettings::default();
    change(&mut settings);
    coupled(0.3, &settings)
}

static DEFAULT: LazyLock<Result<WakeTrim, TrimError>> = LazyLock::new(|| coupled_at_030(|_| {}));
static FINE: LazyLock<Result<WakeTrim, TrimError>> = LazyLock::new(|| {
    let mut settings = WakeTrimSettings::default();
    settings.wake.azimuths = 48;
    let finer = Discretisation { time_gauss_points: 12, ..Discretisation::default() };
    let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
    trimmed_in(finer, 0.3, &settings, &target)
});
static DOUBLE: LazyLock<Result<WakeTrim, TrimError>> =
    LazyLock::new(|| coupled_at_030(|s| s.wake.far_field = FarField::Double));

fn known(found: &'static Result<WakeTrim, TrimError>) -> Result<&'static WakeTrim, TrimError> {
    found.as_ref().map_err(Clone::clone)
}

/// What is left of the inflow or of the geometry in the last update over what may be; nothing settles without.
fn normalised_residual(wake: &WakeTrim, settings: &WakeTrimSettings) -> f64 {
    let (change, displacement) = match &wake.outcome {
        WakeOutcome::Settled => {
            wake.updates.last().map_or((f64::NAN, f64::NAN), |u| (u.inflow_change, u.displacement))
        }
        WakeOutcome::NotSettled { inflow_change, displacement, .. } => {
            (*inflow_change, *displacement)
        }
        _ => (f64::INFINITY, f64::INFINITY),
    };
    (change / settings.inflow_tolerance).max(displacement / settings.displacement_tolerance)
}

/// Mean inflow over Glauert's.
fn mean_inflow(wake: &WakeTrim) -> Result<f64, WakeError> {
    let rotor = &wake.trim.rotor;
    Ok(rotor.inflow.mean() / momentum_inflow(&wake.trim.flight, rotor.thrust_coefficient)?)
}

fn thrust_4(wake: &WakeTrim) -> f64 {
    let [c, s] = vertical_4(wake);
    c.hypot(s)
}

/// Cosine and sine part of the vertical force at 4/rev.
fn vertical_4(wake: &WakeTrim) -> [f64; 2] {
    let harmonic = wake.trim.rotor.hub.harmonic(4);
    [harmonic[4], harmonic[5]]
}
