//! Names: the causes of the library, the effects outside it, the pairs.

use crate::error::TruthError;

/// A cause that the product's library holds, here with richer physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names are the meaning; EXPERIMENTS.md has the parameters")]
pub enum Cause {
    Creep,
    RateDependence,
    ElectricalLag,
    AmplifierCurrentLimit,
    VoltageSaturation,
    MechanicalResonance,
    TransportDelay,
    Backlash,
    CoulombFriction,
    DielectricHeating,
    LoadStiffness,
    Depolarisation,
    SensorFilter,
    SensorNonlinearity,
    MainsHum,
}

impl Cause {
    /// All of them, in the order of the library.
    pub const ALL: [Self; 15] = [
        Self::Creep,
        Self::RateDependence,
        Self::ElectricalLag,
        Self::AmplifierCurrentLimit,
        Self::VoltageSaturation,
        Self::MechanicalResonance,
        Self::TransportDelay,
        Self::Backlash,
        Self::CoulombFriction,
        Self::DielectricHeating,
        Self::LoadStiffness,
        Self::Depolarisation,
        Self::SensorFilter,
        Self::SensorNonlinearity,
        Self::MainsHum,
    ];

    /// The id in files.
    pub fn id(self) -> &'static str {
        match self {
            Self::Creep => "creep",
            Self::RateDependence => "rate-dependence",
            Self::ElectricalLag => "electrical-lag",
            Self::AmplifierCurrentLimit => "amplifier-current-limit",
            Self::VoltageSaturation => "voltage-saturation",
            Self::MechanicalResonance => "mechanical-resonance",
            Self::TransportDelay => "transport-delay",
            Self::Backlash => "backlash",
            Self::CoulombFriction => "coulomb-friction",
            Self::DielectricHeating => "dielectric-heating",
            Self::LoadStiffness => "load-stiffness",
            Self::Depolarisation => "depolarisation",
            Self::SensorFilter => "sensor-filter",
            Self::SensorNonlinearity => "sensor-nonlinearity",
            Self::MainsHum => "mains-hum",
        }
    }
}

/// An effect that the product's library does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outside {
    /// A force proportional to the square of the speed, against it.
    QuadraticViscous,
    /// The output jumps at random times and stays.
    RandomJumps,
    /// A spring whose force grows with the cube of the displacement, on a base that yields.
    CubicSpring,
    /// The sensor holds its last value now and then.
    IntermittentDropout,
    /// A delay that swells and ebbs.
    TimeVaryingDelay,
    /// A mode inside the band that takes a small part of the motion.
    SecondMode,
}

impl Outside {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::QuadraticViscous,
        Self::RandomJumps,
        Self::CubicSpring,
        Self::IntermittentDropout,
        Self::TimeVaryingDelay,
        Self::SecondMode,
    ];

    /// The id in files.
    pub fn id(self) -> &'static str {
        match self {
            Self::QuadraticViscous => "outside-quadratic-viscous",
            Self::RandomJumps => "outside-random-jumps",
            Self::CubicSpring => "outside-cubic-spring",
            Self::IntermittentDropout => "outside-intermittent-dropout",
            Self::TimeVaryingDelay => "outside-time-varying-delay",
            Self::SecondMode => "outside-second-mode",
        }
    }
}

/// What is hidden in a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hidden {
    /// Nothing.
    Null,
    /// One cause of the library.
    One(Cause),
    /// Two causes of the library.
    Two(Cause, Cause),
    /// An effect outside the library.
    Other(Outside),
}

/// The pairs of the suite.
pub const PAIRS: [(Cause, Cause); 10] = [
    (Cause::Creep, Cause::TransportDelay),
    (Cause::Creep, Cause::VoltageSaturation),
    (Cause::ElectricalLag, Cause::MainsHum),
    (Cause::VoltageSaturation, Cause::MainsHum),
    (Cause::AmplifierCurrentLimit, Cause::Creep),
    (Cause::MechanicalResonance, Cause::Creep),
    (Cause::RateDependence, Cause::SensorNonlinearity),
    (Cause::LoadStiffness, Cause::MainsHum),
    (Cause::SensorFilter, Cause::VoltageSaturation),
    (Cause::TransportDelay, Cause::SensorNonlinearity),
];

impl Hidden {
    /// The id in files: `null`, a cause, `cause+cause`, or `outside-...`.
    pub fn id(self) -> String {
        match self {
            Self::Null => "null".to_owned(),
            Self::One(cause) => cause.id().to_owned(),
            Self::Two(a, b) => format!("{}+{}", a.id(), b.id()),
            Self::Other(effect) => effect.id().to_owned(),
        }
    }

    /// What an id means.
    ///
    /// # Errors
    /// [`TruthError::UnknownName`] with all that are known.
    pub fn parse(id: &str) -> Result<Self, TruthError> {
        let cause = |id: &str| Cause::ALL.into_iter().find(|cause| cause.id() == id);
        let found = match id.split_once('+') {
            _ if id == "null" => Some(Self::Null),
            Some((a, b)) => cause(a).zip(cause(b)).map(|(a, b)| Self::Two(a, b)),
            None => cause(id).map(Self::One).or_else(|| {
                Outside::ALL.into_iter().find(|effect| effect.id() == id).map(Self::Other)
            }),
        };
        found.ok_or_else(|| {
            let known = Cause::ALL.map(Cause::id).into_iter().chain(Outside::ALL.map(Outside::id));
            let known = known.collect::<Vec<_>>().join(", ");
            TruthError::UnknownName {
                what: "effect",
                found: id.to_owned(),
                known: format!("null, {known}, or two causes joined by +"),
            }
        })
    }

    /// The causes of the library in it.
    pub fn causes(self) -> Vec<Cause> {
        match self {
            Self::Null | Self::Other(_) => Vec::new(),
            Self::One(cause) => vec![cause],
            Self::Two(a, b) => vec![a, b],
        }
    }
}
