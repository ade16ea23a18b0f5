//! The rotating strip of Epps and Chandra: found at sweep 0, foretold at the other angles.

use super::figure::{Axis, Mark, Panel, Series, drawn};
use super::{Done, Run, Study, Teller, Told, answers, table};
use crate::XtaskError;
use rotor_case::{Case, CouplingsChoice, times};
use rotor_study::{ModesQuestion, modes_at_speeds};

pub(super) const STUDY: Study = Study {
    name: "rotating-strip",
    is_quick: true,
    runs: &[Run {
        label: "sweep 0",
        case: "fixtures/points/epps_chandra_sweep0/case.ron",
        data: "epps_chandra_sweep0",
    }],
    told: Teller::Simulating(told),
};

const MEASURED: &str = include_str!("../../shared/epps_chandra_frequencies_hz.csv");
/// Rows of the table: the second and third bending mode.
const MODES: [&str; 2] = ["B2", "B3"];
const SWEEPS_DEG: [f64; 4] = [0.0, 15.0, 30.0, 45.0];
const SPEEDS_RPM: [f64; 3] = [0.0, 500.0, 750.0];
/// Length of the swept part, m.
const SWEPT_M: f64 = 6.0 * 0.0254;

/// Steps of the table of the swept part.
const STEPS: u32 = 12;

/// The strip with its end swept aft by an angle: the same length of blade, over the radius of its tip.
fn swept(case: &Case, sweep_deg: f64) -> Case {
    let mut case = case.clone();
    if sweep_deg == 0.0 {
        return case;
    }
    let (sin, cos) = sweep_deg.to_radians().sin_cos();
    let r = &mut case.rotor;
    let kink_m = r.radius_m - SWEPT_M;
    let radius_m = kink_m + SWEPT_M * cos;
    let (ratio, t) = (r.radius_m / radius_m, &mut r.tables);
    for (uniform, table) in
        [(&mut r.ei_flap, &mut t.ei_flap), (&mut r.ei_lag, &mut t.ei_lag), (&mut r.gj, &mut t.gj)]
    {
        times(uniform, table, ratio.powi(4));
    }
    r.ea *= ratio.powi(2);
    for length in [
        &mut r.km1_r,
        &mut r.km2_r,
        &mut r.ka_r,
        &mut r.chord_r,
        &mut r.root_offset_r,
        &mut r.root_cutout_r,
    ] {
        *length *= ratio;
    }
    r.radius_m = radius_m;
    let (kink, tip) = (kink_m / radius_m, SWEPT_M * sin / radius_m);
    t.set_back_r = vec![(0.0, 0.0), (kink, 0.0), (1.0, tip)];
    // the radius of gyration is about the straight elastic axis
    let about = |share: f64| (kink + share * (1.0 - kink), r.km2_r.hypot(share * tip));
    t.km2_r = (0..=STEPS).map(|k| about(f64::from(k) / f64::from(STEPS))).collect();
    t.km2_r.insert(0, (0.0, r.km2_r));
    case.structure.couplings = CouplingsChoice::Moderate;
    case
}

/// Measured bending frequencies of a sweep angle, Hz, by mode and speed.
fn measured(sweep_deg: f64) -> Vec<Vec<f64>> {
    let of_mode = |mode: &&str| {
        let wanted = format!("{mode},{sweep_deg},");
        let line = MEASURED.lines().find_map(|line| line.strip_prefix(&wanted));
        line.unwrap_or_default().split(',').filter_map(|cell| cell.parse().ok()).collect()
    };
    MODES.iter().map(of_mode).collect()
}

/// Frequencies of a case at the speeds of the test times a ratio, Hz, by mode and speed.
fn simulated(case: &Case, speed: f64) -> Result<Vec<Vec<f64>>, XtaskError> {
    let ratios = SPEEDS_RPM.map(|rpm| rpm * speed / case.rotor.omega_rpm);
    let found = modes_at_speeds(case, &ModesQuestion::default(), &ratios)
        .map_err(|error| XtaskError::Study(error.to_string()))?;
    // swept, a bending mode twists: they are counted among all that leave the plane
    let of_mode = |place: usize| {
        let at = |own: &rotor_study::ModesResult| {
            let bending = own.modes.iter().filter(|mode| mode.kind != "lag");
            let mut hz: Vec<f64> = bending.map(|mode| mode.hz).collect();
            hz.sort_by(f64::total_cmp);
            hz.get(place).copied().unwrap_or(f64::NAN)
        };
        found.iter().map(at).collect()
    };
    Ok((1..=MODES.len()).map(of_mode).collect())
}

