//! All that can be hidden: its name, its class, its sizes.

/// A single thing that is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the ids of the table say the same")]
pub enum Effect {
    Creep,
    RateDependence,
    ElectricalLag,
    CurrentLimit,
    VoltageSaturation,
    Resonance,
    TransportDelay,
    Backlash,
    Friction,
    Heating,
    LoadStiffness,
    Depolarisation,
    SensorFilter,
    SensorNonlinearity,
    MainsHum,
    AmplifierGain,
    AmplifierZero,
    SensorGain,
    SensorZero,
    SensorZeroDrift,
    SensorGainDrift,
    MonitorGain,
    MonitorZero,
    MonitorBoth,
    SpringAlways,
    LoadOneSided,
    EndStop,
    HumWithCommand,
    CreepOnce,
    ForeignReference,
    SmallReference,
    SensorCubic,
    AmplifierSecondOrder,
    AmplifierDelay,
}

/// What the size of an effect means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sizes {
    /// Rms of the effect over rms of the output; the strength is searched in a range.
    Share {
        /// Range of the strength, in the unit of its parameter.
        strength: (f64, f64),
    },
    /// A quantity of its own; the first is the usual one.
    Own {
        /// The sizes that seeds choose from.
        choices: [f64; 3],
        /// Unit.
        unit: &'static str,
    },
    /// There is no size.
    None,
}

/// An entry of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// The effect.
    pub effect: Effect,
    /// Its name.
    pub id: &'static str,
    /// The class of causes it belongs to, by the names of a diagnosis; none where no class is right.
    pub class: Option<&'static str>,
    /// The name of a diagnosis that says exactly this; none where no name is right.
    pub truth: Option<&'static str>,
    /// Its sizes.
    pub sizes: Sizes,
}

/// The effects that are causes of a usual library come first.
pub const LIBRARY: usize = 15;

const fn share(
    effect: Effect,
    id: &'static str,
    class: &'static str,
    strength: (f64, f64),
) -> Entry {
    Entry { effect, id, class: Some(class), truth: Some(id), sizes: Sizes::Share { strength } }
}

