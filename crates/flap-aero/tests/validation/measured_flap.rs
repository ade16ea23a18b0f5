//! The oscillating flap of Tijdeman and Schippers: lift, moment and hinge moment, measured and computed.

use std::fmt::Write;
use std::sync::LazyLock;

use exact_section::Possio;
use flap_aero::{AttachedFlowModel, FlapChord, Load, Mach, Motion, harmonic_response};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use validation::{Check, Failure, Table, row, shared, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-AERO-26",
        "oscillating flap in the wind tunnel, M 0.5, k 0.098: phase of the lift, \
         measured less calibrated",
        "deg",
    )
    .against("flap_oscillation, digitised")
    .near(0.0, 0.5, || Ok(oscillating_flap()?[0])),
    row("V-AERO-27", "the same: moment, measured over calibrated", "-")
        .against("flap_oscillation, digitised")
        .near(1.0, 0.01, || Ok(oscillating_flap()?[1])),
    row(
        "V-AERO-28",
        "the same: lift, measured over calibrated (the boundary layer's share, no \
         error of the theory)",
        "-",
    )
    .against("flap_oscillation, digitised")
    .near(0.78, 0.01, || Ok(oscillating_flap()?[2])),
    row(
        "V-AERO-51",
        "hinge moment of that flap, measured over calibrated (the boundary layer's share again)",
        "-",
    )
    .against(TIJDEMAN)
    .near(0.80, 0.01, || Ok(compared(M050, CALIBRATED)?.ratios[2])),
    row("V-AERO-52", "the same: phase of the hinge moment, measured less calibrated", "deg")
        .against(TIJDEMAN)
        .near(0.9, 0.3, || Ok(compared(M050, CALIBRATED)?.phases_deg[2])),
    row(
        "V-AERO-53",
        "the same flap at M .748, k .268, beyond the theory, which knows no shock: lift, measured over calibrated",
        "-",
    )
    .against(TIJDEMAN)
    .between(0.85, 1.0, || Ok(compared(M075, CALIBRATED)?.ratios[0])),
    row("V-AERO-54", "the same, M .748: moment, measured over calibrated", "-")
        .against(TIJDEMAN)
        .between(0.85, 1.0, || Ok(compared(M075, CALIBRATED)?.ratios[1])),
    row("V-AERO-55", "the same, M .748: hinge moment, measured over calibrated", "-")
        .against(TIJDEMAN)
        .between(0.75, 0.85, || Ok(compared(M075, CALIBRATED)?.ratios[2])),
    row("V-AERO-56", "the same, M .748: phase of the lift, measured less calibrated", "deg")
        .against(TIJDEMAN)
        .between(-8.0, -2.0, || Ok(compared(M075, CALIBRATED)?.phases_deg[0])),
    row(
        "V-AERO-57",
        "that flap at M .5: calibrated over measured, lift and hinge moment, the lowest of both 95 % intervals",
        "-",
    )
    .against(TIJDEMAN)
    .at_least(1.2, || {
        let [lift, _, hinge] = compared(M050, CALIBRATED)?.factors;
        Ok(lift[1].min(hinge[1]))
    }),
    row("V-AERO-58", "the same: moment, the end of its interval that is furthest from 1", "%")
        .against(TIJDEMAN)
        .at_most(1.0, || {
            let [_, low, high] = compared(M050, CALIBRATED)?.factors[1];
            Ok(100.0 * (low - 1.0).abs().max((high - 1.0).abs()))
        }),
    row("V-AERO-59", "95 % intervals of both Mach numbers: half of the widest of an amplitude", "%")
        .against("bootstrap over the digitised points")
        .at_most(1.5, widest_interval),
    row("V-AERO-60", "hinge moment at M .5, exact linear theory over measured", "-")
        .against(TIJDEMAN)
        .near(1.25, 0.02, || Ok(compared(M050, Theory::Exact)?.factors[2][0])),
    row("V-AERO-61", "lift at M .5, form of Hariharan and Leishman over measured; shown", "-")
        .against(TIJDEMAN)
        .near(1.38, 0.02, || Ok(compared(M050, LEISHMAN)?.factors[0][0])),
    row("V-AERO-62", "the same: hinge moment; shown", "-")
        .against(TIJDEMAN)
        .near(1.27, 0.02, || Ok(compared(M050, LEISHMAN)?.factors[2][0])),
    row(
        "V-AERO-63",
        "phase of the lift at M .5, measured less quasi-steady: what the lags of the wake are worth",
        "deg",
    )
    .against(TIJDEMAN)
    .at_least(8.0, || Ok(compared(M050, QUASI_STEADY)?.phases_deg[0])),
];

