//! What a controller loses that ignores the lag of its actuator, and how feedback gets it back.
//!
//! Two flaps at 3/rev on a linear plant with the lag of the paper's actuator there, 41 deg.
//!
//! ```text
//! cargo run -p hhc-control --example ignored_lag
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use hhc_control::{
    ControlError, ControlLayout, FeedbackController, FeedbackSettings, LinearPlant, LoadWeights,
    Plant, TMatrix, identify_t, lag_loss, reduction_percent,
};

/// Lag of the flap at 2, 3 and 4/rev in the paper, degrees of the harmonic.
const LAG_DEG: [(u32, f64); 3] = [(2, 47.0), (3, 41.0), (4, 36.0)];

/// Load harmonics per volt of the cosine and sine voltage of two flaps, without lag.
const COLUMNS: [[f64; 6]; 4] = [
    [0.9, 0.1, -0.2, 0.3, 0.1, 0.0],
    [-0.1, 0.8, 0.2, 0.1, 0.4, -0.3],
    [0.2, -0.3, 0.7, 0.2, 0.0, 0.1],
    [0.1, 0.2, -0.1, 0.6, -0.2, 0.5],
];

/// T of actuators that turn every voltage harmonic by a lag.
fn sensitivity(lag_rad: f64) -> Result<TMatrix, ControlError> {
    let (sin, cos) = lag_rad.sin_cos();
    let mix = |a: f64, x: &[f64; 6], b: f64, y: &[f64; 6]| -> Vec<f64> {
        x.iter().zip(y).map(|(x, y)| a * x + b * y).collect()
    };
    let columns: Vec<Vec<f64>> = COLUMNS
        .chunks_exact(2)
        .flat_map(|pair| [mix(cos, &pair[0], sin, &pair[1]), mix(-sin, &pair[0], cos, &pair[1])])
        .collect();
    TMatrix::from_columns(&columns)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let baseline = vec![3.0, 1.0, -2.0, 0.5, 1.5, -1.0];
    println!("                   reduction of J, %");
    println!("n/rev  lag, deg   ideal  ignored  fed back  steps  lost, %  4 sin^2(lag/2), %");
    for (harmonic, lag_deg) in LAG_DEG {
        let plant = |lag_deg: f64| -> Result<LinearPlant, ControlError> {
            let layout = ControlLayout::new(2, vec![harmonic])?;
            LinearPlant::new(layout, baseline.clone(), sensitivity(lag_deg.to_radians())?)
        };
        let (mut ideal, mut real) = (plant(0.0)?, plant(lag_deg)?);
        let weights = LoadWeights::Identity;
        let t0 = identify_t(&mut ideal, &[0.1; 4])?;
        let controller = FeedbackController::new(&t0, &weights, FeedbackSettings::default())?;
        let optimum = controller.run(&mut ideal, 0.0)?;
        let volt = &optimum.last().control_volt;

        let square = |loads: &[f64]| loads.iter().map(|z| z * z).sum::<f64>();
        let ignored = reduction_percent(square(&baseline), square(&real.measure(volt)?.outputs));
        let fed_back = controller.run(&mut real, 0.0)?;
        let lost = lag_loss(&sensitivity(0.0)?, &weights, volt, &[lag_deg.to_radians(); 2])?;
        println!(
            "{harmonic:5} {lag_deg:9} {:7.1} {ignored:8.1} {:9.1} {:6} {:8.1} {:18.1}",
            optimum.reduction_percent(),
            fed_back.reduction_percent(),
            fed_back.steps.len(),
            100.0 * lost.part,
            100.0 * lost.isotropic,
        );
    }
    Ok(())
}
