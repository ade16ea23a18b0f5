//! scratch
#![allow(
    clippy::all,
    clippy::pedantic,
    clippy::disallowed_methods,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs
)]
use preisach_dyn::identify::*;
use preisach_dyn::*;
fn load() -> Vec<BenchRecord> {
    let dir = "/work/main/fixtures/bench/apa500l_synthetic";
    let ron = std::fs::read_to_string(format!("{dir}/dataset.ron")).unwrap();
    ron.lines()
        .filter_map(|l| l.split("file: \"").nth(1))
        .map(|r| r.split('"').next().unwrap().to_string())
        .map(|f| {
            let text = std::fs::read_to_string(format!("{dir}/{f}")).unwrap();
            let rows: Vec<Vec<f64>> = text
                .lines()
                .skip(1)
                .map(|l| l.split(',').map(|v| v.parse().unwrap()).collect())
                .collect();
            BenchRecord {
                id: f.replace(".csv", ""),
                time_step_s: (rows.last().unwrap()[0] - rows[0][0]) / (rows.len() - 1) as f64,
                voltage_volt: rows.iter().map(|r| r[1]).collect(),
                output_deg: rows.iter().map(|r| r[2] * 0.039537815).collect(),
                record_use: None,
                base_frequency_hz: None,
            }
        })
        .collect()
}
fn arg(name: &str) -> Option<f64> {
    std::env::args().find_map(|a| {
        a.strip_prefix(&format!("{name}="))
            .map(|v| v.parse().unwrap())
    })
}
fn main() {
    let records = load();
    let mut s = Settings {
        deg_per_um: 0.039537815,
        ..Settings::default()
    };
    if let Some(v) = arg("levels") {
        s.levels = v as usize;
    }
    if let Some(v) = arg("rate") {
        s.rate_levels = v as usize;
    }
    if let Some(v) = arg("ss") {
        s.static_smoothness = v;
    }
    if let Some(v) = arg("rs") {
        s.rate_smoothness = RateSmoothness::Fixed(v);
    }
    if let Some(v) = arg("rounds") {
        s.rounds = v as usize;
    }
    if let Some(v) = arg("pat") {
        s.refinement_patience = v as usize;
    }
    if arg("lit").is_some() {
        s.form = RateForm::Literal;
    }
    if arg("cv").is_some() {
        let fast = [
            "sine_1hz_85v",
            "sine_1hz_25v",
            "sine_10hz_85v",
            "sine_10hz_25v",
        ];
        for rate in [2usize, 4, 6, 8, 12] {
            for rs in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
                let mut out = vec![];
                for left in fast {
                    let recs: Vec<BenchRecord> = records
                        .iter()
                        .filter(|r| {
                            fast.contains(&r.id.as_str())
                                || !r.id.starts_with("sine") && !r.id.starts_with("mix")
                        })
                        .cloned()
                        .map(|mut r| {
                            r.record_use = Some(if r.id == left {
                                RecordUse::HeldOut
                            } else {
                                RecordUse::Train
                            });
                            r
                        })
                        .collect();
                    let id = identify(
                        &recs,
                        &Settings {
                            rate_levels: rate,
                            rate_smoothness: RateSmoothness::Fixed(rs),
                            refinement_patience: 0,
                            rounds: 2,
                            ..s.clone()
                        },
                    )
                    .unwrap();
                    out.push(
                        id.records_of(RecordUse::HeldOut)
                            .next()
                            .unwrap()
                            .dynamic
                            .nrmse_percent(),
                    );
                }
                println!(
                    "rate {rate} rs {rs:e} {:.2?} rms {:.3}",
                    out,
                    (out.iter().map(|v| v * v).sum::<f64>() / 4.0).sqrt()
                );
            }
        }
        return;
    }
    let t = std::time::Instant::now();
    let id = identify(&records, &s).unwrap();
    println!("{:?}", id.validation);
    println!(
        "time {:?}  refinement {:?} zero {}",
        t.elapsed(),
        id.refinement,
        id.zero_deg
    );
    for r in &id.records {
        println!(
            "{:20} {:?} {:?} {:6.2} Hz x{} {:5.1} V steady {:?} noise {:.4} | lin {:6.2} stat {:6.2} dyn {:5.2}% amp {:6.2} ph {:6.2} {:?}",
            r.id,
            r.record_use,
            r.drive.waveform,
            r.drive.base_hz,
            r.drive.strongest_harmonic,
            r.drive.amplitude_volt,
            r.drive.steady,
            r.noise_deg.unwrap_or(0.0),
            r.linear.nrmse_percent(),
            r.static_only.nrmse_percent(),
            r.dynamic.nrmse_percent(),
            r.dynamic.amplitude_error_percent.unwrap_or(0.0),
            r.dynamic.phase_error_deg.unwrap_or(0.0),
            r.dynamic.counts
        );
    }
    if let ActuatorLaw::DynamicPreisach(m) = &id.dynamic.law {
        let p = m.parameters();
        println!(
            "tau0 {} g2c {} D {} maxG1 {} minG1 {}",
            -p.g1_s.constant,
            p.g2_s2_per_deg.constant,
            p.unfolded_rate_deg_s,
            p.g1_s.largest().0,
            -p.g1_s.combined(-1.0, &p.g1_s, 0.0).largest().0
        );
    }
}
