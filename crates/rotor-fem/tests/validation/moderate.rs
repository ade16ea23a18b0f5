//! The blade with moderate deflections: statics, modes about the deflected state, free motion.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::DVector;
use rotor_fem::{
    AxialMotion, BladeSpec, CoupledMode, GyroscopicTerms, ModeCount, ModeKind, ModerateBlade,
    ModerateModel, ModerateSpec, StaticSettings, TorsionTerms, Twist, deflected_modes,
};

use crate::free_motion::{FreeMotion, MotionState};
use crate::moderate_blades::{
    EPPS_CHANDRA_RPM, PRINCETON_LENGTH_M, TM_4760_RPM, epps_chandra_strip, princeton_beam,
    tm_4760_blade,
};
use validation::{Check, Failure, Table, row, too_few, worst};

pub(crate) const ROWS: &[Check] = &[
    row("V-MOD-01", "planar dead tip load, P L^2 / EI 0.25 to 3: largest error of w", "relative")
        .against("P L^3 / 3 EI: this energy is linear in a plane")
        .at_most(1e-6, planar_load),
    row(
        "V-MOD-02",
        "the same load, w/L above the exact elastica at P L^2 / EI 0.5: the \
         theory's own error",
        "%",
    )
    .against("elliptic integrals, elastica_exact.csv")
    .between(2.7, 2.9, || elastica_gap(0.5)),
    row(
        "V-MOD-03",
        "Princeton beam, 3 loads, 7 angles, 8 elements: largest error of tip \
         displacement",
        "%",
    )
    .against("the same energy solved elsewhere, princeton_hodges_dowell.csv")
    .at_most(0.2, || princeton("rotor/princeton_hodges_dowell.csv", Figure::Displacement, 8)),
    row("V-MOD-04", "the same: largest error of tip twist", "%")
        .against("the same energy solved elsewhere, princeton_hodges_dowell.csv")
        .at_most(0.2, || princeton("rotor/princeton_hodges_dowell.csv", Figure::Twist, 8)),
    row("V-MOD-05", "the same against the exact rod up to w/L 0.11: the theory's own error", "%")
        .against("exact Kirchhoff rod, princeton_exact_kirchhoff.csv")
        .between(1.0, 1.6, || {
            princeton("rotor/princeton_exact_kirchhoff.csv", Figure::Moderate, 8)
        }),
    row("V-MOD-06", "the same at every load, up to w/L 0.40: the theory's own error", "%")
        .against("exact Kirchhoff rod, princeton_exact_kirchhoff.csv")
        .between(18.0, 21.0, || {
            princeton("rotor/princeton_exact_kirchhoff.csv", Figure::Displacement, 8)
        }),
    row(
        "V-MOD-07",
        "hinged nonuniform blade, 7 speeds to 660 rpm, F1, F2 and L1: largest \
         distance",
        "%",
    )
    .against(
        "computed frequencies of the NASA TM 4760 blade, \
         tm4760_mbdyn_frequencies_hz.csv",
    )
    .at_most(0.5, || hinged_blade(&[("flap1", 2), ("flap2", 3)], &[("lag1", 2)])),
    row("V-MOD-08", "the same, F3", "%")
        .against(
            "computed frequencies of the NASA TM 4760 blade, \
         tm4760_mbdyn_frequencies_hz.csv",
        )
        .at_most(1.0, || hinged_blade(&[("flap3", 4)], &[])),
    row(
        "V-MOD-09",
        "rotating strip, second and third flap mode, 3 speeds: rms distance of the \
         nominal beam from measurement, which it underrates",
        "%",
    )
    .against(
        "measured by Epps and Chandra (1996), epps_chandra_frequencies_hz.csv; \
         cause unknown",
    )
    .near(6.4, 0.2, measured_strip),
    row(
        "V-MOD-10",
        "four lag frequencies against flap frequencies of the same stiffness, L^2 = \
         F^2 - 1, 40 elements: largest error",
        "relative",
    )
    .against("closed form")
    .at_most(1e-6, lag_from_flap),
    row("V-MOD-11", "two torsion frequencies, k_A 0, 40 elements: largest error", "relative")
        .against("closed form, T^2 = ((2n-1) pi/2)^2 GJ/k_m^2 + (k_m2^2 - k_m1^2)/k_m^2")
        .at_most(1e-6, torsion_closed_form),
    row(
        "V-MOD-12",
        "Table 1 torsion frequencies against 4.588 and 13.522 per rev: largest \
         error",
        "%",
    )
    .against("independent finite elements; k_m1 .0132, k_m2 .0247, k_A .029")
    .at_most(0.01, table_1_torsion),
    row(
        "V-MOD-13",
        "condensed against free axial motion of a bent blade, modes below 5 per \
         rev: largest difference",
        "relative",
    )
    .against("the same blade with axial inertia")
    .at_most(1e-4, condensation),
    row(
        "V-MOD-14",
        "free motion of a bent, rotating, undamped blade, 40 revolutions: energy \
         error of the last quarter over that of the first",
        "-",
    )
    .against("conservation of energy")
    .at_most(1.5, || Ok(energy_error(0.08, 40.0)?.map_or(f64::NAN, |[first, last]| last / first))),
    row("V-MOD-15", "order of its energy error in the time step", "-")
        .against("variational midpoint rule")
        .between(1.9, 2.1, energy_order),
    row(
        "V-MOD-21",
        "untwist of a twisted bar that is pulled, 0.05 to 0.5 of GJ / k_A^2: \
         largest error (without N k_A^2 th_x there is none)",
        "%",
    )
    .against("helical fibres that do not stretch: phi_x = -N k_A^2 th_x / (GJ + N k_A^2)")
    .at_most(0.1, || untwist(TorsionTerms::default())),
];

