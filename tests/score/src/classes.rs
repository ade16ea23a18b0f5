//! Which causes the data of a design cannot tell apart, whatever program looks at them.
//!
//! | class | where |
//! |---|---|
//! | backlash, coulomb-friction | everywhere: one sensor behind the lever |
//! | electrical-lag, sensor-filter, transport-delay, rate-dependence | nothing above 35 Hz and no `amplifier_V`: their sensitivities have cosines of 0.98 and more |
//! | electrical-lag, sensor-filter | up to 181 Hz without `amplifier_V`: cosine 0.97 |
//!
//! A confident name is right if it is in the class of the truth; the exact name is counted beside it.

const FRICTION: [&str; 2] = ["backlash", "coulomb-friction"];
const SLOW_LAGS: [&str; 4] =
    ["electrical-lag", "sensor-filter", "transport-delay", "rate-dependence"];
const LAGS: [&str; 2] = ["electrical-lag", "sensor-filter"];

/// Whether `name` is the true cause or in one class with it.
///
/// `wide` says whether the design reaches 181 Hz, `monitored` whether `amplifier_V` is recorded.
pub fn same_class(truth: &str, name: &str, wide: bool, monitored: bool) -> bool {
    let both_in = |class: &[&str]| class.contains(&truth) && class.contains(&name);
    let lags = match (monitored, wide) {
        (true, _) => false,
        (false, true) => both_in(&LAGS),
        (false, false) => both_in(&SLOW_LAGS),
    };
    truth == name || both_in(&FRICTION) || lags
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_shrink_with_what_is_measured() {
        let lag_or =
            |name: &str, wide, monitored| same_class("electrical-lag", name, wide, monitored);
        assert!(lag_or("transport-delay", false, false) && !lag_or("transport-delay", true, false));
        assert!(lag_or("sensor-filter", true, false) && !lag_or("sensor-filter", true, true));
        assert!(lag_or("electrical-lag", true, true));
        assert!(same_class("backlash", "coulomb-friction", true, true));
        assert!(!same_class("creep", "dielectric-heating", false, false));
    }
}