const TIJDEMAN: &str = "Tijdeman and Schippers, NLR (1973), first harmonics of digitised loops";
const M050: usize = 0;
const M075: usize = 1;
const AMPLITUDE_DEG: f64 = 2.5;
const FLAP_CHORD: f64 = 0.25;

/// First harmonic of a measured load.
#[derive(Debug, Clone, Copy)]
struct Harmonic {
    /// Per rad: in phase with the flap, and in quadrature.
    value: Complex64,
    /// Ends of the 95 % intervals of the amplitude per rad and of the phase, deg.
    amplitude: [f64; 2],
    phase_deg: [f64; 2],
}

/// Lift, moment and hinge moment of the NACA 64A006 with a flap of a quarter of the chord that moves by 2.5 deg.
#[derive(Debug)]
struct MeasuredFlap {
    mach: f64,
    reduced_frequency: f64,
    loads: Vec<Harmonic>,
}

/// The measured flaps: at Mach 0.5, and at 0.748 where linear theory ends.
fn measured() -> Result<&'static [MeasuredFlap; 2], Failure> {
    static READ: LazyLock<Result<[MeasuredFlap; 2], Failure>> = LazyLock::new(|| {
        let table = Table::read("../measured/flap_hinge_moment/harmonics.csv")?;
        let flap = |case: &str| -> Result<MeasuredFlap, Failure> {
            let rows = ["cn", "cm", "ch"].map(|load| table.row(["case", "load"], [case, load]));
            let mut loads = Vec::new();
            let (mut mach, mut reduced_frequency) = (f64::NAN, f64::NAN);
            for row in rows {
                let row = row?;
                (mach, reduced_frequency) = (row.number("mach")?, row.number("k")?);
                let pair = |a: &str, b: &str| Ok::<_, Failure>([row.number(a)?, row.number(b)?]);
                let [re, im] = pair("in_phase", "quadrature")?;
                loads.push(Harmonic {
                    value: Complex64::new(re, im),
                    amplitude: pair("amplitude_low", "amplitude_high")?,
                    phase_deg: pair("phase_low_deg", "phase_high_deg")?,
                });
            }
            Ok(MeasuredFlap { mach, reduced_frequency, loads })
        };
        Ok([flap("01")?, flap("02")?])
    });
    shared(&READ)
}

/// What is compared with the measurement.
#[derive(Debug, Clone, Copy)]
enum Theory {
    /// Possio's equation.
    Exact,
    Model(AttachedFlowModel),
}

const CALIBRATED: Theory = Theory::Model(AttachedFlowModel::Calibrated);
const LEISHMAN: Theory = Theory::Model(AttachedFlowModel::HariharanLeishman);
const QUASI_STEADY: Theory = Theory::Model(AttachedFlowModel::QuasiSteady);

/// A measured flap beside a theory, by load.
struct Compared {
    /// Theory, per rad.
    found: [Complex64; 3],
    /// Measured over theory.
    ratios: [f64; 3],
    /// Theory over measured, with the 95 % interval of the digitised points.
    factors: [[f64; 3]; 3],
    /// Measured less theory.
    phases_deg: [f64; 3],
}

/// From the flap, by size: the direction of travel round the loops is not known.
fn phase_deg(load: Complex64) -> f64 {
    load.im.abs().atan2(load.re.abs()).to_degrees()
}

fn compared(case: usize, theory: Theory) -> Result<Compared, Failure> {
    let flap = &measured()?[case];
    let k = flap.reduced_frequency;
    let found = match theory {
        Theory::Exact => {
            exact_section::Motion::Flap.of(&Possio::new(flap.mach, k)?.loads(FLAP_CHORD)?, k)
        }
        Theory::Model(model) => {
            let section = model.coefficients(Mach::new(flap.mach)?, FlapChord::new(FLAP_CHORD)?)?;
            harmonic_response(&section, k, Motion::Flap)
        }
    };
    let of = |load: usize| (flap.loads[load], found[load]);
    Ok(Compared {
        found,
        ratios: [0, 1, 2].map(|load| of(load).0.value.norm() / of(load).1.norm()),
        factors: [0, 1, 2].map(|load| {
            let (measured, found) = of(load);
            let [low, high] = measured.amplitude;
            [measured.value.norm(), high, low].map(|amplitude| found.norm() / amplitude)
        }),
        phases_deg: [0, 1, 2].map(|load| phase_deg(of(load).0.value) - phase_deg(of(load).1)),
    })
}

