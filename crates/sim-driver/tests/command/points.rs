//! `hhc diagnose` on points of test: tables of anyone's simulator, and sweeps of a rotor.

use crate::diagnosis_page::{costs_least, page, section, shows_residuals};
use crate::place::Place;
use crate::replace::replaces_its_own_alone;
use std::fmt::Write;

const COLUMNS: [&str; 4] = ["x1_cos_um", "x1_sin_um", "x2_cos_um", "x2_sin_um"];
/// Standard deviations of the columns, um.
const DEVIATION: [f64; 4] = [8.0, 8.0, 4.0, 4.0];

/// What a shaker of two masses may have: springs, dampers and mass of the first over the nominal, delay (s).
#[derive(Clone, Copy)]
struct Shaker {
    spring: f64,
    damper: f64,
    mass: f64,
    delay_s: f64,
}

const NOMINAL: Shaker = Shaker { spring: 1.0, damper: 1.0, mass: 1.0, delay_s: 0.0 };

impl Shaker {
    /// Cosine and sine of both masses under a force of 100 N, um: Cramer's rule on the equations of motion.
    fn at(self, hz: f64) -> [f64; 4] {
        let w = std::f64::consts::TAU * hz;
        let (k1, c1, m1) = (4e4 * self.spring, 20.0 * self.damper, self.mass);
        let a = [k1 - w * w * m1, w * c1];
        let b = [-k1, -w * c1];
        let d = [k1 + 1e5 - 3.0 * w * w, w * (c1 + 40.0)];
        let times =
            |x: [f64; 2], y: [f64; 2]| [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]];
        let (ad, bb) = (times(a, d), times(b, b));
        let det = [ad[0] - bb[0], ad[1] - bb[1]];
        let over = |x: [f64; 2]| {
            let size = det[0] * det[0] + det[1] * det[1];
            let x = times(x, [det[0], -det[1]]);
            // late: turned back by the frequency times the delay
            let late = times(x, [(w * self.delay_s).cos(), -(w * self.delay_s).sin()]);
            late.map(|part| 100.0 * 1e6 * part / size)
        };
        let ([c1, s1], [c2, s2]) = (over([-b[0], -b[1]]), over(a));
        [c1, -s1, c2, -s2]
    }
}

fn frequencies() -> Vec<f64> {
    (0..26).map(|k| 10.0 + 1.5 * f64::from(k)).collect()
}

/// A table of a shaker, with noise and its deviations where it is measured.
fn table(of: Shaker, noise: Option<u64>) -> String {
    let mut text = format!("frequency_Hz,{}", COLUMNS.join(","));
    if noise.is_some() {
        for name in COLUMNS {
            write!(text, ",{name}_sd").unwrap();
        }
    }
    let mut state = noise.unwrap_or_default();
    // sum of twelve uniform numbers less six: variance 1
    let mut normal = || {
        let uniform = |_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(uniform).sum::<f64>() - 6.0
    };
    for hz in frequencies() {
        write!(text, "\n{hz}").unwrap();
        for (value, deviation) in of.at(hz).into_iter().zip(DEVIATION) {
            let off = if noise.is_some() { deviation * normal() } else { 0.0 };
            write!(text, ",{}", value + off).unwrap();
        }
        if noise.is_some() {
            for own in DEVIATION {
                write!(text, ",{own}").unwrap();
            }
        }
    }
    text + "\n"
}

/// A folder of tables; `truth` is measured.
fn folder(truth: Shaker, seed: u64) -> Place {
    let place = Place::new();
    place.write("t/measured.csv", &table(truth, Some(seed)));
    place.write("t/predicted.csv", &table(NOMINAL, None));
    place.write("t/effect_spring.csv", &table(Shaker { spring: 1.03, ..NOMINAL }, None));
    place.write("t/effect_damper.csv", &table(Shaker { damper: 1.3, ..NOMINAL }, None));
    place.write("t/effect_mass.csv", &table(Shaker { mass: 1.03, ..NOMINAL }, None));
    place.write("t/effect_delay.csv", &table(Shaker { delay_s: 2e-4, ..NOMINAL }, None));
    let one = |name: &str, amount: f64, none: f64| {
        format!("(name: \"{name}\", amount: {amount}, none: {none})")
    };
    let effects = [
        one("spring", 1.03, 1.0),
        one("damper", 1.3, 1.0),
        one("mass", 1.03, 1.0),
        one("delay", 2e-4, 0.0),
    ];
    place.write(
        "t/table.ron",
        &format!("(title: \"a shaker <i>\", effects: [{}])", effects.join(", ")),
    );
    place
}