const fn own(
    effect: Effect,
    id: &'static str,
    names: [Option<&'static str>; 2],
    choices: [f64; 3],
    unit: &'static str,
) -> Entry {
    let [class, truth] = names;
    Entry { effect, id, class, truth, sizes: Sizes::Own { choices, unit } }
}

const GAIN: Option<&str> = Some("static-gain");
const BEFORE: &str = "lag-before-terminals";
const BEHIND: &str = "lag-behind-terminals";
const MONITOR: [Option<&str>; 2] = [Some("monitor"), Some("monitor-calibration")];
const NOTHING: [Option<&str>; 2] = [None, None];

/// The catalogue.
#[rustfmt::skip]
pub const CATALOGUE: [Entry; 34] = [
    share(Effect::Creep, "creep", "slow-drift", (5e-4, 0.3)),
    share(Effect::RateDependence, "rate-dependence", BEHIND, (1e-5, 2e-2)),
    share(Effect::ElectricalLag, "electrical-lag", BEFORE, (1e-5, 2e-2)),
    share(Effect::CurrentLimit, "amplifier-current-limit", "slew", (2e-5, 1e-2)),
    share(Effect::VoltageSaturation, "voltage-saturation", "clip", (0.3, 80.0)),
    share(Effect::Resonance, "mechanical-resonance", "resonance", (1.0 / 640_000.0, 1.0 / 4900.0)),
    share(Effect::TransportDelay, "transport-delay", BEHIND, (1e-5, 1e-2)),
    share(Effect::Backlash, "backlash", "lost-motion", (0.05, 120.0)),
    share(Effect::Friction, "coulomb-friction", "lost-motion", (0.05, 120.0)),
    share(Effect::Heating, "dielectric-heating", "slow-drift", (1e-3, 1.0)),
    share(Effect::LoadStiffness, "load-stiffness", "static-gain", (1e-3, 1.0)),
    share(Effect::Depolarisation, "depolarisation", "loss-of-polarisation", (1e-3, 0.9)),
    share(Effect::SensorFilter, "sensor-filter", BEHIND, (1e-5, 1e-2)),
    share(Effect::SensorNonlinearity, "sensor-nonlinearity", "static-gain", (0.05, 120.0)),
    share(Effect::MainsHum, "mains-hum", "line", (0.05, 80.0)),
    own(Effect::AmplifierGain, "amplifier-gain", [GAIN, Some("amplifier-gain")], [-0.03, -0.06, 0.03], "1"),
    own(Effect::AmplifierZero, "amplifier-zero", [Some("zero"), Some("amplifier-gain")], [2.0, -2.0, 4.0], "V"),
    own(Effect::SensorGain, "sensor-gain", [GAIN, Some("sensor-gain")], [-0.03, -0.06, 0.03], "1"),
    own(Effect::SensorZero, "sensor-zero", [Some("zero"), Some("sensor-zero")], [1.0, -2.0, 4.0], "um"),
    own(Effect::SensorZeroDrift, "sensor-zero-drift", NOTHING, [2.0, 4.0, -3.0], "um"),
    own(Effect::SensorGainDrift, "sensor-gain-drift", NOTHING, [-0.04, 0.04, -0.06], "1"),
    own(Effect::MonitorGain, "monitor-gain", MONITOR, [0.007, -0.007, 0.02], "1"),
    own(Effect::MonitorZero, "monitor-zero", MONITOR, [0.5, -0.5, 1.0], "V"),
    own(Effect::MonitorBoth, "monitor-both", NOTHING, [0.007, -0.007, 0.02], "1"),
    own(Effect::SpringAlways, "spring-always", [GAIN, Some("sensor-gain")], [-0.03, -0.06, 0.03], "1"),
    own(Effect::LoadOneSided, "load-one-sided", NOTHING, [0.06, 0.1, 0.15], "1"),
    own(Effect::EndStop, "end-stop", NOTHING, [20.0, 40.0, 60.0], "um"),
    own(Effect::HumWithCommand, "hum-with-command", NOTHING, [3.0, 6.0, 10.0], "um"),
    own(Effect::CreepOnce, "creep-once", NOTHING, [6.0, 12.0, -9.0], "um"),
    Entry { effect: Effect::ForeignReference, id: "foreign-reference", class: None, truth: None, sizes: Sizes::None },
    Entry { effect: Effect::SmallReference, id: "small-reference", class: None, truth: None, sizes: Sizes::None },
    own(Effect::SensorCubic, "sensor-cubic", [GAIN, Some("sensor-nonlinearity")], [3.0, 6.0, -4.0], "um"),
    own(Effect::AmplifierSecondOrder, "amplifier-second-order", [Some(BEFORE), None], [150.0, 200.0, 120.0], "Hz"),
    own(Effect::AmplifierDelay, "amplifier-delay", [Some(BEFORE), None], [8e-4, 5e-4, 1.2e-3], "s"),
];

/// Pairs of unlike kind.
pub const PAIRS: [[Effect; 2]; 4] = [
    [Effect::AmplifierGain, Effect::TransportDelay],
    [Effect::SensorGain, Effect::MainsHum],
    [Effect::SensorZero, Effect::Creep],
    [Effect::ElectricalLag, Effect::SensorGain],
];

/// The class of a right name.
pub fn class_of(name: &str) -> Option<&'static str> {
    CATALOGUE.iter().find(|entry| entry.truth == Some(name)).and_then(|entry| entry.class)
}

impl Entry {
    /// All classes that are right: its own, that of its right name, and for a lag on one side of the terminals a lag
    /// on either.
    pub fn classes(&self) -> Vec<&'static str> {
        let is_lag = [Some(BEFORE), Some(BEHIND)].contains(&self.class);
        let lag = is_lag.then_some("lag");
        let mut all: Vec<&str> =
            [self.class, self.truth.and_then(class_of), lag].into_iter().flatten().collect();
        all.dedup();
        all
    }
}

impl Effect {
    /// Its entry.
    pub fn entry(self) -> &'static Entry {
        &CATALOGUE[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_stand_in_the_order_of_the_effects() {
        for (i, entry) in CATALOGUE.iter().enumerate() {
            assert_eq!(entry.effect as usize, i, "{}", entry.id);
            assert_eq!(i < LIBRARY, matches!(entry.sizes, Sizes::Share { .. }), "{}", entry.id);
        }
    }
}
