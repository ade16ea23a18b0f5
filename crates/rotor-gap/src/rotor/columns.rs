//! What the columns of a sweep mean.

use measured_data::PointData;
use measured_data::problem::{Fault, Problems};

/// A column of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Column {
    /// It sets the condition of a point.
    Sets(Setting),
    /// It was read.
    Reads(Reading),
}

/// What sets the condition of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// Advance ratio.
    AdvanceRatio,
    /// Thrust over solidity.
    CtSigma,
    /// Thrust, N.
    ThrustNewton,
    /// Shaft tilt, forward positive, deg.
    ShaftTiltDeg,
    /// Rotor speed, rpm.
    OmegaRpm,
    /// Air density, kg/m^3.
    AirDensity,
    /// Voltage of a flap, V.
    FlapVolt {
        /// The flap, from 0, root to tip.
        flap: usize,
        /// Harmonic.
        harmonic: usize,
        /// Cosine or sine.
        part: PartOf,
    },
    /// Pitch at the root of every blade, deg.
    RootPitchDeg {
        /// Harmonic.
        harmonic: usize,
        /// Cosine or sine.
        part: PartOf,
    },
}

/// Part of a harmonic series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartOf {
    /// The mean.
    Mean,
    /// The cosine of a harmonic.
    Cosine,
    /// Its sine.
    Sine,
}

/// What was read at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// A pitch control, deg: collective, lateral, longitudinal.
    ControlDeg(usize),
    /// Power of the shaft, W.
    PowerWatt,
    /// A load or motion of a harmonic.
    Harmonic {
        /// Of what.
        of: Load,
        /// Harmonic, 0 of the mean.
        harmonic: usize,
        /// Its part.
        part: PartOf,
    },
}

/// What a harmonic is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// A hub load in the fixed frame, order `fx fy fz mx my mz`, N and N m.
    Hub(usize),
    /// Motion of a flap, from 0, deg.
    FlapDeg(usize),
    /// Moment of a blade: flap, lag or torsion, N m, against the azimuth of that blade.
    Moment {
        /// Flap, lag, torsion.
        axis: usize,
        /// Station, R.
        station_r: f64,
    },
    /// `C_n M^2` or `C_m M^2` of a section.
    Airload {
        /// Whether it is the moment.
        is_moment: bool,
        /// Station, R.
        station_r: f64,
    },
    /// Elastic twist of the tip, deg.
    TipTwistDeg,
    /// Flap of the tip, R.
    TipFlap,
}

/// What a column may be, for messages.
const KNOWN: &str = "advance_ratio, ct_sigma, thrust_N, shaft_tilt_deg, omega_rpm, air_density_kg_m3, theta0_deg, theta1c_deg, \
     theta1s_deg, power_W, fx_n4_cos_N to mz_n4_sin_Nm (fz_n0_N), flap1_n3_cos_V, flap1_n3_cos_deg, root_pitch_n3_cos_deg, \
     b1_flap_moment_r0p25_n3_cos_Nm, cn_m2_r0p87_n3_cos, cm_m2_r0p87_n3_cos, tip_twist_n2_sin_deg, tip_flap_n1_cos_r";
const HUB: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];
const AXES: [&str; 3] = ["flap", "lag", "torsion"];
/// Highest harmonic of a column.
const HIGHEST: usize = 12;

impl Column {
    /// What a name means.
    ///
    /// # Errors
    /// What was expected instead, in words.
    pub fn parse(name: &str) -> Result<Self, String> {
        use Setting::{AdvanceRatio, AirDensity, CtSigma, OmegaRpm, ShaftTiltDeg, ThrustNewton};
        Ok(match name {
            "advance_ratio" => Self::Sets(AdvanceRatio),
            "ct_sigma" => Self::Sets(CtSigma),
            "thrust_N" => Self::Sets(ThrustNewton),
            "shaft_tilt_deg" => Self::Sets(ShaftTiltDeg),
            "omega_rpm" => Self::Sets(OmegaRpm),
            "air_density_kg_m3" => Self::Sets(AirDensity),
            "theta0_deg" => Self::Reads(Reading::ControlDeg(0)),
            "theta1c_deg" => Self::Reads(Reading::ControlDeg(1)),
            "theta1s_deg" => Self::Reads(Reading::ControlDeg(2)),
            "power_W" => Self::Reads(Reading::PowerWatt),
            _ => Self::harmonic(name).ok_or_else(|| format!("expected one of: {KNOWN}"))?,
        })
    }