#[test]
fn the_suspect_that_was_planted_is_named_with_its_amount() {
    for (seed, name, truth, planted) in [
        (1, "spring", Shaker { spring: 1.02, ..NOMINAL }, 1.02),
        (2, "damper", Shaker { damper: 1.4, ..NOMINAL }, 1.4),
        (3, "delay", Shaker { delay_s: 3e-4, ..NOMINAL }, 3e-4),
    ] {
        let place = folder(truth, seed);
        let text = place.hhc(&["diagnose", "--table", "t", "-o", "out"]).done();
        assert!(text.starts_with(&format!("Missing (confident): {name}.")), "{text}");
        assert!(text.lines().count() <= 40, "{text}");
        let found: serde_json::Value =
            serde_json::from_str(&place.read("out/findings.json")).unwrap();
        assert_eq!(
            (&found["data_kind"], &found["verdict"]),
            (&"EffectTable".into(), &"named".into())
        );
        let value = &found["parameters"][name]["amount"];
        let [low, high] = [0, 1].map(|end| value["ci95"][end].as_f64().unwrap());
        assert!((low..=high).contains(&planted), "{value}");
        let gains = found["gain_by_channel"].as_array().unwrap();
        assert_eq!((gains.len(), &gains[0]["unit"]), (4, &"um".into()));
        let residuals = place.read("out/residuals.csv");
        assert_eq!(residuals.lines().count(), 1 + 26 * 4);
        let page = page(&place, "out");
        // what is left before and after, as the file says; what was found costs least
        shows_residuals(&page, &residuals, 0, 5);
        shows_residuals(&page, &residuals, 1, 6);
        costs_least(&page, name);
        let own = section(&page, "fingerprints");
        assert!(own.contains(&format!("<strong>{name}</strong><br><span class=\"note\">found")));
        // two harmonics, each a plane; 26 crosses of what is simulated after
        let compared = section(&page, "compared");
        assert_eq!(
            (compared.matches("<figure>").count(), compared.matches("<path").count()),
            (2, 53)
        );
        assert!(section(&page, "parameters").contains(&format!("{name}: amount: ")));
        assert!(
            section(&page, "gain").contains("x1_cos_um") && page.contains("a shaker &lt;i&gt;")
        );
    }
    let place = folder(NOMINAL, 7);
    let args = ["diagnose", "--table", "t", "-o", "out"];
    let text = place.hhc(&args).done();
    replaces_its_own_alone(&place, &args, "out/");
    let page = page(&place, "out");
    assert!(section(&page, "yardstick").contains("an amount that matters"));
    assert!(page.find("yardstick").unwrap() < page.find("\"compared").unwrap(), "it comes first");
    assert!(text.starts_with("Nothing is missing (confident)"), "{text}");
    assert!(text.contains("Would have been seen"), "{text}");
}

