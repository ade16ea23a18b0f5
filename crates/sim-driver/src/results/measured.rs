//! Computed curves as they are stored, alone and beside measured ones.

use super::SeriesLine;
use crate::case::MeasuredRotor;
use rotor_study::{
    ComputedCurve, LISTED_HARMONICS, MeasuredCurve, Quantity, VortexComparison, series_of,
};
use serde::{Deserialize, Serialize};

/// Mean and harmonics of a computed curve, 1 to [`LISTED_HARMONICS`] per rev.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveLine {
    /// What it is.
    pub quantity: Quantity,
    /// Station of the section, R; none of the tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub station_r: Option<f64>,
    /// Mean, then cosine and sine of every harmonic, in the unit of the quantity.
    pub series: SeriesLine,
}

impl CurveLine {
    /// Of a computed curve.
    pub fn of(curve: &ComputedCurve) -> Self {
        let ComputedCurve { quantity, station_r, ref values } = *curve;
        Self { quantity, station_r, series: SeriesLine(series_of(values, LISTED_HARMONICS)) }
    }
}

/// A measured curve and the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredLine {
    /// What was measured.
    #[serde(flatten)]
    pub curve: MeasuredCurve,
    /// Computed values at equal azimuths from 0, in the unit of the quantity.
    pub computed: Vec<f64>,
}

/// What was measured beside what was computed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MeasuredPart {
    /// Airloads and tip motions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<MeasuredLine>,
    /// Centres of tip vortices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vortices: Option<VortexComparison>,
}

impl MeasuredPart {
    /// Every measured curve with the computed one of its quantity and station, and the vortices; nothing of a case
    /// without measured data.
    pub fn of(
        measured: &MeasuredRotor,
        computed: &[ComputedCurve],
        vortices: Option<VortexComparison>,
    ) -> Option<Self> {
        let curves = measured.curves.iter().filter_map(|curve| {
            let own = computed.iter().find(|own| {
                own.quantity == curve.quantity && same_station(own.station_r, curve.station_r)
            })?;
            Some(MeasuredLine { curve: curve.clone(), computed: own.values.clone() })
        });
        Some(Self { curves: curves.collect(), vortices }).filter(|part| *part != Self::default())
    }
}

/// Whether two stations (R) are one; the tip is none.
pub(crate) fn same_station(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-9,
        (None, None) => true,
        _ => false,
    }
}

/// Name of a curve for people: quantity and place.
pub(crate) fn curve_name(quantity: Quantity, station_r: Option<f64>) -> String {
    let place = station_r.map_or_else(|| "tip".to_owned(), |station| format!("{station} R"));
    format!("{} at {place}", quantity.name())
}