    /// A column of a harmonic: `WHAT_nK_cos_UNIT`, of the mean `WHAT_n0_UNIT`.
    fn harmonic(name: &str) -> Option<Self> {
        let (what, rest) = name.rsplit_once("_n")?;
        let mut rest = rest.split('_');
        let harmonic: usize = rest.next()?.parse().ok().filter(|n| *n <= HIGHEST)?;
        let part = match harmonic {
            0 => PartOf::Mean,
            _ => match rest.next()? {
                "cos" => PartOf::Cosine,
                "sin" => PartOf::Sine,
                _ => return None,
            },
        };
        let unit = rest.next().unwrap_or_default();
        if rest.next().is_some() {
            return None;
        }
        let reads = |of| Some(Self::Reads(Reading::Harmonic { of, harmonic, part }));
        if let Some(k) = HUB.iter().position(|own| *own == what) {
            return (unit == if k < 3 { "N" } else { "Nm" }).then(|| reads(Load::Hub(k)))?;
        }
        let station = |text: &str| text.strip_prefix('r')?.replace('p', ".").parse::<f64>().ok();
        match (what, unit) {
            ("root_pitch", "deg") if harmonic > 1 => {
                return Some(Self::Sets(Setting::RootPitchDeg { harmonic, part }));
            }
            ("tip_twist", "deg") => return reads(Load::TipTwistDeg),
            ("tip_flap", "r") => return reads(Load::TipFlap),
            _ => {}
        }
        if let Some(flap) = what.strip_prefix("flap") {
            let flap = flap.parse::<usize>().ok()?.checked_sub(1)?;
            return match unit {
                "V" if harmonic > 0 => Some(Self::Sets(Setting::FlapVolt { flap, harmonic, part })),
                "deg" => reads(Load::FlapDeg(flap)),
                _ => None,
            };
        }
        for (is_moment, begin) in [(false, "cn_m2_"), (true, "cm_m2_")] {
            if let Some(at) = what.strip_prefix(begin) {
                let station_r = station(at).filter(|_| unit.is_empty())?;
                return reads(Load::Airload { is_moment, station_r });
            }
        }
        // b1_flap_moment_r0p25
        let mut parts = what.strip_prefix('b')?.split('_');
        parts.next()?.parse::<usize>().ok()?;
        let axis = parts.next()?;
        let axis = AXES.iter().position(|own| *own == axis)?;
        let is_moment = parts.next() == Some("moment") && unit == "Nm";
        let station_r = station(parts.next()?).filter(|_| is_moment)?;
        reads(Load::Moment { axis, station_r })
    }
}

/// Checks the names of the columns of a table of points.
///
/// # Errors
/// Every name that says nothing, at its place in the header.
pub fn check_columns(data: &PointData) -> Result<(), Problems> {
    let mut problems = Problems::default();
    for own in &data.columns {
        if let Err(reason) = Column::parse(&own.name) {
            let message = format!("the column `{}` is not known: {reason}", own.name);
            problems.push(data.table.column_place(&own.name), Fault::Refused { message });
        }
    }
    problems.into_result(Some(()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_what_they_say() {
        let reads =
            |of, harmonic, part| Ok(Column::Reads(Reading::Harmonic { of, harmonic, part }));
        assert_eq!(Column::parse("fx_n4_cos_N"), reads(Load::Hub(0), 4, PartOf::Cosine));
        assert_eq!(Column::parse("mz_n12_sin_Nm"), reads(Load::Hub(5), 12, PartOf::Sine));
        assert_eq!(Column::parse("fz_n0_N"), reads(Load::Hub(2), 0, PartOf::Mean));
        assert_eq!(Column::parse("flap2_n3_sin_deg"), reads(Load::FlapDeg(1), 3, PartOf::Sine));
        let moment = Load::Moment { axis: 0, station_r: 0.25 };
        assert_eq!(
            Column::parse("b1_flap_moment_r0p25_n3_cos_Nm"),
            reads(moment, 3, PartOf::Cosine)
        );
        let airload = Load::Airload { is_moment: true, station_r: 0.87 };
        assert_eq!(Column::parse("cm_m2_r0p87_n3_cos"), reads(airload, 3, PartOf::Cosine));
        assert_eq!(Column::parse("tip_flap_n1_cos_r"), reads(Load::TipFlap, 1, PartOf::Cosine));
        let volt = Setting::FlapVolt { flap: 0, harmonic: 3, part: PartOf::Cosine };
        assert_eq!(Column::parse("flap1_n3_cos_V"), Ok(Column::Sets(volt)));
        for bad in [
            "fx_n4_cos",
            "fx_n4_cos_Nm",
            "fx_n13_cos_N",
            "flap0_n3_cos_V",
            "fz_n0_cos_N",
            "mu",
            "fx_n4_N",
        ] {
            assert!(Column::parse(bad).unwrap_err().contains("advance_ratio"), "{bad}");
        }
    }
}
