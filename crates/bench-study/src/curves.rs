//! `hhc identify` of reversal curves: a measured family of first-order reversal curves in, a static
//! model out.

use crate::BenchError;
use crate::diagram::diagram;
use crate::drift::{DriftKind, without_drift};
use crate::figures::{density_csv, diagram_csv};
use crate::identification::dataset_place;
use crate::reversals::ForcDiagram;
use crate::stored::{StoredActuator, StoredChannels, StoredKind};
use measured_data::{Channel, Channels, CurveData};
use preisach_dyn::forc::{
    CalibrationPoint, ForcCurve, ForcData, ForcFit, ForcSettings, fit, held_out,
};
use preisach_dyn::identify::Settings;
use preisach_dyn::{ActuatorLaw, ActuatorModel, Calibration, StaticPreisach};
use report_page::{Sheet, table};
use serde::Serialize;

/// Every so many curves one is held out to judge the fit; the stored model is fitted to all.
const HELD_OUT_EVERY: usize = 4;
/// Calibration readings on either side in the moving average of the drift.
const DRIFT_HALF_WINDOW: usize = 4;
/// Smoothing factor of the FORC diagram.
const SMOOTHING_FACTOR: usize = 3;

/// A static model from reversal curves, with the data it came from.
#[derive(Debug, Clone)]
pub struct CurveIdentification {
    content_hash: String,
    channels: Channels,
    data: ForcData,
    fit: ForcFit,
    result: CurvesResult,
}

/// Identifies a static model from a data set of reversal curves: drift taken off by the calibration
/// readings, density by constrained least squares, every fourth curve held out once to judge it.
///
/// # Errors
/// [`BenchError::Actuator`] at the place of the data set.
pub fn identify_curves(data: &CurveData) -> Result<CurveIdentification, BenchError> {
    let fail = |source| BenchError::Actuator { place: dataset_place(&data.folder), source };
    let all: Vec<_> = data.runs.iter().flat_map(|run| &run.curves).collect();
    let readings: Vec<CalibrationPoint> = all
        .iter()
        .filter_map(|c| c.calibration)
        .map(|(input, output)| CalibrationPoint { input, output })
        .collect();
    let curves = all
        .iter()
        .map(|c| ForcCurve { input: c.input.clone(), output: c.output.clone() })
        .collect();
    // a reading before each curve, or none: a few of them tell no drift
    let drift_corrected = readings.len() == all.len() && !readings.is_empty();
    let calibration = if drift_corrected { readings } else { vec![] };
    let measured = ForcData { curves, calibration };
    let corrected = without_drift(&measured, DriftKind::Gain, DRIFT_HALF_WINDOW).map_err(fail)?;
    let settings = ForcSettings::default();
    let held_out = held_out(&corrected, &settings, HELD_OUT_EVERY, 1).map_err(fail)?;
    let fit = fit(&corrected, &settings).map_err(fail)?;
    let [input, output] = data.channels.both().map(Channel::label);
    let result = CurvesResult {
        title: data.title.clone(),
        dataset: data.folder.clone(),
        input,
        output,
        drift_corrected,
        curves: corrected.curves.len(),
        fitted_worst_percent: fit.curves.iter().map(|c| c.rms_percent).fold(0.0, f64::max),
        held_out_curves: held_out.curves.len(),
        held_out_rms_percent: held_out.rms_percent,
        held_out_worst_percent: held_out.worst_curve_percent,
        written_to: None,
        page_written_to: None,
    };
    let (content_hash, channels) = (data.content_hash.clone(), data.channels.clone());
    Ok(CurveIdentification { content_hash, channels, data: corrected, fit, result })
}

impl CurveIdentification {
    /// The model file of this identification.
    pub fn stored(&self) -> StoredActuator {
        let CurvesResult { title, dataset, input, output, .. } = &self.result;
        let channels = StoredChannels { input: input.clone(), output: output.clone() };
        let range = self.fit.model.grid().range();
        let law = ActuatorLaw::StaticPreisach(self.fit.model.clone());
        let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
        StoredActuator {
            kind: StoredKind::Actuator,
            title: title.clone(),
            dataset: dataset.clone(),
            data_hash: self.content_hash.clone(),
            program_version: crate::VERSION.to_owned(),
            channels: Some(channels),
            gain: None,
            settings: Settings::default(),
            runs: vec![],
            model: ActuatorModel::new(law, range, calibration),
        }
    }