fn model(spec: ModerateSpec, elements: usize) -> Result<ModerateModel, Failure> {
    Ok(ModerateModel::new(ModerateBlade::new(spec)?, elements)?)
}

/// Tip displacement `[v, w]` and twist in rad under a tip force.
fn tip(spec: ModerateSpec, elements: usize, force: [f64; 3]) -> Result<[f64; 3], Failure> {
    let model = model(spec, elements)?;
    let state = model.static_state(&model.tip_load(force, 0.0), &StaticSettings::default())?;
    let section = model.section(&state.dof, 1.0)?;
    Ok([section.lag[0], section.flap[0], section.twist[0]])
}

/// A beam of length and bending stiffness 1 at rest.
fn unit_beam() -> ModerateSpec {
    BladeSpec { rotor_speed: 0.0, ..BladeSpec::uniform(1.0, 3.0, 1.0, 1e6) }.into()
}

fn planar_load() -> Result<f64, Failure> {
    let errors = [0.25, 0.5, 1.0, 2.0, 3.0].map(|load| {
        let [_, w, _] = tip(unit_beam(), 4, [0.0, 0.0, load])?;
        Ok((w / (load / 3.0) - 1.0).abs())
    });
    worst("loads", 5, errors)
}

/// Untwist of a bar of radius of gyration 0.1 and twist 0.2 rad, off that of its helical fibres, %.
fn untwist(torsion: TorsionTerms) -> Result<f64, Failure> {
    let (gyration, rate_rad) = (0.1_f64, 0.2);
    let errors = [0.05, 0.2, 0.5].map(|share| {
        let blade = BladeSpec {
            rotor_speed: 0.0,
            twist: Twist::Linear { rate_rad },
            area_gyration_radius: gyration.into(),
            ..BladeSpec::uniform(1.0, 1.0, 0.01, 1e5)
        };
        let pull = share * 0.01 / gyration.powi(2);
        let spec = ModerateSpec { torsion, ..blade.into() };
        let [_, _, twist] = tip(spec, 4, [pull, 0.0, 0.0])?;
        Ok(100.0 * (twist / (-rate_rad * share / (1.0 + share)) - 1.0).abs())
    });
    worst("pulls", 3, errors)
}

fn elastica_gap(load: f64) -> Result<f64, Failure> {
    let table = Table::read("rotor/elastica_exact.csv")?;
    let row = table.row(["load", "PL2_EI"], ["dead", &load.to_string()])?;
    let [_, w, _] = tip(unit_beam(), 4, [0.0, 0.0, load])?;
    Ok(100.0 * (w / row.number("w_over_L")? - 1.0))
}

/// What of the Princeton beam is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Figure {
    Displacement,
    /// Displacement, of tips not farther than 0.11 of the length.
    Moderate,
    Twist,
}

/// Largest distance over the table, %.
fn princeton(file: &str, figure: Figure, elements: usize) -> Result<f64, Failure> {
    let table = Table::read(file)?;
    let names = if file.contains("kirchhoff") {
        ["uy_m(stiff)", "uz_m(soft)", "twist_deg(atan2(R32,R22))"]
    } else {
        ["uy_HD", "uz_HD", "phi_tip_HD_deg"]
    };
    let mut distances = Vec::new();
    for row in table.rows() {
        let (load, angle) = (row.number("P_N")?, row.number("beta_deg")?.to_radians());
        let [uy, uz, twist] = [
            row.number(names[0])? / PRINCETON_LENGTH_M,
            row.number(names[1])? / PRINCETON_LENGTH_M,
            row.number(names[2])?,
        ];
        let size = uy.hypot(uz);
        if figure == Figure::Moderate && size > 0.111 || figure == Figure::Twist && twist == 0.0 {
            continue;
        }
        let force = [0.0, -load * angle.cos(), load * angle.sin()];
        let [v, w, phi] = tip(princeton_beam(), elements, force)?;
        distances.push(Ok(100.0
            * match figure {
                Figure::Twist => (phi.to_degrees() / twist - 1.0).abs(),
                Figure::Displacement | Figure::Moderate => (v - uy).hypot(w - uz) / size,
            }));
    }
    worst("tips", 5, distances)
}