#[test]
fn without_deviations_nothing_is_sure_and_faults_name_their_file() {
    let place = folder(Shaker { spring: 1.03, ..NOMINAL }, 4);
    let bare: String = place
        .read("t/measured.csv")
        .lines()
        .map(|line| line.split(',').take(5).collect::<Vec<_>>().join(",") + "\n")
        .collect();
    place.write("t/measured.csv", &bare);
    let text = place.hhc(&["diagnose", "--table", "t"]).done();
    assert!(!text.contains("(confident)"), "{text}");
    let faulty = |name: &str, change: &dyn Fn(String) -> String, words: &[&str]| {
        let place = folder(NOMINAL, 5);
        place.write(name, &change(place.read(name)));
        place.hhc(&["diagnose", "--table", "t"]).rejected(words);
    };
    let cut = |text: String| text.lines().take(20).collect::<Vec<_>>().join("\n") + "\n";
    faulty("t/effect_mass.csv", &cut, &["effect_mass.csv", "has 19 rows, measured.csv has 26"]);
    faulty(
        "t/predicted.csv",
        &|t| t.replace("x2_cos_um", "x3_cos_um"),
        &["`x2_cos_um`", "conditions"],
    );
    faulty("t/measured.csv", &|t| t.replacen(",8,", ",0,", 1), &["measured.csv:2", "x1_cos_um_sd"]);
    faulty(
        "t/table.ron",
        &|t| t.replace("amount: 1.3", "amount: 1.0"),
        &["effects[1].amount", "no effect"],
    );
    faulty("t/table.ron", &|t| t.replace("none", "zero"), &["zero"]);
    faulty(
        "t/table.ron",
        &|t| t.replacen("amount:", "file: \"../t/effect_mass.csv\", amount:", 1),
        &["effects[0].file", "is not a plain file name inside the data folder"],
    );
    let missing = folder(NOMINAL, 6);
    missing.write("t/table.ron", "(effects: [(name: \"joint\", amount: 2)])");
    missing.hhc(&["diagnose", "--table", "t"]).rejected(&["effect_joint.csv"]);
}