/// Half of the widest interval of an amplitude, over the amplitude, per cent.
fn widest_interval() -> Result<f64, Failure> {
    let loads = measured()?.iter().flat_map(|flap| &flap.loads);
    let widths = loads.map(|load| {
        let [low, high] = load.amplitude;
        Ok(50.0 * (high - low) / load.value.norm())
    });
    worst("intervals", 6, widths)
}

/// Phase difference of the lift in degrees, moment and lift of the measurement over the calibrated
/// model.
fn oscillating_flap() -> Result<[f64; 3], Failure> {
    let section =
        AttachedFlowModel::Calibrated.coefficients(Mach::new(0.5)?, FlapChord::new(0.25)?)?;
    let [cn, cm, _] = harmonic_response(&section, 0.098, Motion::Flap);
    let [lift, moment] =
        [Loop::shipped(LIFT_LOOP).harmonic(None), Loop::shipped(MOMENT_LOOP).harmonic(None)];
    Ok([phase_deg(lift) - phase_deg(cn), moment.norm() / cm.norm(), lift.norm() / cn.norm()])
}

const LIFT_LOOP: &str = include_str!("../../../../fixtures/reference/flap_oscillation/exp_cn.txt");
const MOMENT_LOOP: &str =
    include_str!("../../../../fixtures/reference/flap_oscillation/exp_cm.txt");

/// Digitised points round a loop.
struct Loop {
    angles_deg: Vec<f64>,
    values: Vec<f64>,
}

impl Loop {
    /// Of a file of two lines.
    fn shipped(text: &str) -> Self {
        let line = |n: usize| text.lines().nth(n).into_iter().flat_map(str::split_whitespace);
        let numbers = |n: usize| line(n).filter_map(|word| word.parse().ok()).collect();
        Self { angles_deg: numbers(0), values: numbers(1) }
    }

    /// First harmonic per rad, in phase and in quadrature with the flap angle, by least squares; of the points drawn, or of all.
    fn harmonic(&self, drawn: Option<&[usize]>) -> Complex64 {
        let n = self.angles_deg.len();
        let all: Vec<usize> = (0..n).collect();
        let points = drawn.unwrap_or(&all);
        let basis = DMatrix::from_fn(points.len(), 3, |k, column| {
            let i = points[k];
            let sine = (self.angles_deg[i] / AMPLITUDE_DEG).clamp(-1.0, 1.0);
            let rising = self.angles_deg[(i + 1) % n] > self.angles_deg[(i + n - 1) % n];
            [1.0, sine, (1.0 - sine * sine).sqrt() * if rising { 1.0 } else { -1.0 }][column]
        });
        let right = DVector::from_iterator(points.len(), points.iter().map(|i| self.values[*i]));
        let solution = basis.svd(true, true).solve(&right, 1e-12).unwrap_or_else(|_| right.clone());
        Complex64::new(solution[1], solution[2]) / AMPLITUDE_DEG.to_radians()
    }

    /// The harmonic with its 95 % intervals: the points drawn again, with replacement, 2000 times.
    fn harmonic_with_intervals(&self) -> Harmonic {
        const DRAWS: usize = 2000;
        let n = self.angles_deg.len();
        let mut state = 1_u64;
        let mut draw = || {
            // Knuth's MMIX generator; its upper bits are the good ones
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % n
        };
        let harmonics: Vec<Complex64> = (0..DRAWS)
            .map(|_| self.harmonic(Some(&(0..n).map(|_| draw()).collect::<Vec<_>>())))
            .collect();
        let interval = |of: fn(Complex64) -> f64| {
            let mut sorted: Vec<f64> = harmonics.iter().map(|harmonic| of(*harmonic)).collect();
            sorted.sort_by(f64::total_cmp);
            [sorted[DRAWS / 40], sorted[DRAWS - 1 - DRAWS / 40]]
        };
        Harmonic {
            value: self.harmonic(None),
            amplitude: interval(Complex64::norm),
            phase_deg: interval(phase_deg),
        }
    }
}

/// A line of the table of harmonics, without its case.
fn line(found: &Harmonic) -> String {
    let ([a, b], [c, d]) = (found.amplitude, found.phase_deg);
    format!("{:.5},{:.5},{a:.5},{b:.5},{c:.2},{d:.2}", found.value.re, found.value.im.abs())
}

const HARMONICS: &str =
    include_str!("../../../../fixtures/measured/flap_hinge_moment/harmonics.csv");