fn none(model: &ModerateModel) -> DVector<f64> {
    DVector::zeros(model.size())
}

/// Modes about the state into which rotation at a speed over the nominal one bends the blade.
fn rotating_modes(
    spec: &ModerateSpec,
    elements: usize,
    rotor_speed: f64,
    count: ModeCount,
) -> Result<Vec<CoupledMode>, Failure> {
    let blade = BladeSpec { rotor_speed, ..spec.blade.clone() };
    let model = model(ModerateSpec { blade, ..spec.clone() }, elements)?;
    let state = model.static_state(&none(&model), &StaticSettings::default())?;
    let terms = GyroscopicTerms::Included;
    Ok(deflected_modes(&model, &state, terms, AxialMotion::Free, count)?)
}

fn frequency(modes: &[CoupledMode], kind: ModeKind, number: usize) -> Result<f64, Failure> {
    let mode = modes.iter().find(|mode| mode.kind == kind && mode.number == number);
    let missing = too_few("modes", modes.len(), number);
    mode.map(|mode| mode.frequency).ok_or(missing)
}

/// Largest distance of the named columns, %; the number of a mode counts the rigid one.
fn hinged_blade(flap: &[(&str, usize)], lag: &[(&str, usize)]) -> Result<f64, Failure> {
    let table = Table::read("rotor/tm4760_mbdyn_frequencies_hz.csv")?;
    let blade = tm_4760_blade()?;
    let mut distances = Vec::new();
    for row in table.rows() {
        let speed = row.number("rpm")? / TM_4760_RPM;
        let count = ModeCount { flap: 4, lag: 2, torsion: 0, axial: 0 };
        let modes = rotating_modes(&blade, 30, speed, count)?;
        for (kind, columns) in [(ModeKind::Flap, flap), (ModeKind::Lag, lag)] {
            for (column, number) in columns {
                let got = frequency(&modes, kind, *number)? * TM_4760_RPM / 60.0;
                distances.push(Ok(100.0 * (got / row.number(column)? - 1.0).abs()));
            }
        }
    }
    worst("frequencies", 7, distances)
}

