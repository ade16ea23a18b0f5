//! What the wake of a hovering rotor is compared by.

use rotor_wake::FreeWake;

/// Mean radius and mean height of the tip vortex over the azimuth at each age step: what a hovering
/// wake is compared with. `[radius, height]`, unit `R`.
pub fn contraction_drift(wake: &FreeWake) -> Vec<[f64; 2]> {
    let azimuths = wake.settings().azimuths as f64;
    let Some(tip) = wake.vortices().pop() else { return Vec::new() };
    (0..=wake.settings().far_steps())
        .map(|k| {
            let (mut radius, mut height) = (0.0, 0.0);
            for points in &tip.points {
                let [x, y, z] = points[k];
                radius += x.hypot(y);
                height += z;
            }
            [radius / azimuths, height / azimuths]
        })
        .collect()
}