#[test]
fn the_harmonics_are_those_of_the_shipped_loops() {
    for (load, text) in [("cn", LIFT_LOOP), ("cm", MOMENT_LOOP)] {
        let found = Loop::shipped(text).harmonic_with_intervals();
        let written = measured().unwrap()[M050].loads[usize::from(load == "cm")];
        let pairs = [
            (written.value.re, found.value.re, 2e-3),
            (written.value.im.abs(), found.value.im.abs(), 2e-3),
            (written.amplitude[0], found.amplitude[0], 2e-3),
            (written.amplitude[1], found.amplitude[1], 2e-3),
            (written.phase_deg[0], found.phase_deg[0], 0.1),
            (written.phase_deg[1], found.phase_deg[1], 0.1),
        ];
        assert!(pairs.iter().all(|(a, b, within)| (a - b).abs() <= *within), "{load}: {pairs:?}");
    }
}

/// The loops of the hinge moment and of Mach 0.748 are not part of the project: `FLAP_LOOPS` is the full path of the
/// file that has them.
#[test]
fn the_harmonics_are_those_of_the_loops_where_these_are_at_hand() {
    let Some(path) = std::env::var_os("FLAP_LOOPS") else {
        println!(
            "skipped: the loops are not part of the project; FLAP_LOOPS=FULL/PATH/loops.csv names them"
        );
        return;
    };
    let table = Table::read(path.to_str().unwrap()).unwrap();
    let mut expected = String::from(HARMONICS_TITLE);
    for case in ["01", "02"] {
        for load in ["cn", "cm", "ch"] {
            let rows: Vec<_> = table
                .rows()
                .filter(|row| row.text("case").unwrap() == case)
                .filter(|row| row.text("coefficient").unwrap() == load)
                .collect();
            let column = |name| rows.iter().map(|row| row.number(name).unwrap()).collect();
            let points = Loop { angles_deg: column("delta_deg"), values: column("value") };
            let [mach, k] = ["mach", "reduced_frequency"].map(|name| rows[0].text(name).unwrap());
            let harmonic = line(&points.harmonic_with_intervals());
            writeln!(expected, "{case},{mach},{k},{load},{},{harmonic}", rows.len()).unwrap();
        }
    }
    assert!(HARMONICS == expected, "harmonics.csv is not that of {}:\n{expected}", path.display());
}

const HARMONICS_TITLE: &str = "case,mach,k,load,points,in_phase,quadrature,amplitude_low,amplitude_high,phase_low_deg,phase_high_deg\n";

#[test]
fn the_tables_of_the_book_are_computed() {
    let mut tables = [String::new(), String::new()];
    for (case, flap) in measured().unwrap().iter().enumerate() {
        let calibrated = compared(case, CALIBRATED).unwrap();
        let conditions = format!("{}, {}", flap.mach, flap.reduced_frequency);
        for (name, load) in ["lift", "moment", "hinge moment"].into_iter().zip(Load::ALL) {
            let o = load.index();
            let Harmonic { value, amplitude: [a, b], phase_deg: [c, d] } = flap.loads[o];
            let ([factor, low, high], found) = (calibrated.factors[o], calibrated.found[o]);
            let sizes = [value, found].map(Complex64::norm);
            let phases = [value, found].map(phase_deg);
            writeln!(
                tables[0],
                "| {conditions} | {name} | {:.4}, {a:.4} to {b:.4} | {:.1}, {c:.1} to {d:.1} | {:.4} | {:.1} | {factor:.3}, {low:.3} to {high:.3} |",
                sizes[0], phases[0], sizes[1], phases[1],
            )
            .unwrap();
        }
        let theories = [
            ("exact linear theory (Possio)", Theory::Exact),
            ("calibrated", CALIBRATED),
            ("form of Hariharan and Leishman", LEISHMAN),
            ("quasi-steady, Prandtl and Glauert", QUASI_STEADY),
        ];
        for (name, theory) in theories {
            let Compared { factors: [[lift, ..], [moment, ..], [hinge, ..]], phases_deg, .. } =
                compared(case, theory).unwrap();
            let [p, q, r] = phases_deg.map(|phase| -phase);
            writeln!(
                tables[1],
                "| {conditions} | {name} | {lift:.2}, {moment:.2}, {hinge:.2} | {p:+.1}, {q:+.1}, {r:+.1} |"
            )
            .unwrap();
        }
    }
    let page = include_str!("../../../../docs/src/case-studies/oscillating-flap.md");
    let found = tables.iter().all(|table| page.contains(table));
    assert!(
        found,
        "docs/src/case-studies/oscillating-flap.md lacks one of these tables:\n{}",
        tables.join("\n")
    );
}