fn measured_strip() -> Result<f64, Failure> {
    let table = Table::read("rotor/epps_chandra_frequencies_hz.csv")?;
    let blade = epps_chandra_strip();
    let columns = ["f_0rpm", "f_500rpm", "f_750rpm"];
    let speeds = [0.0, 500.0 / EPPS_CHANDRA_RPM, 1.0];
    let count = ModeCount { flap: 3, lag: 0, torsion: 0, axial: 0 };
    let fan = speeds
        .map(|speed| rotating_modes(&blade, 20, speed, count))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let mut squares = Vec::new();
    for (mode, number) in [("B2", 2), ("B3", 3)] {
        let row = table.row(["mode", "sweep_deg"], [mode, "0"])?;
        for (modes, column) in fan.iter().zip(columns) {
            let got = frequency(modes, ModeKind::Flap, number)? * EPPS_CHANDRA_RPM / 60.0;
            squares.push((100.0 * (got / row.number(column)? - 1.0)).powi(2));
        }
    }
    Ok((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

/// The blade of the paper's Table 1, practically inextensional.
fn table_1_blade() -> BladeSpec {
    BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1e6)
}

fn frequencies(spec: BladeSpec, elements: usize, count: ModeCount) -> Result<Vec<f64>, Failure> {
    let model = model(spec.into(), elements)?;
    let state = model.static_state(&none(&model), &StaticSettings::default())?;
    let terms = GyroscopicTerms::Neglected;
    let found = deflected_modes(&model, &state, terms, AxialMotion::Free, count)?;
    Ok(found.iter().map(|mode| mode.per_rev).collect())
}

const NO_MODES: ModeCount = ModeCount { flap: 0, lag: 0, torsion: 0, axial: 0 };

fn lag_from_flap() -> Result<f64, Failure> {
    let lag = frequencies(table_1_blade(), 40, ModeCount { lag: 4, ..NO_MODES })?;
    let stiff = BladeSpec { flap_stiffness: 0.0268.into(), ..table_1_blade() };
    let flap = frequencies(stiff, 40, ModeCount { flap: 4, ..NO_MODES })?;
    let errors = lag.iter().zip(&flap).map(|(l, f)| Ok((l * l / (f * f - 1.0) - 1.0).abs()));
    worst("modes", 4, errors)
}

fn torsion_closed_form() -> Result<f64, Failure> {
    let (k1, k2) = (0.0132_f64, 0.0247_f64);
    let spec = BladeSpec { area_gyration_radius: 0.0.into(), ..table_1_blade() };
    let found = frequencies(spec, 40, ModeCount { torsion: 2, ..NO_MODES })?;
    let polar = k1 * k1 + k2 * k2;
    let errors = found.iter().enumerate().map(|(n, got)| {
        let wave = (2.0 * n as f64 + 1.0) * FRAC_PI_2;
        let exact = (wave * wave * 0.006_15 / polar + (k2 * k2 - k1 * k1) / polar).sqrt();
        Ok((got / exact - 1.0).abs())
    });
    worst("modes", 2, errors)
}

fn table_1_torsion() -> Result<f64, Failure> {
    let found = frequencies(table_1_blade(), 20, ModeCount { torsion: 2, ..NO_MODES })?;
    let errors =
        found.iter().zip([4.588, 13.522]).map(|(got, want)| Ok(100.0 * (got / want - 1.0).abs()));
    worst("modes", 2, errors)
}

/// A twisted, pitched, preconed blade with finite axial stiffness and offsets of its centres.
fn coupled_blade() -> ModerateSpec {
    ModerateSpec {
        mass_centre: (-0.004).into(),
        tension_centre: 0.003.into(),
        ..BladeSpec {
            twist: Twist::Linear { rate_rad: -0.14 },
            pitch_rad: 0.14,
            precone_rad: 0.03,
            axial_stiffness: 200.0.into(),
            ..table_1_blade()
        }
        .into()
    }
}

fn condensation() -> Result<f64, Failure> {
    let model = model(coupled_blade(), 10)?;
    let load = model.distributed_load(|x| [0.0, -2e-3 * x, 0.03 * x * x, 0.0]);
    let state = model.static_state(&load, &StaticSettings::default())?;
    let solve = |axial| {
        let (terms, count) = (GyroscopicTerms::Included, ModeCount::default());
        deflected_modes(&model, &state, terms, axial, count)
    };
    let (free, condensed) = (solve(AxialMotion::Free)?, solve(AxialMotion::Condensed)?);
    let low = free.iter().zip(&condensed).filter(|(mode, _)| mode.frequency < 5.0);
    worst("modes", 5, low.map(|(a, b)| Ok((b.frequency / a.frequency - 1.0).abs())))
}

/// Largest energy error of the first and the last quarter of a free motion, over the energy that was
/// let go; none without a sample in each.
fn energy_error(time_step: f64, revolutions: f64) -> Result<Option<[f64; 2]>, Failure> {
    let model = model(coupled_blade(), 3)?;
    let settings = StaticSettings::default();
    let load = model.distributed_load(|x| [0.0, 0.01 * x, 0.04 * x * x, 0.0]);
    let bent = model.static_state(&load, &settings)?;
    let rest = model.static_state(&none(&model), &settings)?;
    let motion = FreeMotion::new(&model, time_step);
    let energy = |state: &MotionState| motion.energy(state).ok_or("a singular mass matrix");
    let mut state = motion.at_rest(bent.dof);
    let start = energy(&state)?;
    let size = start - energy(&motion.at_rest(rest.dof))?;
    let whole = revolutions * TAU;
    let mut errors = [None, None];
    let (mut time, mut step) = (0.0, 0_usize);
    while time < whole {
        state = motion.step(&state).ok_or("a step of the free motion was not solved")?;
        time += time_step;
        step += 1;
        let part = match time / whole {
            early if early < 0.25 => 0,
            late if late > 0.75 => 1,
            _ => continue,
        };
        if step % 4 == 0 {
            let error = (energy(&state)? - start).abs() / size;
            errors[part] = Some(errors[part].map_or(error, |e: f64| e.max(error)));
        }
    }
    let [first, last] = errors;
    Ok(first.zip(last).map(|(first, last)| [first, last]))
}

fn energy_order() -> Result<f64, Failure> {
    let coarse = energy_error(0.08, 4.0)?.map_or(f64::NAN, |[first, _]| first);
    let fine = energy_error(0.04, 4.0)?.map_or(f64::NAN, |[first, _]| first);
    Ok((coarse / fine).log2())
}
