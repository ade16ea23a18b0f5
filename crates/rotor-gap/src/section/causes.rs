//! What the simulation of a section may lack.

use super::SectionModel;
use flap_aero::{AttachedFlowModel, Mach, StallAirfoil};
use model_gap::points::{CauseParameter, PointCause, Shown};

/// A cause, ready for one section.
pub type SectionCause = PointCause<SectionModel>;

/// Names of the causes of a section.
pub const SECTION_LIBRARY: [&str; 8] = [
    "flap-effectiveness",
    "compressibility",
    "unsteady-lag",
    "timing",
    "sensor-gain",
    "dynamic-stall",
    "pivot-compliance",
    "pitch-axis",
];

/// What the library is made for.
pub(super) struct Occasion<'a> {
    pub(super) model: &'a SectionModel,
    /// Whether a flap moves.
    pub(super) has_flap: bool,
    /// Whether every frequency was stated.
    pub(super) has_frequency: bool,
    /// Whether there are two reduced frequencies at least.
    pub(super) has_frequencies: bool,
    /// Largest incidence of a motion with an amplitude, deg, and its Mach number.
    pub(super) highest: (f64, f64),
    /// Names of the instruments: of the loads, then of the pitch where the section pitches.
    pub(super) instruments: &'a [String],
}

/// Incidence below which no section is near stall, deg.
const NEAR_STALL_DEG: f64 = 6.0;
/// How far beyond the stall it is computed, deg: its effect is far from straight.
const DEPTHS_DEG: [f64; 12] = [2.0, 0.5, 1.0, 3.0, 4.0, 5.0, 6.0, 7.5, 9.0, 11.0, 13.0, 16.0];
/// Earliest stall, deg.
const EARLIEST_DEG: f64 = 4.0;
/// What loops that the constants were fitted to keep of a part of what stall changes.
const STALL_FORM: f64 = 0.25;

fn share(amounts: &[f64]) -> CauseParameter {
    CauseParameter {
        name: "share",
        unit: "1",
        none: 0.0,
        range: (0.0, 2.0),
        amounts: amounts.to_vec(),
        shown: Shown::Itself,
    }
}

/// The causes of a section.
pub(super) fn library(o: &Occasion<'_>) -> Vec<SectionCause> {
    let mut all = vec![flap_effectiveness(o), compressibility(o), unsteady_lag(o), timing(o)];
    all.extend(o.instruments.iter().map(|name| sensor_gain(name)));
    all.extend([dynamic_stall(o), pivot_compliance(o), pitch_axis(o)]);
    all
}

fn flap_effectiveness(o: &Occasion<'_>) -> SectionCause {
    let physics = "the flap makes less or more than thin-aerofoil theory says: lift, moment and hinge moment each times a ratio";
    let ratio = |name| CauseParameter::ratio(&[0.95, 0.7], (0.0, 2.0)).named(name);
    let mut parameters = vec![ratio("lift"), ratio("moment")];
    if o.model.has_hinge {
        parameters.push(ratio("hinge"));
    }
    PointCause::new("flap-effectiveness", physics, parameters, |m: &mut SectionModel, v| {
        for (own, value) in m.effectiveness.iter_mut().zip(v) {
            *own *= value;
        }
    })
    .beside(
        &["sensor-gain"],
        &["the moment beside the lift", "pitch of the section on the same sensors"],
    )
    .blocked_if(!o.has_flap, "no flap moves")
}

fn compressibility(o: &Occasion<'_>) -> SectionCause {
    let physics = "the air is compressible: the Mach number of the sections times a share";
    PointCause::new(
        "compressibility",
        physics,
        vec![share(&[0.3, 1.0])],
        |m: &mut SectionModel, v| {
            m.mach_share += v[0];
        },
    )
    .beside(&["sensor-gain"], &["points at other Mach numbers"])
    .blocked_if(o.model.mach_share > 0.0, "the sections of the case are compressible already")
    .blocked_if(
        o.model.attached == AttachedFlowModel::Incompressible,
        "`model: Incompressible` has no Mach number; `Calibrated` with `compressibility: None` is the same flow and has",
    )
}

fn unsteady_lag(o: &Occasion<'_>) -> SectionCause {
    let physics = "the loads lag the motion more or less, by a wake or an apparent mass other than in theory: each times a ratio";
    let (lag, mass) = (o.model.lag_share, o.model.mass_share);
    let share = |name, none: f64| CauseParameter {
        name,
        unit: "1",
        none,
        range: (-0.5, 4.0),
        amounts: vec![none + 0.2, none - 0.2, none + 1.0],
        shown: Shown::Itself,
    };
    // at one reduced frequency the two are one
    let mut parameters = vec![share("ratio", lag)];
    parameters.extend(o.has_frequencies.then(|| share("apparent_mass", mass)));
    PointCause::new("unsteady-lag", physics, parameters, move |m: &mut SectionModel, v| {
        m.lag_share += v[0] - lag;
        m.mass_share += v.get(1).map_or(v[0] - lag, |own| own - mass);
    })
    .beside(&["timing", "pivot-compliance"], &["points at other reduced frequencies"])
}

