//! The linearised rotor of a case as matrices of state space with names and units.

use super::exported::dissimilar_note;
use super::labels::load_axis;
use crate::{FlightError, RotorPath};
use nalgebra::DMatrix;
use rotor_case::Case;
use rotor_export::{Axis, Document, LabelledArray};
use rotor_response::{BladeStateSpace, BladesTogether};
use rotor_study::HubLoads;

/// Blades from which the coefficients of all together do not change with the azimuth in hover.
const LEAST_BLADES: usize = 3;

/// State space of the rotor of a case in its trim, flaps at rest: of one blade at azimuths of a revolution, and of all
/// blades in multiblade coordinates with constant coefficients.
///
/// # Errors
/// [`FlightError::Trim`], [`FlightError::WakeDiverged`], [`FlightError::Response`].
pub fn state_space_of_case(case: &Case) -> Result<Document, FlightError> {
    let advance_ratio = case.advance_ratio;
    let path = RotorPath::new(case, &[advance_ratio])?;
    let Some((_, rotor)) = path.rotors().next() else { return Ok(Document::default()) };
    let at = |source| FlightError::Response { advance_ratio, source };
    let space = rotor.state_space().map_err(at)?;
    let mut arrays = blade(&space);
    let mut notes = notes(case);
    if space.blades < LEAST_BLADES {
        notes.push("Multiblade matrices are left out: with fewer than three blades the loads in the fixed frame change with the azimuth even in hover.".to_owned());
    } else {
        arrays.extend(multiblade(&space));
    }
    Ok(Document { title: case.title.clone(), notes, arrays })
}

fn notes(case: &Case) -> Vec<String> {
    let omega = case.rotor.omega_rpm / 60.0 * std::f64::consts::TAU;
    let mut notes = vec![
        format!("Trim at an advance ratio of {}; changes about it. Derivatives are by azimuth in rad: times {omega} rad/s they are by time.", case.advance_ratio),
        "Blade: x' = A(psi) x + B(psi) u, y = C(psi) x + D(psi) u. x: modal coordinates and their rates. u: angle of each flap (rad, trailing edge down positive) with its first and second derivative. y: loads of this blade on the hub in the fixed frame, m0 Omega^2 R^2 and R^3, X aft, Y starboard, Z up. Blade b of N is the same at psi + 2 pi b / N; the hub feels the sum of all.".to_owned(),
        "Multiblade: q_b = q_0 + sum q_nc cos n psi_b + q_ns sin n psi_b + (-1)^b q_d, flaps likewise; coefficients are their means over the revolution. Exact in hover without cyclic pitch; in flight what the harmonics of the coefficients carry from one frequency to another is dropped.".to_owned(),
        "Held: inflow and pilot controls. Quasi-steady: the lag states of the sections, settled at every azimuth; with `aerodynamics.model: QuasiSteady` there are none.".to_owned(),
    ];
    notes.extend(dissimilar_note(case));
    notes
}

/// Names of the modal coordinates of a blade.
fn modes(space: &BladeStateSpace) -> Vec<String> {
    space.modes.iter().map(|(kind, number)| format!("{kind:?}{number}").to_lowercase()).collect()
}

/// Names and units of coordinates and rates.
fn state_axis(name: &str, coordinates: &[String]) -> Axis {
    let rates = coordinates.iter().map(|own| format!("{own}_rate"));
    let labels: Vec<String> = coordinates.iter().cloned().chain(rates).collect();
    let unit = |k: usize| if k < coordinates.len() { "" } else { "1/rad" };
    let units = (0..labels.len()).map(|k| unit(k).to_owned()).collect();
    Axis { name: name.to_owned(), labels, units }
}

/// Names and units of flap angles and their derivatives; `prefix` names the motion of the blades.
fn flap_inputs(flaps: usize, prefix: &str) -> (Vec<String>, Vec<String>) {
    let parts = [("angle", "rad"), ("rate", "rad/rad"), ("acceleration", "rad/rad^2")];
    (1..=flaps)
        .flat_map(|flap| {
            parts.map(|(part, unit)| (format!("{prefix}flap{flap}_{part}"), unit.to_owned()))
        })
        .unzip()
}

