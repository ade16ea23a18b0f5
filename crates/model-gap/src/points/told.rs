//! What was found at points of test in the form other programs read.

use super::finding::{ChannelGain, PointFinding};
use super::next::NextPoints;
use super::shown::Reading;
use super::table::PointTable;
use crate::findings::{ChannelGainValue, Findings, Told};
use std::collections::BTreeMap;
use std::fmt::Write;

impl PointFinding {
    /// The findings of a table.
    pub fn findings(&self, table: &PointTable, data_kind: &'static str) -> Findings {
        let runs: Vec<String> = self.measured.iter().map(|&p| table.points[p].id.clone()).collect();
        let told = Told {
            finding: &self.finding,
            candidates: &self.candidates,
            runs: &runs,
            data_kind,
            gain_unit: "standard deviations".to_owned(),
            next_experiment: self.next.as_ref().map(|own| own.in_words(table)).unwrap_or_default(),
        };
        let gain = |own: &ChannelGain| ChannelGainValue {
            channel: table.channels[own.channel].name.clone(),
            unit: table.channels[own.channel].unit.clone(),
            heldout_rms_before: own.rms_before,
            heldout_rms_after: own.rms_after,
            in_deviations: own.in_deviations,
        };
        Findings {
            would_have_shown: self.limits(table),
            gain_by_channel: self.gains.iter().map(gain).collect(),
            ..told.findings()
        }
    }

    /// Value of the first parameter of each suspect from which on it would have been seen; of several of one name that which
    /// is seen first.
    fn limits(&self, table: &PointTable) -> BTreeMap<String, Option<f64>> {
        let mut best: BTreeMap<String, (f64, Option<f64>)> = BTreeMap::new();
        for (own, limit) in table.suspects.iter().zip(&self.finding.limits) {
            let first = own.parameters.first().zip(*limit);
            let value = first.and_then(|(p, limit)| {
                let amount = p.tables.first()?.0;
                Some(p.shown.of(p.none + limit * (amount - p.none)))
            });
            let limit = limit.unwrap_or(f64::INFINITY);
            let kept = best.entry(own.name.to_owned()).or_insert((f64::INFINITY, None));
            if limit < kept.0 {
                *kept = (limit, value);
            }
        }
        best.into_iter().map(|(name, (_, value))| (name, value)).collect()
    }

    /// One row for each reading: measured, simulated, deviation, and measured less simulated before and after over it, what
    /// is known of the errors taken off.
    pub fn residuals_csv(&self, table: &PointTable) -> String {
        let mut text =
            String::from("point,channel,measured,simulated,sd,residual_sd,residual_after_sd\n");
        for own in &self.readings {
            let (id, name) = (&table.points[own.point].id, &table.channels[own.channel].name);
            let Reading { measured, deviation, simulated: [simulated, _], .. } = own;
            let [before, after] = own.residual;
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{id},{name},{measured},{simulated},{deviation},{before:.4},{after:.4}"
            );
        }
        text
    }
}

impl NextPoints {
    /// The points by name.
    pub fn in_words(&self, table: &PointTable) -> String {
        let name = |&p: &usize| {
            let point = &table.points[p];
            let again = if point.is_measured() { " again" } else { "" };
            format!("point {}{again}", point.id)
        };
        self.points.iter().map(name).collect::<Vec<_>>().join(", ")
    }
}