fn timing(o: &Occasion<'_>) -> SectionCause {
    let physics = "the loads were sampled late against the motion, all by the same time";
    let delay = CauseParameter::both_ways("s", "s", &[0.0005, 0.002], 0.05);
    PointCause::new("timing", physics, vec![delay], |m: &mut SectionModel, v| m.delay_s += v[0])
        .beside(
            &["unsteady-lag", "pivot-compliance"],
            &["points at other frequencies", "a static load"],
        )
        .exact_to(0.005)
        .blocked_if(!o.has_frequency, "no `frequency_hz` was stated: a time is no phase")
}

fn sensor_gain(instrument: &str) -> SectionCause {
    let physics = model_gap::points::lasting(&format!(
        "the instrument {instrument} reads all of its channels times a ratio"
    ));
    let name = instrument.to_owned();
    let ratio = CauseParameter::ratio(&[0.95], (-3.0, 3.0));
    PointCause::new("sensor-gain", physics, vec![ratio], move |m: &mut SectionModel, v| {
        m.gains.entry(name.clone()).and_modify(|own| *own *= v[0]).or_insert(v[0]);
    })
    .beside(&["flap-effectiveness"], &["a static load on the same sensors"])
    .exact_to(0.005)
}

fn dynamic_stall(o: &Occasion<'_>) -> SectionCause {
    let physics = "the flow separates and a vortex leaves the leading edge, from an incidence on";
    let (highest_deg, mach) = o.highest;
    let mach = Mach::new(mach * o.model.mach_share).unwrap_or(Mach::ZERO);
    let stated_deg = STALL.parameters(mach).alpha1_rad.to_degrees();
    // how far the motion that goes furthest goes beyond the stall
    let deepest = (highest_deg - EARLIEST_DEG).max(1.0);
    let onset = CauseParameter {
        name: "onset_deg",
        unit: "deg",
        none: 0.0,
        range: (0.0, deepest),
        amounts: DEPTHS_DEG.into_iter().filter(|own| *own < deepest).collect(),
        shown: Shown::Beside(vec![(0.0, highest_deg), (deepest, highest_deg - deepest)]),
    };
    PointCause::new("dynamic-stall", physics, vec![onset], move |m: &mut SectionModel, v| {
        let later_deg = highest_deg - v[0] - stated_deg;
        m.stalls_later_rad = (v[0] > 0.0).then_some(later_deg.to_radians());
    })
    .beside(&["unsteady-lag"], &["a smaller mean incidence", "a smaller amplitude"])
    .exact_to(STALL_FORM)
    .blocked_if(
        highest_deg < NEAR_STALL_DEG,
        "no motion with an amplitude comes to 6 deg of incidence",
    )
    .blocked_if(o.model.stall.is_some(), "the sections of the case stall already")
}

fn pivot_compliance(o: &Occasion<'_>) -> SectionCause {
    let physics = "the axis gives way: the section plunges with the normal force";
    let give = CauseParameter {
        name: "semichords_per_cn",
        unit: "1",
        none: 0.0,
        range: (0.0, 2.0),
        amounts: vec![0.1, 0.3],
        shown: Shown::Itself,
    };
    PointCause::new("pivot-compliance", physics, vec![give], |m: &mut SectionModel, v| {
        m.give += v[0];
    })
    .beside(
        &["unsteady-lag", "timing", "pitch-axis"],
        &[
            "the plunge of the axis, by an accelerometer",
            "a flap that moves while the section is held",
        ],
    )
    .blocked_if(!o.has_frequencies, "one reduced frequency shows no plunge beside a lag")
}

fn pitch_axis(o: &Occasion<'_>) -> SectionCause {
    let physics = "the section pitches about another axis than the quarter chord";
    let aft = CauseParameter::both_ways("aft_chords", "1", &[0.05, 0.2], 1.0);
    PointCause::new("pitch-axis", physics, vec![aft], |m: &mut SectionModel, v| m.axis_aft += v[0])
        .beside(
            &["pivot-compliance", "unsteady-lag"],
            &["a ruler", "points at other reduced frequencies"],
        )
        .blocked_if(o.instruments.len() < 2, "the section does not pitch")
}

/// Constants of the stall that an attached section may lack.
pub(super) const STALL: StallAirfoil = StallAirfoil::Naca0012Measured;