/// Rms of simulated over measured less one, percent.
fn rms_percent(measured: &[Vec<f64>], simulated: &[Vec<f64>]) -> f64 {
    let pairs = measured.iter().flatten().zip(simulated.iter().flatten());
    let off: Vec<f64> = pairs.map(|(read, own)| 100.0 * (own / read - 1.0)).collect();
    rotor_base::mean_square(&off).sqrt()
}

/// The case stiffer and turning faster: the other explanation.
fn faster(done: &Done) -> (Case, f64) {
    let value = |cause: &str| {
        let own = done.findings.parameters.get(cause).and_then(|own| own.get("ratio"));
        own.map_or(1.0, |own| own.value)
    };
    let mut case = done.case.clone();
    let r = &mut case.rotor;
    times(&mut r.ei_flap, &mut r.tables.ei_flap, value("stiffness-flap"));
    (case, value("rotor-speed"))
}

fn told(done: &[Done]) -> Result<Told, XtaskError> {
    let own = &done[0];
    let extended = own.extended.as_ref().unwrap_or(&own.case);
    let (faster, speed) = faster(own);
    let (mut rows, mut lines) = (Vec::new(), [vec![], vec![], vec![]]);
    let mut unswept = Vec::new();
    for sweep_deg in SWEEPS_DEG {
        let read = measured(sweep_deg);
        let of = [(&own.case, 1.0), (extended, 1.0), (&faster, speed)];
        let of = of.map(|(case, speed)| simulated(&swept(case, sweep_deg), speed));
        let [before, further_out, faster] = of;
        let all = [before?, further_out?, faster?];
        let rms = [0, 1, 2].map(|k| rms_percent(&read, &all[k]));
        for (line, rms) in lines.iter_mut().zip(rms) {
            line.push([sweep_deg, rms]);
        }
        let mut row = vec![format!("{sweep_deg}")];
        row.extend(rms.map(|own| format!("{own:.1}")));
        rows.push(row);
        if sweep_deg == 0.0 {
            unswept = vec![read, all[0].clone(), all[1].clone()];
        }
    }
    let titles = [
        "sweep, deg",
        "rms of the frequencies, %: nominal",
        "stiffer and further out",
        "stiffer and faster",
    ];
    let numbers = format!("{}\n{}", answers(done), table(&titles, &rows));
    let series = |which: usize, name, colour, mark| {
        let of_mode = |own: &Vec<f64>| SPEEDS_RPM.iter().zip(own).map(|(x, y)| [*x, *y]).collect();
        let modes: Vec<Vec<[f64; 2]>> = unswept[which].iter().map(of_mode).collect();
        modes.into_iter().map(move |points| Series { name, colour, mark, points })
    };
    let mut all: Vec<Series> = series(0, "measured", 0, Mark::Diamonds).collect();
    all.extend(series(1, "nominal", 1, Mark::Line));
    all.extend(series(2, "with what was found", 2, Mark::Line));
    all.sort_by_key(|own| own.mark == Mark::Diamonds);
    let [nominal, further_out, _] = lines;
    let gain = |name, colour, points| Series { name, colour, mark: Mark::Line, points };
    let panels = [
        Panel {
            title: "second and third flap mode, sweep 0".to_owned(),
            x: Axis { label: "rotor speed, rpm", ends: [0.0, 800.0], step: 200.0 },
            y: Axis { label: "frequency, Hz", ends: [0.0, 70.0], step: 10.0 },
            series: all,
        },
        Panel {
            title: "foretold at other sweep angles".to_owned(),
            x: Axis { label: "sweep, deg", ends: [0.0, 45.0], step: 15.0 },
            y: Axis { label: "rms of the frequencies, %", ends: [0.0, 8.0], step: 2.0 },
            series: vec![gain("nominal", 1, nominal), gain("with what was found", 2, further_out)],
        },
    ];
    Ok(Told { numbers, figure: drawn("Rotating strip of Epps and Chandra", &panels) })
}
