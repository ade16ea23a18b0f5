//! Benches of plays that tests identify.

use measured_data::{Accuracy, BenchData, MeasuredTable, Run, RunFile};
use model_gap::SplitMix;
use preisach_dyn::identify::RecordUse;
use std::f64::consts::TAU;

/// Slow sines around 70 V, three cycles each, of an actuator of plays with 1 um/V at most.
pub(crate) struct PlaysBench<'a> {
    /// Amplitude of each run, V, and its side of the split.
    pub(crate) runs: &'a [(f64, RecordUse)],
    /// Half-widths of plays that weigh alike, V.
    pub(crate) half_widths_volt: &'a [f64],
    /// Whether the runs are cycles after a rise from 0 V, not from rest at their middle.
    pub(crate) after_zero: bool,
    /// Standard deviation of the noise, um.
    pub(crate) noise_um: f64,
}

impl PlaysBench<'_> {
    pub(crate) fn data(&self) -> BenchData {
        let mut noise = SplitMix(3);
        let share = 1.0 / self.half_widths_volt.len() as f64;
        let mut run = |&(volt, use_as): &(f64, RecordUse)| {
            let time_step_s = 0.01;
            let input: Vec<f64> =
                (0..1500).map(|i| 70.0 + volt * (TAU * f64::from(i) / 500.0).sin()).collect();
            let first = if self.after_zero { 0.0_f64 } else { 70.0 };
            let mut plays = vec![first; self.half_widths_volt.len()];
            let mut at = |u: &f64| {
                let mut y = *u;
                for (play, half_width) in plays.iter_mut().zip(self.half_widths_volt) {
                    *play = play.min(u + half_width).max(u - half_width);
                    y += share * *play;
                }
                y
            };
            if self.after_zero {
                for u in &input[..500] {
                    at(u);
                }
            }
            let output = input.iter().map(|u| at(u) + self.noise_um * noise.normal()).collect();
            let time_s = (0..1500).map(|i| time_step_s * f64::from(i)).collect();
            let (id, use_as) = (format!("{volt} V"), Some(use_as));
            let table = MeasuredTable { time_s, time_step_s, input, output, ..Default::default() };
            Run { entry: RunFile { id, use_as, ..RunFile::default() }, table }
        };
        BenchData {
            title: String::new(),
            folder: "bench".into(),
            runs: self.runs.iter().map(&mut run).collect(),
            flap_deg_per_um: Some(0.04),
            command_range_volt: (20.0, 120.0),
            accuracy: Accuracy::default(),
            warnings: vec![],
            content_hash: String::new(),
        }
    }
}