fn hub_axis() -> Axis {
    load_axis(HubLoads::NAMES.iter().map(|name| (*name).to_owned()).collect())
}

/// Matrices of one blade over the azimuth.
fn blade(space: &BladeStateSpace) -> Vec<LabelledArray> {
    let coordinates = modes(space);
    let states = state_axis("state", &coordinates);
    let (labels, units) = flap_inputs(space.flaps, "");
    let inputs = Axis { name: "input".to_owned(), labels, units };
    let places = space.azimuths_rad.iter().map(|psi| format!("psi_{:.3}_deg", psi.to_degrees()));
    let places = Axis::of_unit("azimuth", places.collect(), "");
    let grid = Axis {
        name: "quantity".to_owned(),
        labels: vec!["azimuth_rad".to_owned(), "weight_of_the_mean".to_owned()],
        units: vec!["rad".to_owned(), String::new()],
    };
    let of = |name: &str, meaning: &str, rows: &Axis, columns: &Axis, all: &[DMatrix<f64>]| {
        let axes = vec![rows.clone(), columns.clone(), places.clone()];
        LabelledArray::from_fn(name, meaning, axes, |i, j, k| all[k][(i, j)])
    };
    let columns = state_axis("state_2", &coordinates);
    vec![
        LabelledArray::from_fn(
            "azimuths",
            "azimuths of the pages of A, B, C and D, and the weight of each in a mean over the revolution",
            vec![grid, places.clone()],
            |i, j, _| if i == 0 { space.azimuths_rad[j] } else { space.weights[j] },
        ),
        of(
            "A",
            "of one blade: unit of the row per rad and per unit of the column",
            &states,
            &columns,
            &space.a,
        ),
        of(
            "B",
            "of one blade: unit of the row per rad and per unit of the column",
            &states,
            &inputs,
            &space.b,
        ),
        of(
            "C",
            "of one blade: unit of the row per unit of the column",
            &hub_axis(),
            &columns,
            &space.c,
        ),
        of(
            "D",
            "of one blade: unit of the row per unit of the column",
            &hub_axis(),
            &inputs,
            &space.d,
        ),
    ]
}

/// Matrices of all blades.
fn multiblade(space: &BladeStateSpace) -> Vec<LabelledArray> {
    let found = space.multiblade();
    let names: Vec<String> = found
        .coordinates
        .iter()
        .map(|own| match own {
            BladesTogether::Collective => "collective_".to_owned(),
            BladesTogether::Cosine(n) => format!("cos{n}_"),
            BladesTogether::Sine(n) => format!("sin{n}_"),
            BladesTogether::Differential => "differential_".to_owned(),
        })
        .collect();
    let coordinates: Vec<String> = names
        .iter()
        .flat_map(|prefix| modes(space).into_iter().map(move |mode| format!("{prefix}{mode}")))
        .collect();
    let (states, columns) =
        (state_axis("state", &coordinates), state_axis("state_2", &coordinates));
    let (labels, units): (Vec<Vec<String>>, Vec<Vec<String>>) =
        names.iter().map(|prefix| flap_inputs(space.flaps, prefix)).unzip();
    let inputs = Axis { name: "input".to_owned(), labels: labels.concat(), units: units.concat() };
    let of = |name: &str, meaning: &str, rows: &Axis, columns: &Axis, matrix: &DMatrix<f64>| {
        let axes = vec![rows.clone(), columns.clone()];
        LabelledArray::from_fn(name, meaning, axes, |i, j, _| matrix[(i, j)])
    };
    vec![
        of(
            "A_multiblade",
            "of all blades, constant: unit of the row per rad and per unit of the column",
            &states,
            &columns,
            &found.a,
        ),
        of(
            "B_multiblade",
            "of all blades, constant: unit of the row per rad and per unit of the column",
            &states,
            &inputs,
            &found.b,
        ),
        of(
            "C_multiblade",
            "of all blades, constant: unit of the row per unit of the column",
            &hub_axis(),
            &columns,
            &found.c,
        ),
        of(
            "D_multiblade",
            "of all blades, constant: unit of the row per unit of the column",
            &hub_axis(),
            &inputs,
            &found.d,
        ),
    ]
}