const CASE: &str = "(title: \"small\", trim: WindTunnel(ct_sigma: 0.07, shaft_tilt_deg: 4), actuator: (model: Ideal),
    structure: (elements: 5, modes: (flap: 2, lag: 1, torsion: 1)), response: (time_elements: 6),
    uncertain: [(field: \"rotor.gj\", sd_percent: 2)])";

/// Four points of a small rotor: too few for a name, enough for every file on the way.
#[test]
fn a_sweep_of_a_rotor_is_imported_checked_and_diagnosed() {
    let place = Place::new();
    place.write("case.ron", CASE);
    let mut text =
        String::from("advance_ratio,theta0_deg,theta0_deg_sd,fz_n4_cos_N,fz_n4_cos_N_sd\n");
    for (k, mu) in [0.15, 0.2, 0.25, 0.3].into_iter().enumerate() {
        writeln!(text, "{mu},{},0.02,{},1e5", 10.0 + k as f64, k).unwrap();
    }
    place.write("sweep.csv", &text);
    let told = place.hhc(&["import", "sweep.csv", "-o", "data"]).done();
    assert!(told.contains(" points\n") && !told.contains("NaN"), "{told}");
    assert!(told.contains("kind RotorSweep"), "{told}");
    assert_eq!(place.hhc(&["check", "data", "--format", "json"]).json()["kind"], "rotor_sweep");
    let told = place.hhc(&["diagnose", "case.ron", "--data", "data", "-o", "out"]).done();
    assert!(told.lines().count() <= 40, "{told}");
    let found: serde_json::Value = serde_json::from_str(&place.read("out/findings.json")).unwrap();
    assert_eq!(found["data_kind"], "RotorSweep");
    // eight values do not choose between thirty parameters
    assert_eq!(found["causes"], serde_json::json!([]));
    let page = page(&place, "out");
    shows_residuals(&page, &place.read("out/residuals.csv"), 0, 5);
    assert!(section(&page, "costs").contains("No suspect was tried: 8 values"));
    assert!(section(&page, "ground").contains("rotor.gj"), "what is uncertain is said");
    place.write("bad.csv", &text.replace("fz_n4_cos_N,", "fz_n4_cos_kN,"));
    place.hhc(&["import", "bad.csv", "-o", "bad"]).done();
    place.hhc(&["check", "bad"]).rejected(&["`fz_n4_cos_kN`", "expected one of"]);
    place.write("case.ron", &CASE.replace("rotor.gj", "rotor.gk"));
    place
        .hhc(&["diagnose", "case.ron", "--data", "data", "-o", "out2"])
        .rejected(&["case.ron:3", "`rotor.gk`"]);
    place.hhc(&["identify", "data", "-o", "a.ron"]).rejected(&["identify no actuator"]);
}

/// The default blade, its `EI_flap` a fifth lower, as exact theory has it at rest: `lambda^2 sqrt(EI) / 2 pi`, in units of the rotor
/// speed of 383 rpm.
#[test]
fn frequencies_of_a_blade_are_imported_checked_and_diagnosed() {
    let place = Place::new();
    place.write("case.ron", "(title: \"blade\", rotor: (twist_deg: 0))");
    let mut text = String::from("rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n");
    for (n, lambda) in [1.875_104, 4.694_091, 7.854_757].into_iter().enumerate() {
        for (kind, stiffness) in [("flap", 0.8 * 0.0108_f64), ("lag", 0.0268)] {
            let hz = lambda * lambda * stiffness.sqrt() * 383.0 / 60.0;
            writeln!(text, "0,{kind} {},{hz},{}", n + 1, 0.003 * hz).unwrap();
        }
    }
    place.write("frequencies.csv", &text);
    let told = place.hhc(&["import", "frequencies.csv", "-o", "data"]).done();
    assert!(told.contains("kind BladeFrequencies"), "{told}");
    let checked = place.hhc(&["check", "data", "--format", "json"]).json();
    assert_eq!(checked["kind"], "blade_frequencies");
    let told = place.hhc(&["diagnose", "case.ron", "--data", "data", "-o", "out"]).done();
    assert!(told.lines().count() <= 40, "{told}");
    let found: serde_json::Value = serde_json::from_str(&place.read("out/findings.json")).unwrap();
    assert_eq!(found["data_kind"], "BladeFrequencies");
    let ratio = found["parameters"]["stiffness-flap"]["ratio"]["value"].as_f64().unwrap();
    assert!((ratio - 0.8).abs() < 0.03, "{told}");
    let page = page(&place, "out");
    shows_residuals(&page, &place.read("out/residuals.csv"), 0, 5);
    costs_least(&page, "stiffness-flap");
    place.write("bad.csv", &text.replace("lag 2", "edge 2"));
    place.hhc(&["import", "bad.csv", "-o", "bad"]).done();
    place.hhc(&["check", "bad"]).rejected(&["bad/points.csv:1", "`edge 2` is no mode"]);
}

/// An oscillating flap that makes four fifths of the lift that the same program says of it.
#[test]
fn loads_of_a_section_are_imported_checked_and_diagnosed() {
    let place = Place::new();
    place.write("case.ron", "(title: \"section\")");
    let mut text = String::from("motion,mach,reduced_frequency,frequency_hz");
    for name in ["cn_re", "cn_im", "cm_re", "cm_im"] {
        write!(text, ",{name},{name}_sd").unwrap();
    }
    for k in [0.05, 0.1, 0.2, 0.4] {
        let reduced = k.to_string();
        let said = place.hhc(&[
            "section",
            "--model",
            "calibrated",
            "--mach",
            "0.5",
            "--flap-chord",
            "0.2",
            "--motion",
            "flap",
            "--reduced-frequency",
            &reduced,
            "--format",
            "json",
        ]);
        let said = said.json();
        write!(text, "\nflap,0.5,{k},{}", 100.0 * k).unwrap();
        for (load, factor) in [("cn", 0.8), ("cm", 1.0)] {
            for part in 0..2 {
                let value = factor * said[load][part].as_f64().unwrap();
                write!(text, ",{value},0.01").unwrap();
            }
        }
    }
    text.push('\n');
    place.write("loops.csv", &text);
    let told = place.hhc(&["import", "loops.csv", "-o", "data"]).done();
    assert!(told.contains("kind SectionLoops"), "{told}");
    let checked = place.hhc(&["check", "data", "--format", "json"]).json();
    assert_eq!(checked["kind"], "section_loops");
    let told = place.hhc(&["diagnose", "case.ron", "--data", "data", "-o", "out"]).done();
    assert!(
        told.contains("flap-effectiveness") && told.contains("rejected in its place"),
        "{told}"
    );
    let found: serde_json::Value = serde_json::from_str(&place.read("out/findings.json")).unwrap();
    let lift = found["parameters"]["flap-effectiveness"]["lift"]["value"].as_f64().unwrap();
    assert!((lift - 0.8).abs() < 0.02, "{told}");
    let page = page(&place, "out");
    shows_residuals(&page, &place.read("out/residuals.csv"), 0, 5);
    costs_least(&page, "flap-effectiveness");
    assert!(section(&page, "parameters").contains("flap-effectiveness: lift: 0.80"));
    assert!(place.read("out/extended_case.ron").contains("lift"));
}
