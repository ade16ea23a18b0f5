//! Aerofoil tables in the C81 format: lift, drag and moment against incidence and Mach number.

mod read;
mod table;
mod write;

pub use table::C81Table;

use crate::AeroError;

/// The three tables of an aerofoil.
///
/// Lift and drag along and normal to the stream, moment about the quarter chord nose-up; incidence in
/// degrees in the file, usually -180 to 180.
///
/// The format, by columns:
///
/// ```text
/// name, and the numbers of Mach numbers and incidences of the lift, drag and moment table   A30, 6I2
/// Mach numbers                          7X, 9F7.0, continued on lines of the same form
/// incidence and one value per Mach      10F7.0, continued on lines 7X, 9F7.0
/// ```
/// Fields are seven columns wide and may touch (`-0.123-0.4567`): they are cut by column. Files that
/// separate by blanks instead are read too, row by row, by counting.
///
/// Source: the format note in the documentation of `MBDyn` (Politecnico di Milano); blank-separated
/// files as the Python package c81utils writes them.
#[derive(Debug, Clone, PartialEq)]
pub struct C81Airfoil {
    /// Name, at most 30 characters in a file.
    pub name: String,
    /// Lift coefficient.
    pub lift: C81Table,
    /// Drag coefficient.
    pub drag: C81Table,
    /// Moment coefficient about the quarter chord.
    pub moment: C81Table,
}

/// Steady coefficients of a section, or their slopes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SteadyCoefficients {
    /// Lift, normal to the stream.
    pub lift: f64,
    /// Drag, along the stream.
    pub drag: f64,
    /// Moment about the quarter chord, nose-up +.
    pub moment: f64,
}

/// Steady coefficients with their slopes, for linearisation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SteadyPoint {
    /// The coefficients.
    pub value: SteadyCoefficients,
    /// Per rad of incidence.
    pub per_incidence: SteadyCoefficients,
    /// Per unit of Mach number.
    pub per_mach: SteadyCoefficients,
}

impl C81Airfoil {
    /// Reads a file's text.
    ///
    /// # Errors
    /// [`AeroError::C81Text`] with line and column of the first thing that is not understood, of a Mach
    /// number or incidence that is not above the one before it, of a negative Mach number.
    pub fn read(text: &str) -> Result<Self, AeroError> {
        read::airfoil(text)
    }

    /// The file's text, by columns. What [`C81Airfoil::read`] makes of it is this aerofoil, exactly.
    ///
    /// # Errors
    /// [`AeroError::C81NotWritable`] for a number that seven columns cannot hold, or for more than 99
    /// Mach numbers or incidences in a table; round it first with
    /// [`rounded`](Self::rounded), or thin it out.
    pub fn write(&self) -> Result<String, AeroError> {
        write::airfoil(self)
    }

    /// The aerofoil with every number rounded to what seven columns hold, and the name to 30
    /// characters.
    #[must_use]
    pub fn rounded(&self) -> Self {
        write::rounded(self)
    }

    /// The first negative drag of the table: incidence in degrees, Mach number, drag coefficient.
    ///
    /// No section has one in steady flow, but tables do, by interpolation or slips of the pen; such a table
    /// is read, because where it is wrong may not matter, and whoever uses it is to be told.
    pub fn negative_drag(&self) -> Option<[f64; 3]> {
        self.drag.incidences_deg().iter().enumerate().find_map(|(i, incidence)| {
            let mut pairs = self.drag.machs().iter().zip(self.drag.row(i));
            let (mach, drag) = pairs.find(|(_, drag)| **drag < 0.0)?;
            Some([*incidence, *mach, *drag])
        })
    }

    /// Coefficients and slopes at an incidence (rad, any turn of it) and Mach number, by linear
    /// interpolation in both; beyond a table's ends its end values.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `incidence_rad` | `alpha` | rad | any; taken to -180 to 180 deg |
    /// | `mach` | `M` | - | 0 and up; its absolute value is used |
    pub fn at(&self, incidence_rad: f64, mach: f64) -> SteadyPoint {
        let degrees = crate::airfoil::c81::table::wrapped_degrees(incidence_rad);
        let tables =
            [&self.lift, &self.drag, &self.moment].map(|table| table.at(degrees, mach.abs()));
        let part = |k: usize, scale: f64| {
            let [lift, drag, moment] = tables.map(|table| scale * table[k]);
            SteadyCoefficients { lift, drag, moment }
        };
        let per_incidence = part(1, 1.0_f64.to_radians().recip());
        SteadyPoint { value: part(0, 1.0), per_incidence, per_mach: part(2, 1.0) }
    }
}

/// Aerofoils along a blade, blended linearly between their stations.
#[derive(Debug, Clone, PartialEq)]
pub struct AirfoilSpan {
    stations: Vec<(f64, C81Airfoil)>,
}

impl AirfoilSpan {
    /// Aerofoils at ascending stations (any unit: R, m).
    ///
    /// # Errors
    /// [`AeroError::C81Order`] unless there is one station or more and they ascend strictly.
    pub fn new(stations: Vec<(f64, C81Airfoil)>) -> Result<Self, AeroError> {
        let places: Vec<f64> = stations.iter().map(|(r, _)| *r).collect();
        table::ascending("spanwise stations", &places)?;
        Ok(Self { stations })
    }

    /// Coefficients and slopes at a station: between two aerofoils the mean of what both give at this
    /// incidence and Mach number, weighted by the distance; beyond the ends those of the end.
    pub fn at(&self, station: f64, incidence_rad: f64, mach: f64) -> SteadyPoint {
        let after = self.stations.partition_point(|(r, _)| *r <= station);
        let evaluate = |i: usize| self.stations[i].1.at(incidence_rad, mach);
        if after == 0 {
            return evaluate(0);
        }
        if after == self.stations.len() {
            return evaluate(after - 1);
        }
        let (near, far) = (self.stations[after - 1].0, self.stations[after].0);
        let share = (station - near) / (far - near);
        evaluate(after - 1).blended(&evaluate(after), share)
    }
}

impl SteadyCoefficients {
    /// `(1 - share) self + share other`.
    #[must_use]
    pub fn blended(&self, other: &Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + share * (b - a);
        Self {
            lift: mix(self.lift, other.lift),
            drag: mix(self.drag, other.drag),
            moment: mix(self.moment, other.moment),
        }
    }
}

impl SteadyPoint {
    /// `(1 - share) self + share other`, slopes included.
    #[must_use]
    pub fn blended(&self, other: &Self, share: f64) -> Self {
        Self {
            value: self.value.blended(&other.value, share),
            per_incidence: self.per_incidence.blended(&other.per_incidence, share),
            per_mach: self.per_mach.blended(&other.per_mach, share),
        }
    }
}