    /// Names and texts of the figures' tables: FORC diagram, density, curves against the model.
    ///
    /// # Errors
    /// [`BenchError::Actuator`] if the family is too small for a diagram.
    pub fn figure_files(&self) -> Result<Vec<(String, String)>, BenchError> {
        let points = self.diagram()?.points;
        let (input, unit) = (&self.result.input, format!("_{}", self.units()[1]));
        let model = self.model();
        Ok(vec![
            ("forc_diagram.csv".to_owned(), diagram_csv(&points, input)),
            ("density.csv".to_owned(), density_csv(model.grid(), model.map(), input, &unit)),
        ])
    }

    /// The FORC diagram.
    ///
    /// # Errors
    /// [`BenchError::Actuator`] if the family is too small for one.
    pub(crate) fn diagram(&self) -> Result<ForcDiagram, BenchError> {
        let place = || dataset_place(&self.result.dataset);
        let points = diagram(&self.data, SMOOTHING_FACTOR)
            .map_err(|source| BenchError::Actuator { place: place(), source })?;
        let (curves, smoothing) = (self.data.curves.len(), SMOOTHING_FACTOR);
        Ok(ForcDiagram { id: self.result.title.clone(), curves, smoothing, points })
    }

    /// Symbols of the units of input and output.
    pub(crate) fn units(&self) -> [&str; 2] {
        self.channels.both().map(|channel| channel.unit.symbol)
    }

    /// The curves, drift taken off.
    pub(crate) fn data(&self) -> &ForcData {
        &self.data
    }

    /// The model.
    pub(crate) fn model(&self) -> &StaticPreisach {
        &self.fit.model
    }

    /// What `hhc identify` prints.
    pub fn summary(&self, written_to: Option<String>) -> CurvesResult {
        CurvesResult { written_to, ..self.result.clone() }
    }
}

/// What `hhc identify` prints of reversal curves. Errors are root mean squares over the range of all
/// outputs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurvesResult {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub dataset: String,
    /// Input, with its unit.
    pub input: String,
    /// Output, with its unit.
    pub output: String,
    /// Whether drift was taken off by calibration readings.
    pub drift_corrected: bool,
    /// Number of curves.
    pub curves: usize,
    /// Worst curve of the fit to all, percent.
    pub fitted_worst_percent: f64,
    /// Curves held out of the fit that judges.
    pub held_out_curves: usize,
    /// Over all curves held out, percent.
    pub held_out_rms_percent: f64,
    /// Worst curve held out, percent.
    pub held_out_worst_percent: f64,
    /// File the model was written to.
    pub written_to: Option<String>,
    /// Page of pictures beside it.
    pub page_written_to: Option<String>,
}

impl CurvesResult {
    /// What a person wants to see first.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("{}", self.title));
        sheet.line(format_args!("Data   {}: {} against {}", self.dataset, self.output, self.input));
        let drift = if self.drift_corrected {
            "taken off by the calibration readings"
        } else {
            "left as measured: not every curve has a calibration reading"
        };
        sheet.line(format_args!("Drift  {drift}\n"));
        sheet.block(&table(
            &["curves", "number", "rms %", "worst curve %"],
            [
                vec![
                    "all, fitted".to_owned(),
                    self.curves.to_string(),
                    "-".to_owned(),
                    format!("{:.2}", self.fitted_worst_percent),
                ],
                vec![
                    "every fourth, held out".to_owned(),
                    self.held_out_curves.to_string(),
                    format!("{:.2}", self.held_out_rms_percent),
                    format!("{:.2}", self.held_out_worst_percent),
                ],
            ],
        ));
        sheet.line(format_args!(
            "\nPercent of the range of all outputs. Reversal curves are quasi-static: they say nothing about rate."
        ));
        if let Some(path) = &self.written_to {
            sheet.line(format_args!("Model written to {path}"));
        }
        if let Some(path) = &self.page_written_to {
            sheet.line(format_args!("Page written to {path}"));
        }
        sheet.finish()
    }
}
